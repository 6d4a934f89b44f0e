/*
  ancftype.c - which TS types and variants of them integrate beams, and in which form of the equations; why the others do not.
*/
#include "ancfimpl.h"
#include <string.h>

/*
  Which form each TS type takes; anything else is refused. The last column: nothing is carried from step to step but the state
  and, by TSALPHA2, the acceleration.
*/
static const struct {
  const char *type;
  AncfForm form;
  PetscBool exact;
} ancf_types[] = {
    {TSALPHA2, ANCF_FORM_SECOND, PETSC_TRUE},  {TSBEULER, ANCF_FORM_FIRST, PETSC_TRUE},
    {TSCN, ANCF_FORM_FIRST, PETSC_TRUE},       {TSTHETA, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSBDF, ANCF_FORM_FIRST, PETSC_FALSE},     {TSALPHA, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSARKIMEX, ANCF_FORM_FIRST, PETSC_FALSE}, {"dirk", ANCF_FORM_FIRST, PETSC_FALSE},
    {TSROSW, ANCF_FORM_FIRST, PETSC_FALSE},    {TSEULER, ANCF_FORM_EXPLICIT, PETSC_TRUE},
    {TSRK, ANCF_FORM_EXPLICIT, PETSC_FALSE},   {TSSSP, ANCF_FORM_EXPLICIT, PETSC_FALSE},
    {TSGLEE, ANCF_FORM_EXPLICIT, PETSC_FALSE}, {TSBASICSYMPLECTIC, ANCF_FORM_SYMPLECTIC, PETSC_TRUE},
};

/* Types of PETSc that cannot, by its sources and as tried out. */
static const struct {
  const char *type, *why;
} ancf_refused[] = {
    {TSIRK, "takes y' = G(y) with the matrix dG/dy only, which the inverse of the mass matrix makes dense"},
    {TSGLLE, "chooses its steps and does not end one at a given time"},
    {TSEIMEX, "takes loads and supports at the start of its stages, not where the stages are"},
    {TSMIMEX, "needs the fields of a DM"},
    {TSDISCGRAD, "needs a gradient system (TSDiscGradSetFormulation)"},
    {TSMPRK, "needs a slow and a fast part of the equations"},
    {TSPSEUDO, "goes to a steady state, not through time"},
    {"python", "needs a program in Python"},
};

/* Variants of types that cannot; wrong results if they were let run, or none. */
static const struct {
  const char *type, *option, *variant;
} ancf_variants[] = {
    {TSROSW, "-ts_rosw_type", TSROSWASSP3P3S1C},
    {TSROSW, "-ts_rosw_type", TSROSWLASSP3P4S2C},
    {TSROSW, "-ts_rosw_type", TSROSWLLSSP3P4S2C},
    {TSROSW, "-ts_rosw_type", TSROSWARK3},
};

#define COUNT(table) (sizeof(table) / sizeof((table)[0]))

