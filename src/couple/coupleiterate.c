/*
  coupleiterate.c - strong coupling: the forces at the half step iterated until fluid and structures agree on them.

  The plain step moves the markers at t + dt/2 by the structure's last acceleration. A wall's pressure carries that acceleration
  into the force (Adami et al., Eq. 27), like an added mass taken from the last step: with added mass above the structure's own
  the plain step grows without bound. Here, within one step,

    F_k -> structures to t + dt -> markers back at t + dt/2 -> fluid forces G(F_k),   F_k+1 = F_k + w_k (G(F_k) - F_k),

  with Aitken's dynamic relaxation (Irons, Tuck, Int. J. Numer. Meth. Eng. 1 (1969); Kuettler, Wall, Comput. Mech. 43 (2008)),
  w_k+1 = -w_k r_k . (r_k+1 - r_k)/|r_k+1 - r_k|^2, r = G(F) - F. At the end the structures take G(F) itself: action and reaction
  stay equal.
*/
#include "coupleimpl.h"

/* All surfaces' states, forces applied and residuals, for one step. */
struct _p_CoupleIteration {
  PetscInt nstate, nforce;
  PetscReal *state;        /* of the structures at the beginning of the step */
  PetscReal *F, *r, *rold; /* 3 per marker of every surface that is not held */
};

static PetscErrorCode SetUp(Couple c)
{
  CoupleIteration it;

  PetscFunctionBegin;
  PetscCall(PetscNew(&it));
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSurface s = c->slot[i].surface;
    PetscInt n = 0;
    PetscCheck(s->held || s->ops.statesize, c->comm, PETSC_ERR_SUP, "couple_iterations > 1: surface %s cannot save its state",
               s->name);
    if (s->ops.statesize) PetscCall((*s->ops.statesize)(s, &n));
    it->nstate += n;
    if (!s->held) it->nforce += 3 * c->slot[i].n;
  }
  if (c->attach) {
    PetscInt n;

    CoupleAttachCount(c->attach, &n);
    it->nstate += n;
  }
  PetscCall(PetscMalloc4(it->nstate, &it->state, it->nforce, &it->F, it->nforce, &it->r, it->nforce, &it->rold));
  c->iteration = it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleIterationDestroy(Couple c)
{
  PetscFunctionBegin;
  if (!c->iteration) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(c->iteration->state, c->iteration->F, c->iteration->r, c->iteration->rold));
  PetscCall(PetscFree(c->iteration));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode States(Couple c, PetscBool load)
{
  PetscReal *p = c->iteration->state;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSurface s = c->slot[i].surface;
    PetscInt n;
    if (!s->ops.statesize) continue; /* held: it follows the time and answers to no force */
    PetscCall((*s->ops.statesize)(s, &n));
    if (load)
      PetscCall((*s->ops.load)(s, p));
    else
      PetscCall((*s->ops.save)(s, p));
    p += n;
  }
  if (c->attach) CoupleAttachCopy(c->attach, load, p);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid forces of the surfaces that can move, one after the other. */
