/*
  test_sph_conformance.c - every backend of the fluid against sums by brute force in double precision, with bounds per field.

  Run once per backend (-type cpu | cuda; cuda needs a device, else the test is skipped). Both precisions, eight scenes that
  between them use every kernel, wall, viscosity, diffusion, re-initialisation and integrator, 2D and 3D, periodic sides of 1, 2
  and 3 cells.
  Bounds: sph_reference.h.
*/
#include "sph_link.h"
#include "sph_reference.h"

static const Scene scenes[] = {
    {"3d cubic adami eq6 shepard",
     3,
     {8, 7, 6},
     {1, 0, 1},
     SPH_KERNEL_CUBIC,
     SPH_WALL_ADAMI,
     SPH_VISCOSITY_EQ6,
     SPH_DIFFUSION_NONE,
     SPH_REINIT_SHEPARD,
     SPH_INTEGRATOR_RK2,
     0.5,
     0.0,
     7.0,
     1.2},
    {"3d wendland bce morris sum",
     3,
     {7, 6, 6},
     {0, 0, 0},
     SPH_KERNEL_WENDLAND,
     SPH_WALL_BCE,
     SPH_VISCOSITY_MORRIS,
     SPH_DIFFUSION_NONE,
     SPH_REINIT_SUM,
     SPH_INTEGRATOR_RK2,
     0.5,
     200.0,
     7.0,
     1.2},
    {"3d wendland adami artificial fourtakas",
     3,
     {6, 8, 6},
     {0, 0, 1},
     SPH_KERNEL_WENDLAND,
     SPH_WALL_ADAMI,
     SPH_VISCOSITY_ARTIFICIAL,
     SPH_DIFFUSION_FOURTAKAS,
     SPH_REINIT_NONE,
     SPH_INTEGRATOR_SYMPLECTIC,
     0.0,
     0.0,
     7.0,
     1.7320508},
    {"3d cubic bce artificial molteni no xsph",
     3,
     {6, 6, 6},
     {0, 0, 0},
     SPH_KERNEL_CUBIC,
     SPH_WALL_BCE,
     SPH_VISCOSITY_ARTIFICIAL,
     SPH_DIFFUSION_MOLTENI,
     SPH_REINIT_SHEPARD,
     SPH_INTEGRATOR_VERLET,
     0.0,
     0.0,
     7.0,
     1.2},
    {"2d cubic adami eq6 one periodic cell",
     2,
     {3, 20, 1},
     {1, 0, 0},
     SPH_KERNEL_CUBIC,
     SPH_WALL_ADAMI,
     SPH_VISCOSITY_EQ6,
     SPH_DIFFUSION_NONE,
     SPH_REINIT_SHEPARD,
     SPH_INTEGRATOR_RK2,
     0.5,
     100.0,
     7.0,
     1.2},
    {"2d wendland adami morris two periodic cells",
     2,
     {6, 20, 1},
     {1, 0, 0},
     SPH_KERNEL_WENDLAND,
     SPH_WALL_ADAMI,
     SPH_VISCOSITY_MORRIS,
     SPH_DIFFUSION_MOLTENI,
     SPH_REINIT_SUM,
     SPH_INTEGRATOR_VERLET,
     0.3,
     0.0,
     1.0,
     1.2},
    {"2d wendland bce eq6 diffusion",
     2,
     {24, 20, 1},
     {0, 0, 0},
     SPH_KERNEL_WENDLAND,
     SPH_WALL_BCE,
     SPH_VISCOSITY_EQ6,
     SPH_DIFFUSION_FOURTAKAS,
     SPH_REINIT_SUM,
     SPH_INTEGRATOR_SYMPLECTIC,
     1.0,
     0.0,
     4.0,
     1.5},
    {"2d cubic adami artificial",
     2,
     {20, 16, 1},
     {0, 0, 0},
     SPH_KERNEL_CUBIC,
     SPH_WALL_ADAMI,
     SPH_VISCOSITY_ARTIFICIAL,
     SPH_DIFFUSION_MOLTENI,
     SPH_REINIT_NONE,
     SPH_INTEGRATOR_RK2,
     0.0,
     0.0,
     7.0,
     2.0},
};

