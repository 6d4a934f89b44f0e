/* ancf.c - lifecycle, beams, options and state of the Ancf object. */
#include "ancfimpl.h"
#include "blocktri.h"
#include <stdlib.h>

PetscLogEvent ANCF_Advance, ANCF_Force, ANCF_Tangent, ANCF_MassSolve;

static const char *const AncfStrains[] = {"paper", "engineering", "AncfStrain", "ANCF_STRAIN_", NULL};
static const char *const AncfConstraintTypes[] = {"eliminate", "multipliers", "AncfConstraints", "ANCF_CONSTRAINTS_", NULL};
static const char *const AncfForms[] = {"second order, M eddot + Q^e = Q^a", "first order, y = (e, v)",
                                        "explicit, M factored once", "explicit, symplectic"};
static const char *const AncfEnds[] = {"free", "pin", "clamp"};

static PetscErrorCode AncfRegister(void)
{
  static PetscBool registered = PETSC_FALSE;
  PetscClassId id;

  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Ancf", &id));
  PetscCall(PCBlockTriRegister());
  PetscCall(PetscLogEventRegister("AncfAdvance", id, &ANCF_Advance));
  PetscCall(PetscLogEventRegister("AncfForce", id, &ANCF_Force));
  PetscCall(PetscLogEventRegister("AncfTangent", id, &ANCF_Tangent));
  PetscCall(PetscLogEventRegister("AncfMassSolve", id, &ANCF_MassSolve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfPrefixTS(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(TSSetOptionsPrefix(ancf->ts, ancf->prefix));
  PetscCall(TSAppendOptionsPrefix(ancf->ts, "ancf_"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfCreate - empty set of beams. One process per set: comm must have one rank (PETSC_ERR_SUP otherwise).
*/
PetscErrorCode AncfCreate(MPI_Comm comm, Ancf *ancf)
{
  PetscMPIInt size;
  Ancf a;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCheck(size == 1, comm, PETSC_ERR_SUP, "AncfCreate: the communicator has %d ranks; beams need one (PETSC_COMM_SELF)", size);
  PetscCall(AncfRegister());
  PetscCall(PetscNew(&a));
  a->comm = comm;
  a->substeps = 1;
  a->loadscale = 1;
  a->groupnodes = ANCF_DEFAULT_GROUP;
  a->naxial = ANCF_DEFAULT_AXIAL;
  a->nbending = ANCF_DEFAULT_BENDING;
  PetscCall(AncfTSCreate(a));
  PetscCall(AncfPrefixTS(a));
  *ancf = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options are then -<prefix>ancf_gravity, -<prefix>ancf_ts_type and so on. */
PetscErrorCode AncfSetOptionsPrefix(Ancf ancf, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(PetscFree(ancf->prefix));
  PetscCall(PetscStrallocpy(prefix, &ancf->prefix));
  PetscCall(AncfPrefixTS(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Four elements, everything free; the rest is invalid until set. */
PetscErrorCode AncfBeamSpecInit(AncfBeamSpec *spec)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(spec, sizeof(*spec)));
  spec->elements = 4;
  spec->EA = spec->EI = spec->rhoA = PETSC_DECIDE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfCheckVector(Ancf ancf, const char field[], const PetscReal x[3])
{
  PetscFunctionBegin;
  PetscCheck(!PetscIsInfOrNanReal(x[0] + x[1] + x[2]), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": %s = (%g, %g, %g) must be finite", ancf->nbeams, field, (double)x[0], (double)x[1],
             (double)x[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfAddBeam - appends a beam and returns its number.

  Errors: PETSC_ERR_ARG_OUTOFRANGE with the field, its value and the rule; PETSC_ERR_ARG_WRONGSTATE after AncfSetUp().
*/
PetscErrorCode AncfAddBeam(Ancf ancf, const AncfBeamSpec *spec, PetscInt *number)
{
  AncfBeam beam = {.spec = *spec};
  PetscReal L = 0, speed = 0;

  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE,
             "AncfAddBeam: beams cannot be added or changed after AncfSetUp()");
  PetscCheck(spec->elements >= 1, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": elements = %" PetscInt_FMT " must be at least 1", ancf->nbeams, spec->elements);
  PetscCheck((double)ancf->nnodes + (double)spec->elements < 5e7, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": elements = %" PetscInt_FMT " makes %.3g nodes of all beams; must be fewer than 5e7",
             ancf->nbeams, spec->elements, (double)ancf->nnodes + (double)spec->elements + 1);
  PetscCall(AncfCheckVector(ancf, "start", spec->start));
  PetscCall(AncfCheckVector(ancf, "end", spec->end));
  PetscCall(AncfCheckVector(ancf, "velocity", spec->velocity));
  for (PetscInt c = 0; c < 3; c++) {
    L += PetscSqr(spec->end[c] - spec->start[c]);
    speed += PetscSqr(spec->velocity[c]);
  }
  L = PetscSqrtReal(L);
  PetscCheck(L > 0, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": start and end are the same point (%g, %g, %g), the length must be positive", ancf->nbeams,
             (double)spec->start[0], (double)spec->start[1], (double)spec->start[2]);
  PetscCheck(!PetscIsInfOrNanReal(L), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE, "Beam %" PetscInt_FMT ": length must be finite",
             ancf->nbeams);
  PetscCall(AncfBeamSection(ancf, &beam));
  PetscCall(AncfCheckRest(ancf, spec));
  for (int k = 0; k < 2; k++) {
    AncfEnd end = k ? spec->end1 : spec->end0;

    PetscCheck(end >= ANCF_END_FREE && end <= ANCF_END_CLAMP, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Beam %" PetscInt_FMT ": end%d = %d must be ANCF_END_FREE, ANCF_END_PIN or ANCF_END_CLAMP", ancf->nbeams, k,
               (int)end);
    PetscCheck(end == ANCF_END_FREE || speed == 0, ancf->comm, PETSC_ERR_ARG_INCOMP,
               "Beam %" PetscInt_FMT ": velocity = (%g, %g, %g) m/s must be zero because end%d is fixed (%s)", ancf->nbeams,
               (double)spec->velocity[0], (double)spec->velocity[1], (double)spec->velocity[2], k, AncfEnds[end]);
  }
  beam.l = AncfSpecLength(spec) / (PetscReal)spec->elements;
  beam.node = ancf->nnodes;
  beam.element = ancf->nelements;
  if (ancf->nbeams == ancf->maxbeams) {
    ancf->maxbeams = PetscMax(16, 2 * ancf->maxbeams);
    PetscCall(PetscRealloc(sizeof(AncfBeam) * (size_t)ancf->maxbeams, &ancf->beams));
  }
  if (spec->curve) {
    PetscReal *copy;

    PetscCall(PetscMalloc1(6 * (size_t)(spec->elements + 1), &copy));
    PetscCall(PetscArraycpy(copy, spec->curve, 6 * (spec->elements + 1)));
    beam.spec.curve = copy;
  }
  ancf->beams[ancf->nbeams] = beam;
  if (number) *number = ancf->nbeams;
  ancf->nbeams++;
  ancf->nnodes += spec->elements + 1;
  ancf->nelements += spec->elements;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gravitational acceleration, m/s^2; default 0. */
PetscErrorCode AncfSetGravity(Ancf ancf, const PetscReal g[3])
{
  PetscFunctionBegin;
  PetscCheck(!PetscIsInfOrNanReal(g[0] + g[1] + g[2]), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_gravity %g,%g,%g must be finite", (double)g[0], (double)g[1], (double)g[2]);
  for (int c = 0; c < 3; c++) ancf->gravity[c] = g[c];
  if (ancf->setup) PetscCall(AncfSetUpWeight(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Density of the surrounding fluid, kg/m^3: gravity acts on rho_s A - rho A_outer, A_outer = pi d^2/4. 0: no buoyancy (default).
 */
PetscErrorCode AncfSetFluidDensity(Ancf ancf, PetscReal rho)
{
  PetscFunctionBegin;
  PetscCheck(rho >= 0 && !PetscIsInfOrNanReal(rho), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_fluid_density %g kg/m^3 must be finite and not negative", (double)rho);
  ancf->fluiddensity = rho;
  if (ancf->setup) PetscCall(AncfSetUpWeight(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number of TS steps in each AncfAdvance(), 1..1000; the paper uses 1..50 (Sect. 3). With an adaptive TS: of the first step. */
PetscErrorCode AncfSetSubsteps(Ancf ancf, PetscInt ratio)
{
  PetscFunctionBegin;
  PetscCheck(ratio >= 1 && ratio <= 1000, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_substeps %" PetscInt_FMT " must be in 1..1000", ratio);
  ancf->substeps = ratio;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetStrain(Ancf ancf, AncfStrain strain)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_strain cannot change after AncfSetUp()");
  PetscCheck(strain == ANCF_STRAIN_PAPER || strain == ANCF_STRAIN_ENGINEERING, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_strain %d must be paper or engineering", (int)strain);
  ancf->strain = strain;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gauss points per element for the axial and the bending energy, 1..8 each. */
PetscErrorCode AncfSetQuadrature(Ancf ancf, PetscInt axial, PetscInt bending)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_quadrature_axial cannot change after AncfSetUp()");
  PetscCheck(axial >= 1 && axial <= ANCF_MAX_GAUSS, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_quadrature_axial %" PetscInt_FMT " must be in 1..%d", axial, ANCF_MAX_GAUSS);
  PetscCheck(bending >= 2 && bending <= ANCF_MAX_GAUSS, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_quadrature_bending %" PetscInt_FMT " must be in 2..%d", bending, ANCF_MAX_GAUSS);
  ancf->naxial = axial;
  ancf->nbending = bending;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass-proportional (Rayleigh) damping C = damping M, 1/s: a mode of frequency w rad/s has the damping ratio damping/(2 w).
 * Default 0. */
PetscErrorCode AncfSetDamping(Ancf ancf, PetscReal damping)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_damping cannot change after AncfSetUp()");
  PetscCheck(damping >= 0 && !PetscIsInfOrNanReal(damping), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_damping %g 1/s must be finite and not negative", (double)damping);
  ancf->damping = damping;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfSetGroupNodes - beams are integrated in groups of about this many nodes, so that the vectors of a group's TS stay in
  cache (default 16000). A set of fewer than twice as many nodes is one group, and so is any set whose TS was asked for by
  AncfGetTS() before AncfSetUp().
*/
PetscErrorCode AncfSetGroupNodes(Ancf ancf, PetscInt nodes)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_group_nodes cannot change after AncfSetUp()");
  PetscCheck(nodes >= 1, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE, "-ancf_group_nodes %" PetscInt_FMT " must be at least 1", nodes);
  ancf->groupnodes = nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetFromOptions(Ancf ancf)
{
  PetscReal g[3];
  PetscInt n = 3, sub = ancf->substeps, axial = ancf->naxial, bending = ancf->nbending, group = ancf->groupnodes;
  PetscReal rho = ancf->fluiddensity, damping = ancf->damping, stiffness = ancf->stiffnessdamping;
  AncfStrain strain = ancf->strain;
  AncfConstraints constraints = ancf->constraints;
  PetscBool flg, flg2;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(g, ancf->gravity, 3));
  PetscOptionsBegin(ancf->comm, ancf->prefix, "Slender beams (ANCF)", "Ancf");
  PetscCall(PetscOptionsRealArray("-ancf_gravity", "Gravitational acceleration, m/s^2", "AncfSetGravity", g, &n, &flg));
  PetscCheck(!flg || n == 3, ancf->comm, PETSC_ERR_ARG_WRONG, "-ancf_gravity needs 3 numbers x,y,z, got %" PetscInt_FMT, n);
  if (flg) PetscCall(AncfSetGravity(ancf, g));
  PetscCall(PetscOptionsReal("-ancf_fluid_density", "Density of the surrounding fluid for buoyancy, kg/m^3 (0: none)",
                             "AncfSetFluidDensity", rho, &rho, &flg));
  if (flg) PetscCall(AncfSetFluidDensity(ancf, rho));
  PetscCall(PetscOptionsInt("-ancf_substeps", "Beam steps per fluid step, 1..1000", "AncfSetSubsteps", sub, &sub, &flg));
  if (flg) PetscCall(AncfSetSubsteps(ancf, sub));
  PetscCall(PetscOptionsEnum("-ancf_strain", "Strain measures", "AncfSetStrain", AncfStrains, (PetscEnum)strain,
                             (PetscEnum *)&strain, &flg));
  if (flg) PetscCall(AncfSetStrain(ancf, strain));
  PetscCall(PetscOptionsEnum("-ancf_constraints", "Supports and joints by elimination or with multipliers", "AncfSetConstraints",
                             AncfConstraintTypes, (PetscEnum)constraints, (PetscEnum *)&constraints, &flg));
  if (flg) PetscCall(AncfSetConstraints(ancf, constraints));
  PetscCall(PetscOptionsInt("-ancf_quadrature_axial", "Gauss points per element for the axial energy, 1..8", "AncfSetQuadrature",
                            axial, &axial, &flg));
  PetscCall(PetscOptionsInt("-ancf_quadrature_bending", "Gauss points per element for the bending energy, 2..8",
                            "AncfSetQuadrature", bending, &bending, &flg2));
  if (flg || flg2) PetscCall(AncfSetQuadrature(ancf, axial, bending));
  PetscCall(PetscOptionsReal("-ancf_damping", "Mass-proportional damping, 1/s", "AncfSetDamping", damping, &damping, &flg));
  if (flg) PetscCall(AncfSetDamping(ancf, damping));
  PetscCall(PetscOptionsReal("-ancf_damping_stiffness", "Stiffness-proportional damping, s", "AncfSetStiffnessDamping", stiffness,
                             &stiffness, &flg));
  if (flg) PetscCall(AncfSetStiffnessDamping(ancf, stiffness));
  PetscCall(PetscOptionsInt("-ancf_group_nodes", "Nodes per group of beams with a TS of its own", "AncfSetGroupNodes", group,
                            &group, &flg));
  if (flg) PetscCall(AncfSetGroupNodes(ancf, group));
  PetscOptionsEnd();
  ancf->fromoptions = PETSC_TRUE;
  PetscCall(TSSetFromOptions(ancf->ts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AncfSetUpNodes(Ancf ancf)
{
  static const unsigned char bits[3] = {0, ANCF_FIX_POSITION, ANCF_FIX_POSITION | ANCF_FIX_GRADIENT};

  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeamSpec *s = &ancf->beams[b].spec;

    for (PetscInt k = 0; k <= s->elements; k++) {
      PetscInt j = ancf->beams[b].node + k;

      AncfSpecPoint(s, (PetscReal)k / (PetscReal)s->elements, ancf->e + 6 * j);
      for (PetscInt c = 0; c < 3; c++) ancf->v[6 * j + c] = s->velocity[c];
    }
    ancf->fixed[ancf->beams[b].node] = bits[s->end0];
    ancf->fixed[ancf->beams[b].node + s->elements] = bits[s->end1];
  }
  for (PetscInt k = 0; k < ancf->nsupports; k++)
    ancf->fixed[ancf->beams[ancf->supports[k].beam].node + ancf->supports[k].node] |= bits[ancf->supports[k].how];
}

PetscErrorCode AncfSetUpBatches(Ancf ancf)
{
  PetscInt n = 0;

  PetscFunctionBegin;
  ancf->nbatches = (ancf->nelements + ANCF_LANES - 1) / ANCF_LANES;
  PetscCall(PetscCalloc1(ancf->nbatches, &ancf->batches));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *beam = &ancf->beams[b];

    for (PetscInt k = 0; k < beam->spec.elements; k++, n++) {
      AncfBatch *batch = &ancf->batches[n / ANCF_LANES];

      batch->n = n % ANCF_LANES + 1;
      for (PetscInt i = n % ANCF_LANES; i < ANCF_LANES; i++) {
        batch->node[i] = beam->node + k;
        batch->beam[i] = b;
        batch->EA[i] = beam->EA;
        batch->EI[i] = beam->EI;
        batch->rhoA[i] = beam->rhoA;
        batch->l[i] = beam->l;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int LongestFirst(const void *a, const void *b)
{
  const AncfBeam *p = *(const AncfBeam *const *)a, *q = *(const AncfBeam *const *)b;

  if (p->spec.elements != q->spec.elements) return p->spec.elements < q->spec.elements ? 1 : -1;
  return p->node < q->node ? -1 : 1;
}

/* Beams of similar length side by side. */
PetscErrorCode AncfSetUpLaneBeams(Ancf ancf)
{
  const AncfBeam **order;

  PetscFunctionBegin;
  if (2 * ancf->nbeams < ANCF_LANES) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ancf->nbeams, &order));
  for (PetscInt b = 0; b < ancf->nbeams; b++) order[b] = &ancf->beams[b];
  qsort(order, (size_t)ancf->nbeams, sizeof(*order), LongestFirst); /* NOLINT(bugprone-sizeof-expression): sorts pointers */
  ancf->nlanebeams = (ancf->nbeams + ANCF_LANES - 1) / ANCF_LANES;
  PetscCall(PetscMalloc1(ancf->nlanebeams, &ancf->lanebeams));
  for (PetscInt k = 0; k < ancf->nlanebeams; k++) {
    AncfLaneBeams *g = &ancf->lanebeams[k];

    for (PetscInt i = 0; i < ANCF_LANES; i++) {
      const PetscBool used = ANCF_LANES * k + i < ancf->nbeams ? PETSC_TRUE : PETSC_FALSE;
      const AncfBeam *m = order[used ? ANCF_LANES * k + i : ANCF_LANES * k];

      g->first[i] = used ? m->node : -1;
      g->elements[i] = used ? m->spec.elements : -1;
      g->EA[i] = m->EA;
      g->EI[i] = m->EI;
      g->rhoA[i] = m->rhoA;
      g->l[i] = m->l;
    }
    g->most = g->elements[0];
    g->least = g->elements[ANCF_LANES - 1];
  }
  PetscCall(PetscFree(order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetUp(Ancf ancf)
{
  PetscInt n;

  PetscFunctionBegin;
  if (ancf->setup) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(ancf->nbeams > 0, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfSetUp: no beams, call AncfAddBeam() first");
  n = 6 * ancf->nnodes;
  PetscCall(PetscCalloc7((size_t)(n + AncfDaeRoom(ancf)), &ancf->e, (size_t)(n + AncfDaeRoom(ancf)), &ancf->v, n, &ancf->a, n,
                         &ancf->load, n, &ancf->weight, n, &ancf->steady, n, &ancf->rest));
  PetscCall(PetscCalloc2(ancf->nnodes, &ancf->fixed, 8 * (size_t)ancf->nnodes, &ancf->mass));
  for (PetscInt k = 0; k < ancf->nsupports; k++) {
    const PetscReal *v = ancf->beams[ancf->supports[k].beam].spec.velocity;

    PetscCheck(v[0] == 0 && v[1] == 0 && v[2] == 0, ancf->comm, PETSC_ERR_ARG_INCOMP,
               "Beam %" PetscInt_FMT ": velocity = (%g, %g, %g) m/s must be zero because its node %" PetscInt_FMT " is fixed",
               ancf->supports[k].beam, (double)v[0], (double)v[1], (double)v[2], ancf->supports[k].node);
  }
  PetscCall(AncfRuleSetUp(&ancf->rule, ancf->strain, ancf->naxial, ancf->nbending));
  AncfSetUpNodes(ancf);
  PetscCall(PetscArraycpy(ancf->rest, ancf->e, n));
  PetscCall(AncfSetUpRest(ancf));
  PetscCall(AncfJointSetUp(ancf));
  PetscCall(AncfSetUpBatches(ancf));
  PetscCall(AncfSetUpLaneBeams(ancf));
  PetscCall(AncfSetUpDamping(ancf));
  PetscCall(AncfSetUpWeight(ancf));
  PetscCall(AncfMassFactor(ancf));
  if (!ancf->njoints && !AncfDaeRoom(ancf) && ancf->nnodes > 2 * ancf->groupnodes && ancf->nbeams > 2 * ANCF_LANES &&
      !ancf->exposed)
    PetscCall(AncfGroupSetUp(ancf));
  else
    PetscCall(AncfTSSetUp(ancf));
  ancf->setup = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfView(Ancf ancf, PetscViewer viewer)
{
  PetscBool ascii;

  PetscFunctionBegin;
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(ancf->comm, &viewer));
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscViewerASCIIPrintf(viewer, "Slender beams (ANCF)\n"));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "beams %" PetscInt_FMT ", elements %" PetscInt_FMT ", nodes %" PetscInt_FMT "\n",
                                   ancf->nbeams, ancf->nelements, ancf->nnodes));
  PetscCall(PetscViewerASCIIPrintf(viewer, "strain %s, Gauss points: axial %" PetscInt_FMT ", bending %" PetscInt_FMT "\n",
                                   AncfStrains[ancf->strain], ancf->naxial, ancf->nbending));
  PetscCall(PetscViewerASCIIPrintf(viewer, "gravity (%g, %g, %g) m/s^2, fluid density for buoyancy %g kg/m^3\n",
                                   (double)ancf->gravity[0], (double)ancf->gravity[1], (double)ancf->gravity[2],
                                   (double)ancf->fluiddensity));
  PetscCall(PetscViewerASCIIPrintf(
      viewer, "substeps %" PetscInt_FMT ", mass-proportional damping %g 1/s, stiffness-proportional damping %g s\n",
      ancf->substeps, (double)ancf->damping, (double)ancf->stiffnessdamping));
  for (PetscInt b = 0; b < PetscMin(ancf->nbeams, 10); b++) {
    const AncfBeam *m = &ancf->beams[b];

    PetscCall(PetscViewerASCIIPrintf(
        viewer,
        "beam %" PetscInt_FMT ": %" PetscInt_FMT " elements, L %g m, d %g m, EA %g N, EI %g N m^2, rhoA %g kg/m, ends %s/%s\n", b,
        m->spec.elements, (double)(m->l * (PetscReal)m->spec.elements), (double)m->spec.diameter, (double)m->EA, (double)m->EI,
        (double)m->rhoA, AncfEnds[m->spec.end0], AncfEnds[m->spec.end1]));
    if (m->spec.axialdamping > 0 || m->spec.bendingdamping > 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "        retardation times: axial %g s, bending %g s\n",
                                       (double)m->spec.axialdamping, (double)m->spec.bendingdamping));
    if (m->spec.inner > 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "        tube, inner diameter %g m\n", (double)m->spec.inner));
    if (m->spec.width > 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "        rectangle, width %g m, thickness %g m\n", (double)m->spec.width,
                                       (double)m->spec.thickness));
    if (m->spec.pretension != 0 || m->spec.curvature != 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "        pretension %g N, curvature %g 1/m about (%g, %g, %g)\n",
                                       (double)m->spec.pretension, (double)m->spec.curvature, (double)m->spec.normal[0],
                                       (double)m->spec.normal[1], (double)m->spec.normal[2]));
    if (m->spec.curve)
      PetscCall(PetscViewerASCIIPrintf(viewer, "        curve of length %g m in the plane across (%g, %g, %g)\n",
                                       (double)m->spec.curvelength, (double)m->spec.normal[0], (double)m->spec.normal[1],
                                       (double)m->spec.normal[2]));
  }
  if (ancf->njoints) PetscCall(PetscViewerASCIIPrintf(viewer, "joints %" PetscInt_FMT "\n", ancf->njoints));
  PetscCall(PetscViewerASCIIPrintf(viewer, "constraints: %s\n", AncfConstraintTypes[ancf->constraints]));
  if (ancf->nbeams > 10) PetscCall(PetscViewerASCIIPrintf(viewer, "and %" PetscInt_FMT " more beams\n", ancf->nbeams - 10));
  if (ancf->setup) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "form: %s\n", AncfForms[ancf->form]));
    if (ancf->ngroups)
      PetscCall(
          PetscViewerASCIIPrintf(viewer, "groups %" PetscInt_FMT ", each with a TS as this one of the first\n", ancf->ngroups));
    PetscCall(TSView(ancf->ts, viewer));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfDestroy(Ancf *ancf)
{
  Ancf a;

  PetscFunctionBegin;
  if (!ancf || !*ancf) PetscFunctionReturn(PETSC_SUCCESS);
  a = *ancf;
  PetscCall(AncfGroupDestroy(a));
  PetscCall(AncfTSDestroy(a));
  PetscCall(AncfJointDestroy(a));
  PetscCall(AncfDaeDestroy(a));
  PetscCall(PetscFree7(a->e, a->v, a->a, a->load, a->weight, a->steady, a->rest));
  PetscCall(PetscFree2(a->fixed, a->mass));
  PetscCall(PetscFree(a->loadend));
  PetscCall(PetscFree(a->permanent));
  PetscCall(PetscFree(a->moment));
  PetscCall(PetscFree4(a->motion, a->resta, a->restm, a->restv));
  PetscCall(PetscFree2(a->stage, a->impulse));
  PetscCall(PetscFree2(a->spin, a->spinsum));
  PetscCall(PetscFree2(a->natural, a->shape));
  PetscCall(PetscFree(a->normal));
  PetscCall(PetscFree(a->supports));
  PetscCall(PetscFree(a->saved));
  PetscCall(PetscFree(a->batches));
  PetscCall(PetscFree(a->lanebeams));
  for (PetscInt b = 0; b < a->nbeams; b++) {
    void *curve = (void *)a->beams[b].spec.curve;

    PetscCall(PetscFree(curve));
  }
  PetscCall(PetscFree(a->beams));
  PetscCall(PetscFree(a->prefix));
  PetscCall(PetscFree(*ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The TS that integrates the beams (the first group's, see AncfSetGroupNodes()), for choices without an option of ours; borrowed.
 */
PetscErrorCode AncfGetTS(Ancf ancf, TS *ts)
{
  PetscFunctionBegin;
  ancf->exposed = PETSC_TRUE;
  *ts = ancf->ts;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetNumBeams(Ancf ancf, PetscInt *n)
{
  PetscFunctionBegin;
  *n = ancf->nbeams;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetNumNodes(Ancf ancf, PetscInt *n)
{
  PetscFunctionBegin;
  *n = ancf->nnodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Any output may be NULL; the spec is returned with EA, EI and rhoA resolved. */
PetscErrorCode AncfGetBeam(Ancf ancf, PetscInt beam, AncfBeamSpec *spec, PetscInt *firstnode, PetscReal *elementlength)
{
  PetscFunctionBegin;
  PetscCheck(beam >= 0 && beam < ancf->nbeams, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, beam, ancf->nbeams - 1);
  if (spec) {
    *spec = ancf->beams[beam].spec;
    spec->EA = ancf->beams[beam].EA;
    spec->EI = ancf->beams[beam].EI;
    spec->rhoA = ancf->beams[beam].rhoA;
  }
  if (firstnode) *firstnode = ancf->beams[beam].node;
  if (elementlength) *elementlength = ancf->beams[beam].l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The beam of a node. */
PetscInt AncfFindBeam(Ancf ancf, PetscInt node)
{
  PetscInt lo = 0, hi = ancf->nbeams;

  while (hi - lo > 1) {
    PetscInt mid = (lo + hi) / 2;

    if (ancf->beams[mid].node <= node)
      lo = mid;
    else
      hi = mid;
  }
  return lo;
}

PetscErrorCode AncfGetCounts(Ancf ancf, PetscInt *steps, PetscInt *newton, PetscInt *linear)
{
  PetscInt most[3] = {0}, n[3] = {0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < PetscMax(1, ancf->ngroups); k++) {
    Ancf g = ancf->ngroups ? ancf->groups[k] : ancf;

    PetscCall(TSGetStepNumber(g->ts, &n[0]));
    PetscCall(TSGetSNESIterations(g->ts, &n[1]));
    PetscCall(TSGetKSPIterations(g->ts, &n[2]));
    for (int i = 0; i < 3; i++) most[i] = PetscMax(most[i], n[i] - g->uncounted[i]);
  }
  if (steps) *steps = most[0];
  if (newton) *newton = most[1];
  if (linear) *linear = most[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}