static PetscErrorCode FluidForces(Couple c, PetscReal *f)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++) {
    if (c->slot[i].surface->held) continue;
    PetscCall(SphGetBoundaryForce(c->sph, c->slot[i].group, f));
    f += 3 * c->slot[i].n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Structures from the saved state to t under the forces F, markers to the middle of the step, fluid forces there: r = G(F) - F.
 */
static PetscErrorCode Map(Couple c, PetscReal t, PetscReal dt, const PetscReal *F, PetscReal *r)
{
  CoupleIteration it = c->iteration;

  PetscFunctionBegin;
  PetscCall(CoupleApplyForces(c, dt, F));
  PetscCall(CoupleAdvanceSurfaces(c, t + dt));
  PetscCall(CoupleMoveMarkers(c, -0.5 * dt));
  PetscCall(SphStepEvaluate(c->sph));
  PetscCall(FluidForces(c, r));
  for (PetscInt i = 0; i < it->nforce; i++) r[i] -= F[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Norm(const PetscReal *x, PetscInt n)
{
  PetscReal s = 0.0;
  for (PetscInt i = 0; i < n; i++) s += x[i] * x[i];
  return PetscSqrtReal(s);
}

static PetscReal Aitken(const CoupleIteration it, PetscReal w)
{
  PetscReal a = 0.0, b = 0.0;
  for (PetscInt i = 0; i < it->nforce; i++) {
    const PetscReal d = it->r[i] - it->rold[i];
    a += it->rold[i] * d;
    b += d * d;
  }
  return b > 0.0 ? -w * a / b : w;
}

static PetscErrorCode Report(Couple c, PetscReal t, PetscReal residual)
{
  PetscFunctionBegin;
  if (residual > c->tolerance) {
    if (!c->unconverged++)
      PetscCall(
          PetscFPrintf(c->comm, PETSC_STDERR,
                       "frond: warning: the coupling at t = %g s left a relative force residual of %.1e after %" PetscInt_FMT
                       " iterations (couple_tolerance = %g); said once\n",
                       (double)t, (double)residual, c->maxiterations, (double)c->tolerance));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The middle of a step whose first stage is done: on return the structures are at t + dt under the very forces that the fluid's
  second stage felt.
*/
PetscErrorCode CoupleIterate(Couple c, PetscReal t, PetscReal dt)
{
  PetscReal w = c->relaxation, residual = 0.0, *swap;
  CoupleIteration it;

  PetscFunctionBegin;
  if (!c->iteration) PetscCall(SetUp(c));
  it = c->iteration;
  PetscCall(States(c, PETSC_FALSE));
  PetscCall(CoupleMoveMarkers(c, 0.5 * dt));
  PetscCall(SphStepEvaluate(c->sph));
  PetscCall(FluidForces(c, it->F));
  for (PetscInt k = 1; k <= c->maxiterations; k++) {
    if (k > 1) PetscCall(States(c, PETSC_TRUE));
    PetscCall(Map(c, t, dt, it->F, it->r));
    c->iterations++;
    residual = Norm(it->r, it->nforce) / PetscMax(Norm(it->F, it->nforce), PETSC_MIN_REAL);
    if (residual <= c->tolerance) break;
    if (k > 1) w = PetscMax(PetscMin(Aitken(it, w), 1.0), 0.01);
    for (PetscInt i = 0; i < it->nforce; i++) it->F[i] += w * it->r[i];
    swap = it->r;
    it->r = it->rold;
    it->rold = swap;
  }
  PetscCall(Report(c, t, residual));
  PetscCall(FluidForces(c, it->F)); /* the last G(F), which the fluid's second stage uses */
  PetscCall(States(c, PETSC_TRUE));
  PetscCall(CoupleApplyForces(c, dt, it->F));
  PetscCall(CoupleAdvanceSurfaces(c, t + dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSetIterations - Strong coupling with at most n iterations per step (1: the plain, staggered step).

  tolerance: of the forces, relative (-); relaxation: the first factor of each step, in (0, 1]. Errors: values out of range;
  at the first step, a surface that cannot save its state.
@*/
PetscErrorCode CoupleSetIterations(Couple c, PetscInt n, PetscReal tolerance, PetscReal relaxation)
{
  PetscFunctionBegin;
  PetscCheck(n >= 1, c->comm, PETSC_ERR_ARG_OUTOFRANGE, "couple_iterations = %" PetscInt_FMT ": must be >= 1", n);
  for (PetscInt i = 0; n > 1 && c->setup && i < c->n; i++)
    PetscCheck(!c->slot[i].linked, c->comm, PETSC_ERR_ORDER,
               "couple_iterations = %" PetscInt_FMT ": must be set before CoupleSetUp(), which chose couple_transfer generalised",
               n);
  PetscCheck(tolerance > 0.0 && tolerance < 1.0, c->comm, PETSC_ERR_ARG_OUTOFRANGE, "couple_tolerance = %g: must be in (0, 1)",
             (double)tolerance);
  PetscCheck(relaxation > 0.0 && relaxation <= 1.0, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "couple_relaxation = %g: must be in (0, 1]", (double)relaxation);
  c->maxiterations = n;
  c->tolerance = tolerance;
  c->relaxation = relaxation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetIterations(Couple c, PetscInt *iterations, PetscInt *unconverged)
{
  PetscFunctionBegin;
  if (iterations) *iterations = c->iterations;
  if (unconverged) *unconverged = c->unconverged;
  PetscFunctionReturn(PETSC_SUCCESS);
}
