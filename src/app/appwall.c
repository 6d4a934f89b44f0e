/*
  appwall.c - walls that slide along themselves, for scenes: the markers stay where they are and carry the wall's velocity.

  A wall that moves along itself covers the same place at all times, so its markers need not move: a lid across a closed
  box stays a lid.
*/
#include "app.h"

typedef struct {
  PetscInt n;
  PetscReal *x, *volume, *depth;
  PetscReal velocity[3];
} Sliding;

static PetscErrorCode GetMarkers_Sliding(CoupleSurface s, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                                         const PetscReal **depth)
{
  Sliding *w;

  PetscFunctionBegin;
  PetscCall(CoupleSurfaceGetContext(s, &w));
  *n = w->n;
  *x = w->x;
  *volume = w->volume;
  *depth = w->depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Kinematics_Sliding(CoupleSurface s, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a)
{
  Sliding *w;

  PetscFunctionBegin;
  (void)dt;
  PetscCall(CoupleSurfaceGetContext(s, &w));
  PetscCall(PetscArraycpy(x, w->x, 3 * w->n));
  PetscCall(PetscArrayzero(a, 3 * w->n));
  for (PetscInt i = 0; i < w->n; i++) PetscCall(PetscArraycpy(v + 3 * i, w->velocity, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ZeroLoads_Sliding(CoupleSurface s)
{
  (void)s;
  return PETSC_SUCCESS;
}

/* A wall takes any force up: nothing is lost. */
static PetscErrorCode ApplyForces_Sliding(CoupleSurface s, const PetscReal *f, CoupleAudit *audit)
{
  (void)s;
  (void)f;
  (void)audit;
  return PETSC_SUCCESS;
}

static PetscErrorCode Advance_Sliding(CoupleSurface s, PetscReal t)
{
  (void)s;
  (void)t;
  return PETSC_SUCCESS;
}

/* It has no state: its markers never move. */
static PetscErrorCode StateSize_Sliding(CoupleSurface s, PetscInt *n)
{
  (void)s;
  *n = 0;
  return PETSC_SUCCESS;
}

static PetscErrorCode Save_Sliding(CoupleSurface s, PetscReal *state)
{
  (void)s;
  (void)state;
  return PETSC_SUCCESS;
}

static PetscErrorCode Load_Sliding(CoupleSurface s, const PetscReal *state)
{
  (void)s;
  (void)state;
  return PETSC_SUCCESS;
}

static PetscErrorCode View_Sliding(CoupleSurface s, PetscViewer viewer)
{
  Sliding *w;
  const char *name;

  PetscFunctionBegin;
  PetscCall(CoupleSurfaceGetContext(s, &w));
  PetscCall(CoupleSurfaceGetName(s, &name));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  wall %s: %" PetscInt_FMT " markers, sliding with (%g, %g, %g) m/s\n", name, w->n,
                                   (double)w->velocity[0], (double)w->velocity[1], (double)w->velocity[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Sliding(CoupleSurface s)
{
  Sliding *w;

  PetscFunctionBegin;
  PetscCall(CoupleSurfaceGetContext(s, &w));
  PetscCall(PetscFree3(w->x, w->volume, w->depth));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A wall of n markers (x: n x 3, m; volume: n, m^3; depth: n, m; all copied) with a velocity (m/s) along itself. */
PetscErrorCode AppWallCreate(const char name[], PetscInt n, const PetscReal *x, const PetscReal *volume, const PetscReal *depth,
                             const PetscReal velocity[3], CoupleSurface *surface)
{
  const CoupleSurfaceOps ops = {.getmarkers = GetMarkers_Sliding,
                                .kinematics = Kinematics_Sliding,
                                .zeroloads = ZeroLoads_Sliding,
                                .applyforces = ApplyForces_Sliding,
                                .advance = Advance_Sliding,
                                .view = View_Sliding,
                                .destroy = Destroy_Sliding,
                                .statesize = StateSize_Sliding,
                                .save = Save_Sliding,
                                .load = Load_Sliding};
  Sliding *w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  PetscCall(PetscMalloc3(3 * (size_t)n, &w->x, n, &w->volume, n, &w->depth));
  PetscCall(PetscArraycpy(w->x, x, 3 * n));
  PetscCall(PetscArraycpy(w->volume, volume, n));
  PetscCall(PetscArraycpy(w->depth, depth, n));
  PetscCall(PetscArraycpy(w->velocity, velocity, 3));
  w->n = n;
  PetscCall(CoupleSurfaceCreate(PETSC_COMM_SELF, name, &ops, w, surface));
  PetscCall(CoupleSurfaceSetHeld(*surface, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