/* The state after a stage, from the formulas of the integrator: old, previous and middle states in, new state out. */
static void Expect(const SphParams *p, int stage, const Snapshot *n, const Snapshot *mid, const Snapshot *prev, double dt,
                   double span, PetscInt i, double x[3], double v[3], double *s)
{
  const Snapshot *rate = mid ? mid : n;
  const double rho = 1.0 + n->s[i];

  for (int k = 0; k < 3; k++) {
    const double acc = k < p->dim ? rate->a[k][i] + p->f[k] : 0.0;
    if (stage == 0) {
      x[k] = n->x[k][i] + 0.5 * dt * (n->v[k][i] + n->dv[k][i]);
      v[k] = n->v[k][i] + 0.5 * dt * acc;
    } else if (p->integrator == SPH_INTEGRATOR_RK2) {
      x[k] = n->x[k][i] + dt * (mid->v[k][i] + mid->dv[k][i]);
      v[k] = n->v[k][i] + dt * acc;
    } else if (p->integrator == SPH_INTEGRATOR_SYMPLECTIC) {
      v[k] = n->v[k][i] + dt * acc;
      x[k] = n->x[k][i] + dt * (0.5 * (v[k] + n->v[k][i]) + mid->dv[k][i]);
    } else {
      x[k] = n->x[k][i] + dt * (n->v[k][i] + n->dv[k][i]) + 0.5 * dt * dt * acc;
      v[k] = prev ? prev->v[k][i] + span * acc : n->v[k][i] + dt * acc;
    }
  }
  if (stage == 0)
    *s = n->s[i] + 0.5 * dt * n->ds[i];
  else if (p->integrator == SPH_INTEGRATOR_SYMPLECTIC) {
    const double e = -dt * mid->ds[i] / (1.0 + mid->s[i]);
    *s = rho * (2.0 - e) / (2.0 + e) - 1.0;
  } else if (p->integrator == SPH_INTEGRATOR_VERLET && prev)
    *s = prev->s[i] + span * n->ds[i];
  else
    *s = n->s[i] + dt * rate->ds[i];
}

/* got: the state after the stage. Positions are compared modulo the period; a few roundings of double precision are allowed. */
static void CheckStage(const SphParams *p, int stage, const Snapshot *n, const Snapshot *mid, const Snapshot *prev,
                       const Snapshot *got, double dt, double span, const char *scene)
{
  PetscInt bad = 0;

  for (PetscInt i = 0; i < got->n; i++) {
    const int fluid = n->group[i] == -1, evolves = fluid || (n->group[i] >= 0 && p->wall == SPH_WALL_BCE);
    double x[3], v[3], s;
    Expect(p, stage, n, mid, prev, dt, span, i, x, v, &s);
    for (int k = 0; k < p->dim && fluid; k++) {
      double e = got->x[k][i] - x[k];
      if (p->periodic[k]) e -= (p->hi[k] - p->lo[k]) * rint(e / (p->hi[k] - p->lo[k]));
      bad += !(fabs(e) <= 16.0 * U2 * (1.0 + fabs(x[k])));
      bad += !(fabs(got->v[k][i] - v[k]) <= 16.0 * U2 * (1.0 + fabs(v[k]) + span * fabs(n->a[k][i])));
    }
    if (evolves) bad += !(fabs(got->s[i] - s) <= 16.0 * U2 * (1.0 + fabs(s)));
  }
  TEST(bad == 0, "%s: stage %d: %d values differ from the integrator's formulas", scene, stage, (int)bad);
}

