/* sceneload.c - the permanent loads of a scene's beams: a force at a point, a load along the axis, moments at the ends. */
#include "app.h"

static PetscReal norm3(const PetscReal v[3])
{
  return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* A moment needs an end that can turn, and an axis across the beam, which has no twist. */
static PetscErrorCode check_moment(const App *app, const SceneBeam *b, int end)
{
  const PetscReal *M = b->moment[end], size = norm3(M);
  const AncfEnd support = end ? b->spec.end1 : b->spec.end0;
  PetscReal e[6], along;

  PetscFunctionBegin;
  if (size == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(support != ANCF_END_CLAMP, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "beam_%s_moment%d = %g,%g,%g N m: this end is clamped, so it has no effect; leave it out, or free or pin the end",
             b->name, end, (double)M[0], (double)M[1], (double)M[2]);
  PetscCheck(app->dim == 3 || (M[0] == 0 && M[1] == 0), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam_%s_moment%d = %g,%g,%g N: in 2D only its z component may differ from 0", b->name, end, (double)M[0],
             (double)M[1], (double)M[2]);
  PetscCall(AncfBeamSpecGetPoint(&b->spec, (PetscReal)end, e));
  along = (M[0] * e[3] + M[1] * e[4] + M[2] * e[5]) / norm3(e + 3);
  PetscCheck(PetscAbsReal(along) <= 1e-6 * size, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "beam_%s_moment%d = %g,%g,%g N m: %g N m of it are along the beam and would twist it; a cable element has no twist, "
             "only moments across the beam are allowed",
             b->name, end, (double)M[0], (double)M[1], (double)M[2], (double)along);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_loads(const App *app, const SceneBeam *b)
{
  PetscFunctionBegin;
  PetscCheck(app->dim == 3 || (b->pointload[2] == 0 && b->lineload[2] == 0), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam_%s_%s: its z component must be 0 in 2D", b->name, b->pointload[2] != 0 ? "point_load" : "line_load");
  PetscCheck(b->pointat >= 0 && b->pointat <= 1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam_%s_point_load_at = %g: must be in [0, 1], a fraction of the length", b->name, (double)b->pointat);
  PetscCheck(b->ramp >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "beam_%s_load_ramp = %g s: must be 0 (at once) or more",
             b->name, (double)b->ramp);
  for (int end = 0; end < 2; end++) PetscCall(check_moment(app, b, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What part of its loads a beam has now. */
static PetscReal part(const SceneBeam *b, PetscReal t)
{
  return t < b->ramp ? t / b->ramp : 1;
}

static PetscErrorCode add_loads(App *app, PetscInt beam)
{
  const SceneBeam *b = &app->scene.beams[beam];
  const PetscReal up = part(b, app->t);
  PetscReal F[3], q[3];

  PetscFunctionBegin;
  for (int a = 0; a < 3; a++) F[a] = up * b->pointload[a], q[a] = up * b->lineload[a];
  if (norm3(F) > 0) PetscCall(AncfAddPointLoad(app->ancf, beam, b->pointat, F));
  if (norm3(q) > 0) PetscCall(AncfAddLineLoad(app->ancf, beam, q));
  for (int end = 0; end < 2; end++) {
    for (int a = 0; a < 3; a++) F[a] = up * b->moment[end][a];
    if (norm3(F) > 0) PetscCall(AncfSetMoment(app->ancf, beam, end ? b->spec.elements : 0, F));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads of all beams, once they are set up. */
PetscErrorCode AppBuildBeamLoads(App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->scene.nbeams; i++) {
    PetscCall(check_loads(app, &app->scene.beams[i]));
    PetscCall(add_loads(app, i));
    app->loadramp = PetscMax(app->loadramp, app->scene.beams[i].ramp);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads that come up with time, for the step from app->t on; a function of the time alone, so that a restart finds them. */
PetscErrorCode AppUpdateBeamLoads(App *app)
{
  PetscFunctionBegin;
  if (app->loadramp == 0 || PetscMin(app->t, app->loadtime) >= app->loadramp) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AncfClearLoads(app->ancf));
  for (PetscInt i = 0; i < app->scene.nbeams; i++) PetscCall(add_loads(app, i));
  app->loadtime = app->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sum of M . omega, omega = r' x dr'/dt/|r'|^2 being the turning of the end's tangent. */
PetscErrorCode AppBeamMomentPower(App *app, PetscReal *power)
{
  const PetscReal *e, *v;

  PetscFunctionBegin;
  *power = 0;
  PetscCall(AncfGetState(app->ancf, NULL, &e, &v, NULL));
  for (PetscInt i = 0; i < app->scene.nbeams; i++) {
    const SceneBeam *b = &app->scene.beams[i];
    PetscInt first;

    PetscCall(AncfGetBeam(app->ancf, i, NULL, &first, NULL));
    for (int end = 0; end < 2; end++) {
      const PetscInt at = 6 * (first + (end ? b->spec.elements : 0)) + 3;
      const PetscReal *r = e + at, *d = v + at;

      for (int a = 0; a < 3; a++) {
        const int p = (a + 1) % 3, q = (a + 2) % 3;

        *power += part(b, app->t) * b->moment[end][a] * (r[p] * d[q] - r[q] * d[p]) / (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
