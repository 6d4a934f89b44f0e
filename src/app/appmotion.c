/*
  appmotion.c - what changes with time as a scene prescribes it: walls that move bodily (paddles, pistons, stirred boxes) and the
  body force.

  A moving wall is a prescribed body of its own solver: its markers are carried along by CoupleSurfaceCreateMoving(), the table is
  that of RigidSetMotionTable().
*/
#include "app.h"
#include <string.h>

#define SAMPLES 400

/* The prescribed body of a moving wall, about its pivot. */
static PetscErrorCode create_mover(App *app, PetscInt face, Rigid *rigid)
{
  static const char *const columns[] = {"vx", "vy", "vz", "wx", "wy", "wz", NULL};
  const AppScene *s = &app->scene;
  const SceneWall *w = &s->walls[face];
  RigidBodySpec spec;
  AppTable table;
  PetscReal *v, *omega;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, rigid));
  PetscCall(RigidSetDimension(*rigid, app->dim));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_PRESCRIBED;
  spec.size[0] = 1;
  for (PetscInt a = 0; a < app->dim; a++) {
    spec.position[a] = w->pivot[a];
    spec.velocity[a] = s->wallvelocity[face][a];
  }
  PetscCall(PetscArraycpy(spec.omega, w->omega, 3));
  PetscCall(RigidAddBody(*rigid, &spec, NULL));
  if (strcmp(w->motion, "constant")) {
    PetscCall(AppTableRead(w->motion, columns, s->tend, &table));
    PetscCall(PetscMalloc2(3 * (size_t)table.n, &v, 3 * (size_t)table.n, &omega));
    for (PetscInt i = 0; i < 3 * table.n; i++) {
      v[i] = table.value[6 * (i / 3) + i % 3];
      omega[i] = table.value[6 * (i / 3) + 3 + i % 3];
    }
    for (PetscInt i = 0; i < 3 * table.n; i++)
      PetscCheck(omega[i] == 0 || w->setpivot, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                 "'%s' turns the wall: wall_%s_pivot is needed, the point to turn about", w->motion, SceneFaces[face]);
    PetscCall(RigidSetMotionTable(*rigid, 0, table.n, table.t, v, omega));
    PetscCall(PetscFree2(v, omega));
    PetscCall(AppTableDestroy(&table));
  }
  PetscCall(RigidSetUp(*rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far (m) the wall's corners move out of the domain during the run: beyond the wall layers fluid would be lost behind it. */
static PetscErrorCode check_reach(App *app, PetscInt face, Rigid rigid)
{
  const AppScene *s = &app->scene;
  const SceneWall *w = &s->walls[face];
  const PetscInt a = face / 2;
  PetscReal out = 0, support, X[3], q[4], R[9], *pack;
  PetscInt size;

  PetscFunctionBegin;
  PetscCall(SphGetSupport(app->sph, &support));
  PetscCall(RigidGetPackSize(rigid, &size));
  PetscCall(PetscMalloc1(size, &pack));
  PetscCall(RigidPack(rigid, pack));
  for (PetscInt i = 1; i <= SAMPLES; i++) {
    PetscCall(RigidAdvance(rigid, s->tend * (PetscReal)i / SAMPLES));
    PetscCall(RigidGetState(rigid, 0, X, q, NULL, NULL));
    RigidRotationMatrix(q, R);
    for (int c = 0; c < 8; c++) {
      PetscReal y = X[a];
      for (PetscInt k = 0; k < app->dim; k++) {
        const PetscReal corner = k == a ? (face % 2 ? s->hi[k] : s->lo[k]) : (c >> k & 1 ? s->fluidhi[k] : s->fluidlo[k]);
        y += R[3 * a + k] * (corner - w->pivot[k]);
      }
      out = PetscMax(out, face % 2 ? y - s->hi[a] : s->lo[a] - y);
    }
  }
  PetscCall(RigidUnpack(rigid, pack));
  PetscCall(RigidSetTime(rigid, 0));
  PetscCall(PetscFree(pack));
  PetscCheck(
      out <= support, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
      "wall_%s_motion: the wall moves %g m out of the domain, more than the layer of the other walls, %g m: let the domain "
      "begin where the wall's outermost position is",
      SceneFaces[face], (double)out, (double)support);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A wall that moves bodily; x (n x 3, m), volume (n), depth (n, m) of its markers at the start. */
PetscErrorCode AppWallCreateMoving(App *app, PetscInt face, const char name[], PetscInt n, const PetscReal *x,
                                   const PetscReal *volume, const PetscReal *depth, CoupleSurface *surface)
{
  PetscFunctionBegin;
  AppDoing(app, "wall_%s_motion", SceneFaces[face]);
  PetscCall(create_mover(app, face, &app->mover[face]));
  AppDoing(app, "%s", "");
  PetscCall(check_reach(app, face, app->mover[face]));
  PetscCall(CoupleSurfaceCreateMoving(app->mover[face], 0, name, n, x, volume, depth, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gravity, and the force of sph_body_force as it comes up with time. */
PetscErrorCode AppBodyForce(App *app)
{
  static const char *const columns[] = {"fx", "fy", "fz", NULL};
  const AppScene *s = &app->scene;
  PetscReal f[3], g[3] = {0, 0, 0};
  AppTable table;

  PetscFunctionBegin;
  PetscCall(SphGetBodyForce(app->sph, f));
  for (int a = 0; a < 3 && s->buoyancy == BUOYANCY_RESOLVED; a++) g[a] = s->gravity[a];
  if (s->forceramp > 0) {
    const PetscReal t[2] = {0, s->forceramp}, ramp[6] = {0, 0, 0, f[0], f[1], f[2]};
    PetscCheck(!s->forcefile[0], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
               "body_force_ramp and body_force_file: give only one of them");
    PetscCall(SphSetBodyForceTable(app->sph, 2, t, ramp));
  } else
    for (int a = 0; a < 3; a++) g[a] += f[a];
  if (s->forcefile[0]) {
    AppDoing(app, "body_force_file");
    PetscCall(AppTableRead(s->forcefile, columns, s->tend, &table));
    PetscCall(SphSetBodyForceTable(app->sph, table.n, table.t, table.value));
    PetscCall(AppTableDestroy(&table));
    AppDoing(app, "%s", "");
  }
  PetscCall(SphSetBodyForce(app->sph, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