static PetscErrorCode CheckStages(const Scene *c, const char *type)
{
  Snapshot n, prev, mid, end, half;
  const double dt[3] = {1e-4, 1.5e-4, 1.2e-4};
  Scene still = *c;
  double t = 0.0;
  Sph sph;

  PetscFunctionBegin;
  still.reinit = SPH_REINIT_NONE;
  PetscCall(SceneCreate(&still, type, SPH_PRECISION_DOUBLE, &sph));
  PetscCall(SphSetUp(sph));
  PetscCall(Take(sph, &prev));
  for (int step = 0; step < 3; step++) {
    const int verlet = c->integrator == SPH_INTEGRATOR_VERLET;
    PetscCall(Take(sph, &n)); /* boundary densities of adami walls are renewed by the sweep below */
    PetscCall(SphStepBegin(sph, dt[step]));
    PetscCall(Take(sph, &half));
    for (int k = 0; k < 3; k++) {
      PetscCall(PetscArraycpy(n.a[k], half.a[k], n.n));
      PetscCall(PetscArraycpy(n.dv[k], half.dv[k], n.n));
    }
    PetscCall(PetscArraycpy(n.ds, half.ds, n.n));
    if (!verlet) CheckStage(&sph->par, 0, &n, NULL, NULL, &half, dt[step], 0.0, c->name);
    PetscCall(SceneMoveBody(sph, &still, t + 0.5 * dt[step]));
    PetscCall(SphStepEnd(sph));
    PetscCall(Take(sph, &end));
    PetscCall(CheckForcesAndLimits(sph, &end, c->name));
    for (PetscInt i = 0; i < n.n; i++) { /* rates of the middle, state of the middle */
      for (int k = 0; k < 3; k++) {
        half.a[k][i] = end.a[k][i];
        half.dv[k][i] = end.dv[k][i];
      }
      half.ds[i] = end.ds[i];
    }
    mid = half;
    CheckStage(&sph->par, 1, &n, verlet ? NULL : &mid, verlet && step ? &prev : NULL, &end, dt[step],
               step ? dt[step] + dt[step - 1] : 0.0, c->name);
    t += dt[step];
    PetscCall(SceneMoveBody(sph, &still, t));
    PetscCall(Drop(&half));
    PetscCall(Drop(&end));
    PetscCall(Drop(&prev));
    prev = n;
  }
  PetscCall(Drop(&prev));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is set is what is read back, and twice the same run gives the same bits. */
static PetscErrorCode CheckRoundTrip(const Scene *c, const char *type, SphPrecision precision)
{
  Sph sph[2];
  Snapshot t[2], back;
  SphFields f = {0};
  PetscInt bad = 0, differ = 0;

  PetscFunctionBegin;
  for (int run = 0; run < 2; run++) {
    PetscCall(SceneCreate(c, type, precision, &sph[run]));
    PetscCall(SphSetUp(sph[run]));
    for (int step = 0; step < 12; step++) PetscCall(SceneStep(sph[run], c, 1e-4));
    PetscCall(Take(sph[run], &t[run]));
  }
  for (PetscInt i = 0; i < t[0].n; i++)
    for (int k = 0; k < 3; k++)
      differ +=
          t[0].x[k][i] != t[1].x[k][i] || t[0].v[k][i] != t[1].v[k][i] || t[0].a[k][i] != t[1].a[k][i] || t[0].s[i] != t[1].s[i];
  TEST(differ == 0, "%s: two runs differ in %d values", c->name, (int)differ);
  PetscCall(PetscMalloc3(3 * (size_t)t[0].n, &f.x, 3 * (size_t)t[0].n, &f.v, t[0].n, &f.rho));
  PetscCall(SphGetFields(sph[0], &f));
  for (PetscInt i = 0; i < t[0].n; i++) {
    f.v[3 * i] += 0.25;
    f.x[3 * i + 1] += 1e-3;
    f.rho[i] = 1000.0 + 0.001 * (double)i;
  }
  PetscCall(SphSetFields(sph[0], &f));
  PetscCall(Take(sph[0], &back));
  for (PetscInt i = 0; i < t[0].n; i++) {
    for (int k = 0; k < sph[0]->par.dim; k++) bad += back.x[k][i] != f.x[3 * i + k] || back.v[k][i] != f.v[3 * i + k];
    bad += !(fabs(back.s[i] - (f.rho[i] / 1000.0 - 1.0)) <= 2.0 * U2);
  }
  TEST(bad == 0, "%s: %d values changed on the way to the backend and back", c->name, (int)bad);
  PetscCall(SceneStep(sph[0], c, 1e-4)); /* and it goes on from there */
  PetscCall(PetscFree3(f.x, f.v, f.rho));
  for (int run = 0; run < 2; run++) {
    PetscCall(Drop(&t[run]));
    PetscCall(SphDestroy(&sph[run]));
  }
  PetscCall(Drop(&back));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Different(const Snapshot *a, const Snapshot *b)
{
  PetscInt d = 0;
  for (PetscInt i = 0; i < a->n; i++) {
    for (int k = 0; k < 3; k++) d += a->x[k][i] != b->x[k][i] || a->v[k][i] != b->v[k][i] || a->a[k][i] != b->a[k][i];
    d += a->s[i] != b->s[i] || a->group[i] != b->group[i];
  }
  return d;
}

/* A run goes on from a saved state with the same bits: in the same object, and in a new one. */
static PetscErrorCode CheckState(const Scene *c, const char *type)
{
  Sph sph, other;
  Snapshot t[3];
  size_t bytes;
  void *state;

  PetscFunctionBegin;
  PetscCall(SceneCreate(c, type, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SphSetUp(sph));
  for (int step = 0; step < 6; step++) PetscCall(SceneStep(sph, c, 2e-4));
  PetscCall(SphGetStateSize(sph, &bytes));
  PetscCall(PetscMalloc(bytes, &state));
  PetscCall(SphSaveState(sph, bytes, state));
  for (int step = 0; step < 7; step++) PetscCall(SceneStep(sph, c, 2e-4));
  PetscCall(Take(sph, &t[0]));
  PetscCall(SphRestoreState(sph, bytes, state));
  for (int step = 0; step < 7; step++) PetscCall(SceneStep(sph, c, 2e-4));
  PetscCall(Take(sph, &t[1]));
  PetscCall(SceneCreate(c, type, SPH_PRECISION_SINGLE, &other));
  PetscCall(SphSetUp(other));
  PetscCall(SphRestoreState(other, bytes, state));
  for (int step = 0; step < 7; step++) PetscCall(SceneStep(other, c, 2e-4));
  PetscCall(Take(other, &t[2]));
  TEST(Different(&t[0], &t[1]) == 0, "%s: %d values differ after going back", c->name, (int)Different(&t[0], &t[1]));
  TEST(Different(&t[0], &t[2]) == 0, "%s: %d values differ in a new object", c->name, (int)Different(&t[0], &t[2]));
  for (int k = 0; k < 3; k++) PetscCall(Drop(&t[k]));
  PetscCall(PetscFree(state));
  PetscCall(SphDestroy(&sph));
  PetscCall(SphDestroy(&other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Named arrays in memory, as a checkpoint has them. */
#define ARRAYS_MAX 128
typedef struct {
  FrondState state; /* first */
  int n;
  char name[ARRAYS_MAX][96];
  size_t bytes[ARRAYS_MAX];
  void *data[ARRAYS_MAX];
} Named;

static int FindNamed(const Named *s, const char name[])
{
  int i = 0;
  while (i < s->n && strcmp(s->name[i], name)) i++;
  return i;
}

static PetscErrorCode MoveNamed(FrondState *state, const char name[], FrondStateType type, size_t n, void *x)
{
  Named *s = (Named *)state;
  const int i = FindNamed(s, name);
  const size_t bytes = n * FrondStateSize(type);

  PetscFunctionBegin;
  if (state->way == FROND_STATE_SAVE) {
    PetscCheck(i == s->n && i < ARRAYS_MAX, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s is moved twice", name);
    PetscCall(PetscStrncpy(s->name[i], name, sizeof(s->name[i])));
    PetscCall(PetscMalloc(bytes, &s->data[i]));
    if (bytes) memcpy(s->data[i], x, bytes);
    s->bytes[i] = bytes;
    s->n++;
  } else {
    PetscCheck(i < s->n && s->bytes[i] == bytes, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s is not there in this size",
               name);
    if (bytes) memcpy(x, s->data[i], bytes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode HasNamed(FrondState *state, const char name[], PetscBool *yes)
{
  *yes = FindNamed((Named *)state, name) < ((Named *)state)->n ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_SUCCESS;
}

/*
  A checkpoint of one backend goes on in the other one: the same bits once it is read, and in double precision the run that was
  not interrupted but for the order of the sums. These are of some 100 neighbours, good to 1e-14 of terms that cancel to a
  hundredth; 7 steps of 2e-4 s at accelerations up to 1e3 m/s^2 make that 1e-12 m/s.
*/
static PetscErrorCode CheckOther(const Scene *c, const char *from, const char *to)
{
  Sph sph, other;
  Snapshot t[4];
  Named *s;
  double worst = 0.0;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->state.move = MoveNamed;
  s->state.has = HasNamed;
  PetscCall(SceneCreate(c, from, SPH_PRECISION_DOUBLE, &sph));
  PetscCall(SphSetUp(sph));
  for (int step = 0; step < 6; step++) PetscCall(SceneStep(sph, c, 2e-4));
  s->state.way = FROND_STATE_SAVE;
  PetscCall(SphMoveState(sph, &s->state));
  PetscCall(Take(sph, &t[0]));
  PetscCall(SceneCreate(c, to, SPH_PRECISION_DOUBLE, &other));
  PetscCall(SphSetUp(other));
  s->state.way = FROND_STATE_LOAD;
  PetscCall(SphMoveState(other, &s->state));
  PetscCall(Take(other, &t[1]));
  TEST(Different(&t[0], &t[1]) == 0, "%s: %d values differ once %s has read the state of %s", c->name,
       (int)Different(&t[0], &t[1]), to, from);
  for (int step = 0; step < 7; step++) {
    PetscCall(SceneStep(sph, c, 2e-4));
    PetscCall(SceneStep(other, c, 2e-4));
  }
  PetscCall(Take(sph, &t[2]));
  PetscCall(Take(other, &t[3]));
  for (PetscInt i = 0; i < t[2].n; i++)
    for (int k = 0; k < 3; k++) worst = PetscMax(worst, PetscAbsReal(t[2].v[k][i] - t[3].v[k][i]));
  printf("%s: from %s to %s: velocities part by %.2g m/s in 7 steps\n", c->name, from, to, worst);
  TEST(worst < 1e-12, "%s: from %s to %s: velocities part by %g m/s", c->name, from, to, worst);
  for (int k = 0; k < 4; k++) PetscCall(Drop(&t[k]));
  for (int k = 0; k < s->n; k++) PetscCall(PetscFree(s->data[k]));
  PetscCall(PetscFree(s));
  PetscCall(SphDestroy(&sph));
  PetscCall(SphDestroy(&other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* NaN in a velocity is reported as a floating-point error within -sph_check_every steps; a marker far outside is taken out. */
static PetscErrorCode CheckTrouble(const Scene *c, const char *type)
{
  Sph sph;
  SphFields f = {0};
  PetscInt left = -1;
  PetscErrorCode err = PETSC_SUCCESS;

  PetscFunctionBegin;
  for (int trouble = 0; trouble < 3; trouble++) {
    PetscCall(SceneCreate(c, type, SPH_PRECISION_SINGLE, &sph));
    PetscCall(SphSetCheckEvery(sph, 2));
    PetscCall(SphSetUp(sph));
    PetscCall(PetscMalloc4(3 * (size_t)sph->n, &f.x, 3 * (size_t)sph->n, &f.v, sph->n, &f.rho, sph->n, &f.group));
    PetscCall(SphGetFields(sph, &f));
    if (trouble == 0)
      f.v[3 * 17 + 1] = NAN;
    else if (trouble == 1)
      f.rho[11] = NAN;
    else
      f.x[3 * 17 + 1] += 10.0;
    PetscCall(SphSetFields(sph, &f));
    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    for (int step = 0; step < 2 && !err; step++) err = SceneStep(sph, c, 1e-4);
    PetscCall(PetscPopErrorHandler());
    if (trouble < 2) {
      TEST(err == PETSC_ERR_FP, "%s: a value that is not finite gave error %d", c->name, (int)err);
      err = PETSC_SUCCESS;
    } else {
      TEST(err == PETSC_SUCCESS, "%s: a marker that left gave error %d", c->name, (int)err);
      PetscCall(SphGetCounts(sph, NULL, NULL, &left));
      TEST(left == 1, "%s: %d markers left, expected 1", c->name, (int)left);
      const double y = f.x[3 * 17 + 1];
      PetscCall(SphGetFields(sph, &f));
      TEST(f.group[17] == -2 && f.x[3 * 17 + 1] == y && f.v[3 * 17 + 1] == 0.0, "%s: the marker that left is in group %d at %g",
           c->name, (int)f.group[17], f.x[3 * 17 + 1]);
    }
    PetscCall(PetscFree4(f.x, f.v, f.rho, f.group));
    PetscCall(SphDestroy(&sph));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two markers on top of one another are refused by name. */
static PetscErrorCode CheckOverlapRefused(const char *type)
{
  const PetscReal x[6] = {0.05, 0.05, 0.05, 0.05, 0.0501, 0.05}, lo[3] = {0, 0, 0}, hi[3] = {0.2, 0.2, 0.2};
  Sph sph;
  PetscErrorCode err;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetType(sph, type));
  PetscCall(SphSetSpacing(sph, 0.02));
  PetscCall(SphSetSoundSpeed(sph, 20.0));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphAddFluid(sph, 2, x, NULL, NULL));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  err = SphSetUp(sph);
  PetscCall(PetscPopErrorHandler());
  TEST(err == PETSC_ERR_ARG_WRONG, "coincident markers gave error %d", (int)err);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Available(const char *type, PetscBool *yes)
{
  Sph sph;
  SphType got;
  const PetscReal x[3] = {0.05, 0.05, 0.05}, lo[3] = {0, 0, 0}, hi[3] = {0.2, 0.2, 0.2};

  PetscFunctionBegin;
  *yes = PETSC_TRUE;
  if (strcmp(type, SPHCUDA)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetType(sph, SPHAUTO));
  PetscCall(SphSetSpacing(sph, 0.02));
  PetscCall(SphSetSoundSpeed(sph, 20.0));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphAddFluid(sph, 1, x, NULL, NULL));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetType(sph, &got));
  *yes = strcmp(got, SPHCUDA) ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(const char *type)
{
  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(scenes) / sizeof(scenes[0]); k++)
    for (int precision = 0; precision < 2; precision++) {
      Sph sph;
      PetscCall(SceneCreate(&scenes[k], type, (SphPrecision)precision, &sph));
      PetscCall(SphSetUp(sph));
      printf("%s, %s, %s: %d markers\n", type, SphPrecisions[precision], scenes[k].name, (int)sph->n);
      PetscCall(CheckSums(sph, &scenes[k]));
      PetscCall(SphDestroy(&sph));
      PetscCall(CheckRoundTrip(&scenes[k], type, (SphPrecision)precision));
      if (precision == SPH_PRECISION_DOUBLE) {
        PetscCall(CheckStages(&scenes[k], type));
        PetscCall(SceneCheckLink(&scenes[k], type, SCENE_BODY, "body"));
        PetscCall(SceneCheckLink(&scenes[k], type, SCENE_NODES, "nodes"));
      } else
        PetscCall(CheckState(&scenes[k], type));
    }
  for (size_t k = 0; k < sizeof(scenes) / sizeof(scenes[0]) && strcmp(type, SPHCPU); k++) {
    PetscCall(CheckOther(&scenes[k], SPHCPU, type));
    PetscCall(CheckOther(&scenes[k], type, SPHCPU));
  }
  PetscCall(CheckTrouble(&scenes[0], type));
  PetscCall(CheckTrouble(&scenes[6], type));
  PetscCall(CheckOverlapRefused(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char type[16] = SPHCPU;
  PetscBool have;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-type", type, sizeof(type), NULL));
  PetscCall(Available(type, &have));
  if (!have) {
    printf("no CUDA device: skipped\n");
    PetscCall(PetscFinalize());
    return 77;
  }
  PetscCall(Run(type));
  PetscCall(PetscFinalize());
  return test_report();
}
