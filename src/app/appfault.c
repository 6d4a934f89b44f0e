/*
  appfault.c - values that are not finite: put in on purpose (-fault_nan), and traced to where they began.

  A NaN spreads to all neighbours within a step and to the structures within two, and the fluid is searched only every
  sph_check_every steps, so that the line of the error names what it met first. AppTraceFault() takes the steps again from the
  last good state and searches every field before each.
*/
#include "app.h"
#include <math.h>
#include <string.h>

static PetscErrorCode poke_fluid(App *app, PetscReal value)
{
  const AppScene *s = &app->scene;
  const PetscInt n = app->nfluid + app->nboundary, i = s->faultmarker;
  PetscReal *x;
  SphFields f;

  PetscFunctionBegin;
  PetscCheck(app->sph && i < n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "fault_nan: marker %" PetscInt_FMT " must be below %" PetscInt_FMT "", i, n);
  PetscCall(PetscMalloc1(3 * (size_t)n, &x));
  PetscCall(PetscMemzero(&f, sizeof(f)));
  if (s->faultfield == FAULT_X)
    f.x = x;
  else if (s->faultfield == FAULT_V)
    f.v = x;
  else
    f.rho = x;
  PetscCall(SphGetFields(app->sph, &f));
  x[s->faultfield == FAULT_RHO ? i : 3 * i] = value;
  PetscCall(SphSetFields(app->sph, &f));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode poke_beam(App *app, PetscReal value)
{
  const AppScene *s = &app->scene;
  const PetscBool slope = (PetscBool)(s->faultfield == FAULT_BEAM_SLOPE || s->faultfield == FAULT_BEAM_SLOPE_V);
  const PetscBool rate = (PetscBool)(s->faultfield == FAULT_BEAM_V || s->faultfield == FAULT_BEAM_SLOPE_V);
  const PetscReal *e, *v;
  PetscInt n = 0;

  PetscFunctionBegin;
  if (app->ancf) PetscCall(AncfGetNumNodes(app->ancf, &n));
  PetscCheck(s->faultmarker < n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "fault_nan: node %" PetscInt_FMT " must be below %" PetscInt_FMT "", s->faultmarker, n);
  PetscCall(AncfGetState(app->ancf, NULL, &e, &v, NULL));
  ((PetscReal *)(size_t)(rate ? v : e))[6 * s->faultmarker + (slope ? 3 : 0)] = value; /* AncfSetState() would refuse it */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The packed state begins with position, orientation, velocity, angular momentum and angular velocity of each body. */
static PetscErrorCode poke_body(App *app, PetscReal value)
{
  const AppScene *s = &app->scene;
  const int at[] = {0, 3, 7, 10};
  PetscReal *pack;
  PetscInt n;

  PetscFunctionBegin;
  PetscCheck(app->rigid && s->faultmarker < s->nbodies, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "fault_nan: body %" PetscInt_FMT " must be below %" PetscInt_FMT "", s->faultmarker, s->nbodies);
  PetscCall(RigidGetPackSize(app->rigid, &n));
  PetscCall(PetscMalloc1(n, &pack));
  PetscCall(RigidPack(app->rigid, pack));
  pack[RIGID_PACK_SIZE * s->faultmarker + at[s->faultfield - FAULT_BODY_X]] = value;
  if (s->faultfield == FAULT_BODY_OMEGA) pack[RIGID_PACK_SIZE * s->faultmarker + 13] = value;
  PetscCall(RigidUnpack(app->rigid, pack));
  PetscCall(PetscFree(pack));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The option -fault_nan: before the chosen step one value becomes fault_value, or NaN when that is 0 (current PETSc refuses NaN
 * as the default of an option). */
PetscErrorCode AppInjectFault(App *app)
{
  const AppScene *s = &app->scene;
  const PetscReal value = s->faultvalue != 0.0 ? s->faultvalue : (PetscReal)NAN;

  PetscFunctionBegin;
  if (s->faultstep < 0 || app->step != s->faultstep) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->faultfield >= FAULT_BODY_X)
    PetscCall(poke_body(app, value));
  else if (s->faultfield >= FAULT_BEAM_X)
    PetscCall(poke_beam(app, value));
  else
    PetscCall(poke_fluid(app, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first of n values that is not finite, or -1. */
static PetscInt first_bad(const PetscReal *x, PetscInt n)
{
  for (PetscInt i = 0; i < n; i++)
    if (PetscIsInfOrNanReal(x[i])) return i;
  return -1;
}

static PetscErrorCode search_fluid(App *app, size_t len, char text[])
{
  static const char *const names[] = {"position", "velocity", "density", "acceleration"};
  const PetscInt n = app->nfluid + app->nboundary;
  PetscReal *x;

  PetscFunctionBegin;
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3 * (size_t)n, &x));
  for (int k = 0; k < 4 && !text[0]; k++) {
    const PetscInt width = k == 2 ? 1 : 3;
    PetscInt bad;
    SphFields f = {NULL, NULL, NULL, NULL, NULL, NULL};
    if (k == 0) f.x = x;
    if (k == 1) f.v = x;
    if (k == 2) f.rho = x;
    if (k == 3) f.a = x;
    PetscCall(SphGetFields(app->sph, &f));
    bad = first_bad(x, width * n);
    if (bad >= 0)
      snprintf(text, len, "%s of marker %" PetscInt_FMT " (%s)", names[k], bad / width,
               bad / width < app->nfluid ? "fluid" : "boundary");
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode search_structures(App *app, size_t len, char text[])
{
  const PetscReal *e, *v;
  PetscReal X[3], q[4], V[3], W[3];
  PetscInt n, first;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < app->scene.nbeams && app->ancf && !text[0]; b++) {
    PetscInt bad;
    n = app->scene.beams[b].spec.elements + 1;
    PetscCall(AncfGetBeam(app->ancf, b, NULL, &first, NULL));
    PetscCall(AncfGetState(app->ancf, NULL, &e, &v, NULL));
    if ((bad = first_bad(e + 6 * first, 6 * n)) >= 0)
      snprintf(text, len, "position of node %" PetscInt_FMT " of beam '%s'", bad / 6, app->scene.beams[b].name);
    else if ((bad = first_bad(v + 6 * first, 6 * n)) >= 0)
      snprintf(text, len, "velocity of node %" PetscInt_FMT " of beam '%s'", bad / 6, app->scene.beams[b].name);
  }
  for (PetscInt b = 0; b < app->scene.nbodies && app->rigid && !text[0]; b++) {
    PetscCall(RigidGetState(app->rigid, b, X, q, V, W));
    if (first_bad(X, 3) >= 0 || first_bad(q, 4) >= 0)
      snprintf(text, len, "position of body '%s'", app->scene.bodies[b].name);
    else if (first_bad(V, 3) >= 0 || first_bad(W, 3) >= 0)
      snprintf(text, len, "velocity of body '%s'", app->scene.bodies[b].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The app is in a good state; take steps to the one that failed and say in words which value is not finite first, and before which
  step. text is empty when none is: then the step itself made it, or the failure was another.
*/
PetscErrorCode AppTraceFault(App *app, PetscInt failed, PetscReal tmax, size_t len, char text[])
{
  char what[128] = "";
  PetscReal dt;

  PetscFunctionBegin;
  text[0] = 0;
  while (!what[0] && app->step <= failed) {
    PetscCall(AppInjectFault(app));
    PetscCall(search_structures(app, sizeof(what), what));
    if (!what[0]) PetscCall(search_fluid(app, sizeof(what), what));
    if (!what[0] && AppStep(app, tmax, &dt)) break;
  }
  if (what[0])
    snprintf(text, len, "the first value that is not finite is the %s, before step %" PetscInt_FMT, what, app->step + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
