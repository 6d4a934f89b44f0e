/*
  test_ancf_types.c - every time integrator of this PETSc: it moves a beam as RK4 with a tenth of the step does, or is refused
  with the reason; the same for the variants of each.
*/
#include "ancf_common.h"

#define DT 5e-4

static PetscErrorCode Swing(const char options[], PetscReal dt, PetscReal tip[3])
{
  AncfBeamSpec s;
  Ancf a = NULL;
  PetscReal half[36];
  const PetscReal *e, *v;
  PetscErrorCode ierr;
  PetscInt n = (PetscInt)PetscFloorReal(0.2 / dt + 0.5);

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s));
  ierr = BeamCreate(&s, -9.81, options, &a);
  for (PetscInt i = 1; i <= n && !ierr; i++) {
    if (i == n / 2 + 1) {
      PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
      PetscCall(PetscArraycpy(half, e, 18));
      PetscCall(PetscArraycpy(half + 18, v, 18));
    }
    ierr = AncfAdvance(a, (PetscReal)i * dt);
  }
  /* from the middle once more: no integrator may go on from a state of its own */
  if (!ierr) ierr = AncfSetState(a, (PetscReal)(n / 2) * dt, half, half + 18);
  for (PetscInt i = n / 2 + 1; i <= n && !ierr; i++) ierr = AncfAdvance(a, (PetscReal)i * dt);
  if (!ierr) {
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    PetscCall(PetscArraycpy(tip, e + 12, 3));
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

/*
  Tip of the two-element seed beam at 0.2 s. First order: g t dt = 1e-3 m, allowed three times that. Second: (w dt)^2/12 = 1e-5 of
  the drop of 0.2 m for the bending frequencies of 20 rad/s that carry the motion, with a factor of 5 and in all 1e-5 m. The error
  of a Rosenbrock method of two stages is 1/6 - g + g^2 in place of 1/12, 16 times as much for 2p with g = 1 + 1/sqrt(2).
*/
#define FIRST 3e-3
#define SECOND 1e-5
#define TWO_P 1.6e-4

static const struct {
  const char *type, *variant; /* of -ancf_ts_<type>_type, or NULL: as it comes */
  PetscReal tol;              /* m; 0: refused */
  const char *why;            /* words of the refusal */
} table[] = {
    {TSALPHA2, NULL, SECOND, NULL},
    {TSBEULER, NULL, FIRST, NULL},
    {TSCN, NULL, SECOND, NULL},
    {TSTHETA, NULL, SECOND, NULL},
    {TSBDF, NULL, SECOND, NULL},
    {TSALPHA, NULL, SECOND, NULL},
    {TSARKIMEX, NULL, SECOND, NULL},
    {TSARKIMEX, TSARKIMEX1BEE, FIRST, NULL},
    {TSARKIMEX, TSARKIMEXL2, SECOND, NULL},
    {TSARKIMEX, TSARKIMEXPRSSP2, SECOND, NULL},
    {TSARKIMEX, TSARKIMEXA2, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEXARS122, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX2C, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX2D, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX2E, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX3, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEXBPR3, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEXARS443, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX4, 0, "cannot take the mass matrix"},
    {TSARKIMEX, TSARKIMEX5, 0, "cannot take the mass matrix"},
    {"dirk", NULL, SECOND, NULL},
    {TSROSW, NULL, SECOND, NULL},
    {TSROSW, TSROSW2M, SECOND, NULL},
    {TSROSW, TSROSW2P, TWO_P, NULL},
    {TSROSW, TSROSWRA3PW, SECOND, NULL},
    {TSROSW, TSROSWRA34PW2, SECOND, NULL},
    {TSROSW, TSROSWRODAS3, SECOND, NULL},
    {TSROSW, TSROSWSANDU3, SECOND, NULL},
    {TSROSW, TSROSWTHETA1, FIRST, NULL},
    {TSROSW, TSROSWTHETA2, SECOND, NULL},
    {TSROSW, TSROSWGRK4T, SECOND, NULL},
    {TSROSW, TSROSWSHAMP4, SECOND, NULL},
    {TSROSW, TSROSWVELDD4, SECOND, NULL},
    {TSROSW, TSROSW4L, SECOND, NULL},
    {TSROSW, TSROSWASSP3P3S1C, 0, "explicit stage"},
    {TSROSW, TSROSWLASSP3P4S2C, 0, "explicit stage"},
    {TSROSW, TSROSWLLSSP3P4S2C, 0, "explicit stage"},
    {TSROSW, TSROSWARK3, 0, "explicit stage"},
    {TSRK, NULL, SECOND, NULL},
    {TSRK, TSRK2A, SECOND, NULL},
    {TSRK, TSRK3, SECOND, NULL},
    {TSRK, TSRK4, SECOND, NULL},
    {TSRK, TSRK5F, SECOND, NULL},
    {TSRK, TSRK5DP, SECOND, NULL},
    {TSSSP, NULL, SECOND, NULL},
    {TSGLEE, NULL, SECOND, NULL},
    {TSGLEE, TSGLEE23, -1, NULL}, /* weakly unstable without damping, as all two-stage methods of second order are */
    {TSGLEE, TSGLEE24, SECOND, NULL},
    {TSGLEE, TSGLEE35, SECOND, NULL},
    {TSBASICSYMPLECTIC, "1", FIRST, NULL},
    {TSBASICSYMPLECTIC, "2", SECOND, NULL},
    {TSBASICSYMPLECTIC, "3", SECOND, NULL},
    {TSBASICSYMPLECTIC, "4", SECOND, NULL},
    {TSIRK, NULL, 0, "irk cannot integrate beams: it takes y' = G(y) with the matrix dG/dy only"},
    {TSGLLE, NULL, 0, "glle cannot integrate beams: it chooses its steps"},
    {TSEIMEX, NULL, 0, "eimex cannot integrate beams: it takes loads and supports at the start"},
    {TSMIMEX, NULL, 0, "mimex cannot integrate beams: it needs the fields of a DM"},
    {TSDISCGRAD, NULL, 0, "discgrad cannot integrate beams: it needs a gradient system"},
    {TSMPRK, NULL, 0, "mprk cannot integrate beams: it needs a slow and a fast part"},
    {TSPSEUDO, NULL, 0, "pseudo cannot integrate beams: it goes to a steady state"},
    {"python", NULL, 0, "python cannot integrate beams"},
    {TSEULER, NULL, -1, NULL}, /* runs, but is unstable without damping: test_ancf_ts */
};

/* With a step of 1.25e-4 s: stable for the fastest vibration, 1e3 rad/s. */
static const char *const explicit_types[] = {TSRK, TSSSP, TSGLEE, TSBASICSYMPLECTIC};

#define ROWS (sizeof(table) / sizeof(table[0]))

static PetscErrorCode Has(const char *const names[], PetscInt n, const char type[], PetscBool *has)
{
  PetscFunctionBegin;
  *has = PETSC_FALSE;
  for (PetscInt i = 0; i < n; i++) *has = (PetscBool)(*has || !strcmp(names[i], type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestTable(const char *const names[], PetscInt n)
{
  PetscReal ref[3], tip[3];
  char options[128];

  PetscFunctionBegin;
  PetscCall(Swing("-ancf_ts_type rk -ancf_ts_rk_type 4", DT / 10, ref));
  for (size_t k = 0; k < ROWS; k++) {
    PetscBool has;

    PetscCall(Has(names, n, table[k].type, &has));
    if (!has || table[k].tol < 0) continue;
    PetscCall(PetscSNPrintf(options, sizeof(options), "-ancf_ts_type %s", table[k].type));
    if (table[k].variant)
      PetscCall(PetscSNPrintf(options, sizeof(options), "-ancf_ts_type %s -ancf_ts_%s_type %s", table[k].type, table[k].type,
                              table[k].variant));
    for (size_t i = 0; i < sizeof(explicit_types) / sizeof(explicit_types[0]); i++)
      if (!strcmp(table[k].type, explicit_types[i])) PetscCall(PetscStrlcat(options, " -ancf_substeps 4", sizeof(options)));
    if (table[k].tol == 0) {
      TEST_REFUSED(Swing(options, DT, tip), table[k].why);
      continue;
    }
    PetscCall(Swing(options, DT, tip));
    printf("%-60s tip error %9.2e m\n", options, (double)PetscMax(PetscAbsReal(tip[0] - ref[0]), PetscAbsReal(tip[2] - ref[2])));
    for (int c = 0; c < 3; c++) TEST_NEAR(tip[c], ref[c], table[k].tol, options);
  }
  TEST_REFUSED(Swing("-ancf_ts_type bdf -ancf_ts_bdf_order 3", DT, tip), "-ancf_ts_bdf_order 3: must be 1 or 2");
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const char **names;
  int n;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TSInitializePackage());
  PetscCall(PetscFunctionListGet(TSList, &names, &n));
  while (n > 0 && !names[n - 1]) n--;
  for (int i = 0; i < n; i++) { /* types that this test does not know must at least be refused */
    PetscBool known = PETSC_FALSE;
    char options[128];
    PetscReal tip[3];

    for (size_t k = 0; k < ROWS; k++) known = (PetscBool)(known || !strcmp(names[i], table[k].type));
    PetscCall(PetscSNPrintf(options, sizeof(options), "-ancf_ts_type %s", names[i]));
    if (!known) TEST_REFUSED(Swing(options, DT, tip), "cannot integrate beams");
  }
  PetscCall(TestTable(names, n));
  PetscCall(PetscFree(names));
  PetscCall(PetscFinalize());
  return test_report();
}