PetscErrorCode AncfChooseForm(Ancf ancf)
{
  TSType type;
  TSAdapt adapt;
  PetscBool fixedstep;
  const size_t n = COUNT(ancf_types);
  size_t k;
  char list[256] = "";

  PetscFunctionBegin;
  PetscCall(TSGetType(ancf->ts, &type));
  for (k = 0; k < n; k++) {
    PetscBool match;

    PetscCall(PetscStrcmp(type, ancf_types[k].type, &match));
    if (match) break;
    PetscCall(PetscStrlcat(list, " ", sizeof(list)));
    PetscCall(PetscStrlcat(list, ancf_types[k].type, sizeof(list)));
  }
  for (size_t i = 0; i < COUNT(ancf_refused) && k == n; i++)
    PetscCheck(strcmp(type, ancf_refused[i].type), ancf->comm, PETSC_ERR_ARG_WRONG,
               "-ancf_ts_type %s cannot integrate beams: it %s; use one of:%s", type, ancf_refused[i].why, list);
  PetscCheck(k < n, ancf->comm, PETSC_ERR_ARG_WRONG, "-ancf_ts_type %s cannot integrate beams; use one of:%s", type, list);
  PetscCall(TSGetAdapt(ancf->ts, &adapt));
  PetscCall(PetscObjectTypeCompare((PetscObject)adapt, TSADAPTNONE, &fixedstep));
  ancf->form = ancf_types[k].form;
  ancf->exact = (PetscBool)(ancf_types[k].exact && fixedstep);
  PetscCall(PetscObjectTypeCompareAny((PetscObject)ancf->ts, &ancf->interpolates, TSALPHA2, TSTHETA, ""));
  for (PetscInt j = 0; j < ancf->njoints; j++) ancf->exact = (PetscBool)(ancf->exact && ancf->joints[j].linear);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TSARKIMEX accepts a mass matrix other than the identity only in tableaux without an explicit first stage; l2 (L-stable,
  second order) is our default among them.
*/
static PetscErrorCode AncfChooseARKIMEX(Ancf ancf)
{
  const char *const fit[] = {TSARKIMEXL2, TSARKIMEX1BEE, TSARKIMEXPRSSP2};
  TSARKIMEXType type;
  const char *prefix;
  PetscBool is, given;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSARKIMEX, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TSARKIMEXGetType(ancf->ts, &type));
  for (int k = 0; k < 3; k++) {
    PetscCall(PetscStrcmp(type, fit[k], &is));
    if (is) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(TSGetOptionsPrefix(ancf->ts, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-ts_arkimex_type", &given));
  PetscCheck(!given, ancf->comm, PETSC_ERR_ARG_WRONG,
             "-ancf_ts_arkimex_type %s cannot take the mass matrix of beams; use one of: l2 1bee prssp2", type);
  PetscCall(TSARKIMEXSetType(ancf->ts, TSARKIMEXL2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  cn, and theta with endpoints, take the forces at the start of a step once more, which are those of other equations once
  dependent coordinates of a corner were chosen anew: Newton's method ends in values that are not finite.
*/
static PetscErrorCode CheckEndpoint(Ancf ancf)
{
  PetscBool cn, theta, endpoint = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSCN, &cn));
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSTHETA, &theta));
  if (theta) PetscCall(TSThetaGetEndpoint(ancf->ts, &endpoint));
  for (PetscInt k = 0; k < ancf->njoints && (cn || endpoint); k++)
    PetscCheck(ancf->joints[k].linear || ancf->constraints == ANCF_CONSTRAINTS_MULTIPLIERS, ancf->comm, PETSC_ERR_ARG_INCOMP,
               "-ancf_ts_type %s cannot keep the rigid joint %" PetscInt_FMT
               " by elimination; use one of: alpha2 theta bdf beuler alpha arkimex rosw rk, or -ancf_constraints multipliers",
               cn ? "cn" : "theta with -ancf_ts_theta_endpoint", k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rosenbrock-W methods with an explicit stage have no matrix to solve with there; bdf beyond the second order. */
PetscErrorCode AncfCheckVariant(Ancf ancf)
{
  const char *prefix;
  char given[64];
  PetscBool is, set;
  PetscInt order;

  PetscFunctionBegin;
  PetscCall(AncfChooseARKIMEX(ancf));
  PetscCall(TSGetOptionsPrefix(ancf->ts, &prefix));
  for (size_t k = 0; k < COUNT(ancf_variants); k++) {
    PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, ancf_variants[k].type, &is));
    PetscCall(PetscOptionsGetString(NULL, prefix, ancf_variants[k].option, given, sizeof(given), &set));
    PetscCheck(!is || !set || strcmp(given, ancf_variants[k].variant), ancf->comm, PETSC_ERR_ARG_WRONG,
               "-ancf_%s %s has an explicit stage, which cannot take the mass matrix of beams; use one of: 2m 2p ra3pw ra34pw2 "
               "rodas3 sandu3 theta1 theta2 grk4t shamp4 veldd4 4l",
               ancf_variants[k].option + 1, given);
  }
  PetscCall(CheckEndpoint(ancf));
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSBDF, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TSBDFGetOrder(ancf->ts, &order));
  PetscCheck(order <= 2, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_ts_bdf_order %" PetscInt_FMT ": must be 1 or 2; beyond, bdf is not A-stable and the vibrations of beams grow",
             order);
  PetscFunctionReturn(PETSC_SUCCESS);
}
