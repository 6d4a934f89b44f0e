/* couplesurface.c - the surface object itself, and the adapter for walls with prescribed motion. */
#include "coupleimpl.h"
#include "sectionmath.h"

/*@
  CoupleSurfaceCreate - Wrap a structure for the coupling. All of ops but momentum, view and destroy must be set; ctx is the
caller's.
@*/
PetscErrorCode CoupleSurfaceCreate(MPI_Comm comm, const char name[], const CoupleSurfaceOps *ops, void *ctx,
                                   CoupleSurface *surface)
{
  CoupleSurface s;

  PetscFunctionBegin;
  PetscCheck(!ops->statesize == !ops->save && !ops->save == !ops->load, comm, PETSC_ERR_ARG_NULL,
             "surface %s: statesize, save and load must be given together or not at all", name);
  PetscCheck(!ops->getlink == !ops->linkstate && !ops->linkstate == !ops->applyloads, comm, PETSC_ERR_ARG_NULL,
             "surface %s: getlink, linkstate and applyloads must be given together or not at all", name);
  PetscCheck(ops->getmarkers && ops->kinematics && ops->zeroloads && ops->applyforces && ops->advance, comm, PETSC_ERR_ARG_NULL,
             "surface %s: getmarkers, kinematics, zeroloads, applyforces and advance must all be given", name);
  PetscCall(PetscNew(&s));
  s->comm = comm;
  PetscCall(PetscStrncpy(s->name, name, sizeof(s->name)));
  s->ops = *ops;
  s->ctx = ctx;
  s->refct = 1;
  *surface = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceGetContext(CoupleSurface surface, void *ctx)
{
  PetscFunctionBegin;
  *(void **)ctx = surface->ctx;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceGetName(CoupleSurface surface, const char **name)
{
  PetscFunctionBegin;
  *name = surface->name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceGetOps(CoupleSurface surface, CoupleSurfaceOps *ops)
{
  PetscFunctionBegin;
  *ops = surface->ops;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceSetHeld(CoupleSurface surface, PetscBool held)
{
  PetscFunctionBegin;
  surface->held = held;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceDestroy(CoupleSurface *surface)
{
  PetscFunctionBegin;
  if (!*surface) PetscFunctionReturn(PETSC_SUCCESS);
  if (--(*surface)->refct > 0) {
    *surface = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if ((*surface)->ops.destroy) PetscCall((*(*surface)->ops.destroy)(*surface));
  PetscCall(PetscFree(*surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscInt n;
  PetscReal *x, *volume, *depth;
  PetscReal velocity[3], t;
  PetscBool sliding; /* the markers stay: t is of no account */
} Wall;

/* How far (m) the markers are from where they began, dt after the wall's time. */
static PetscReal WallPath(const Wall *w, PetscReal dt, int k)
{
  return w->sliding ? 0.0 : (w->t + dt) * w->velocity[k];
}

static PetscErrorCode GetMarkers_Wall(CoupleSurface s, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                                      const PetscReal **depth)
{
  const Wall *w = (const Wall *)s->ctx;

  PetscFunctionBegin;
  *n = w->n;
  *x = w->x;
  *volume = w->volume;
  *depth = w->depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Kinematics_Wall(CoupleSurface s, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a)
{
  const Wall *w = (const Wall *)s->ctx;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < w->n; i++)
    for (int k = 0; k < 3; k++) {
      x[3 * i + k] = w->x[3 * i + k] + WallPath(w, dt, k);
      v[3 * i + k] = w->velocity[k];
      a[3 * i + k] = 0.0;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As a body that has been carried from rest, without turning. */
static PetscErrorCode GetLink_Wall(CoupleSurface s, SphLinkSpec *spec)
{
  PetscFunctionBegin;
  *spec = (SphLinkSpec){.nsections = 1, .offset = ((const Wall *)s->ctx)->x};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinkState_Wall(CoupleSurface s, PetscReal dt, PetscReal *state)
{
  const Wall *w = (const Wall *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(state, SECTION_BODY_STATE));
  for (int k = 0; k < 3; k++) {
    state[k] = WallPath(w, dt, k);
    state[3 + k] = w->velocity[k];
    state[15 + 4 * k] = 1.0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyLoads_Wall(CoupleSurface s, const PetscReal *load, const SphLinkTotals *totals, CoupleAudit *audit)
{
  (void)s;
  (void)load;
  (void)totals;
  (void)audit;
  return PETSC_SUCCESS;
}

static PetscErrorCode ZeroLoads_Wall(CoupleSurface s)
{
  (void)s;
  return PETSC_SUCCESS;
}

static PetscErrorCode ApplyForces_Wall(CoupleSurface s, const PetscReal *f, CoupleAudit *audit)
{
  (void)s; /* a wall takes any force up: nothing is lost */
  (void)f;
  (void)audit;
  return PETSC_SUCCESS;
}

static PetscErrorCode Advance_Wall(CoupleSurface s, PetscReal t)
{
  ((Wall *)s->ctx)->t = t;
  return PETSC_SUCCESS;
}

static PetscErrorCode StateSize_Wall(CoupleSurface s, PetscInt *n)
{
  *n = ((Wall *)s->ctx)->sliding ? 0 : 1;
  return PETSC_SUCCESS;
}

static PetscErrorCode Save_Wall(CoupleSurface s, PetscReal *state)
{
  const Wall *w = (const Wall *)s->ctx;

  if (!w->sliding) *state = w->t;
  return PETSC_SUCCESS;
}

static PetscErrorCode Load_Wall(CoupleSurface s, const PetscReal *state)
{
  Wall *w = (Wall *)s->ctx;

  if (!w->sliding) w->t = *state;
  return PETSC_SUCCESS;
}

static PetscErrorCode View_Wall(CoupleSurface s, PetscViewer viewer)
{
  const Wall *w = (const Wall *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  wall %s: %" PetscInt_FMT " markers, %s (%g, %g, %g) m/s\n", s->name, w->n,
                                   w->sliding ? "sliding with" : "velocity", (double)w->velocity[0], (double)w->velocity[1],
                                   (double)w->velocity[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Wall(CoupleSurface s)
{
  Wall *w = (Wall *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscFree3(w->x, w->volume, w->depth));
  PetscCall(PetscFree(s->ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceCreateWall(MPI_Comm comm, const char name[], PetscInt n, const PetscReal *x, const PetscReal *volume,
                                       const PetscReal *depth, const PetscReal velocity[3], CoupleSurface *surface)
{
  const CoupleSurfaceOps ops = {.getmarkers = GetMarkers_Wall,
                                .kinematics = Kinematics_Wall,
                                .zeroloads = ZeroLoads_Wall,
                                .applyforces = ApplyForces_Wall,
                                .advance = Advance_Wall,
                                .getlink = GetLink_Wall,
                                .linkstate = LinkState_Wall,
                                .applyloads = ApplyLoads_Wall,
                                .view = View_Wall,
                                .destroy = Destroy_Wall,
                                .statesize = StateSize_Wall,
                                .save = Save_Wall,
                                .load = Load_Wall};
  Wall *w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  PetscCall(PetscMalloc3(3 * (size_t)n, &w->x, n, &w->volume, n, &w->depth));
  PetscCall(PetscArraycpy(w->x, x, 3 * n));
  PetscCall(PetscArraycpy(w->volume, volume, n));
  PetscCall(PetscArraycpy(w->depth, depth, n));
  for (int k = 0; k < 3; k++) w->velocity[k] = velocity[k];
  w->n = n;
  PetscCall(CoupleSurfaceCreate(comm, name, &ops, w, surface));
  PetscCall(CoupleSurfaceSetHeld(*surface, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceSetSliding(CoupleSurface surface, PetscBool sliding)
{
  PetscFunctionBegin;
  PetscCheck(surface->ops.advance == Advance_Wall, surface->comm, PETSC_ERR_ARG_WRONG,
             "CoupleSurfaceSetSliding(): surface %s is not of CoupleSurfaceCreateWall()", surface->name);
  ((Wall *)surface->ctx)->sliding = sliding;
  PetscFunctionReturn(PETSC_SUCCESS);
}
