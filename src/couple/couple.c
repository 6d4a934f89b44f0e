/*
  couple.c - the coupled time loop.

  One step from t to t + dt: rates at t and fluid at the half step; markers of every surface extrapolated to the half step with
  the structure's velocity and acceleration; rates, fluid state at t + dt and marker forces at the half step (a midpoint rule
  for both sides); structures advance to t + dt under these forces with substeps of their own; markers take the new state.
  Action and reaction are equal. This staggered step is between first and second order, since walls feel the structure's
  acceleration of the last step. coupleloads.c makes loads linear over the step, coupleiterate.c iterates on the forces; both
  together are of second order. docs/substeps.md has the measured orders.
*/
#include "coupleimpl.h"

PetscLogEvent COUPLE_Kinematics, COUPLE_Transfer, COUPLE_Advance;

static PetscErrorCode RegisterEvents(void)
{
  static PetscBool done = PETSC_FALSE;
  PetscClassId id;

  PetscFunctionBegin;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  done = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Couple", &id));
  PetscCall(PetscLogEventRegister("CoupleKinematics", id, &COUPLE_Kinematics));
  PetscCall(PetscLogEventRegister("CoupleTransfer", id, &COUPLE_Transfer));
  PetscCall(PetscLogEventRegister("CoupleAdvance", id, &COUPLE_Advance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleCreate(MPI_Comm comm, Couple *couple)
{
  Couple c;

  PetscFunctionBegin;
  PetscCall(RegisterEvents());
  PetscCall(PetscNew(&c));
  c->comm = comm;
  c->dtmax = PETSC_DECIDE;
  c->transfer = COUPLE_TRANSFER_AUTO;
  c->maxiterations = 1;
  c->tolerance = 1e-4;
  c->relaxation = 0.5;
  *couple = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSetSph - The fluid; its markers are added before CoupleSetUp(). The caller keeps ownership.
@*/
PetscErrorCode CoupleSetSph(Couple c, Sph sph)
{
  PetscFunctionBegin;
  c->sph = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSetShort(Couple c, CoupleShort sr)
{
  PetscFunctionBegin;
  c->shortrange = sr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSetAttach(Couple c, CoupleAttach attach)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetAttach() must come before CoupleSetUp()");
  c->attach = attach;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAddSurface(Couple c, CoupleSurface surface)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "surfaces cannot be added after CoupleSetUp()");
  if (c->n == c->cap) {
    CoupleSlot *slot;
    c->cap = 2 * c->cap + 8;
    PetscCall(PetscCalloc1(c->cap, &slot));
    if (c->n) PetscCall(PetscArraycpy(slot, c->slot, c->n));
    PetscCall(PetscFree(c->slot));
    c->slot = slot;
  }
  surface->refct++;
  if (surface->prepare) c->nshared++;
  c->slot[c->n++].surface = surface;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSetMaxTimeStep(Couple c, PetscReal dtmax)
{
  PetscFunctionBegin;
  PetscCheck(dtmax == (PetscReal)PETSC_DECIDE || (dtmax > 0.0 && !PetscIsInfOrNanReal(dtmax)), c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "couple_dt_max = %g: must be > 0 (s), or -1 for none", (double)dtmax);
  c->dtmax = dtmax;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSetFromOptions(Couple c)
{
  PetscReal r = c->dtmax, tolerance = c->tolerance, relaxation = c->relaxation;
  PetscInt n = c->maxiterations;
  PetscEnum transfer = (PetscEnum)c->transfer;
  CoupleLoads loads = c->loads;
  PetscBool set;

  PetscFunctionBegin;
  PetscOptionsBegin(c->comm, NULL, "Coupling options", "Couple");
  PetscCall(
      PetscOptionsReal("-couple_dt_max", "Upper bound on the time step (s); -1 for none", "CoupleSetMaxTimeStep", r, &r, &set));
  if (set) PetscCall(CoupleSetMaxTimeStep(c, r));
  PetscCall(PetscOptionsInt("-couple_iterations", "Most iterations of the strong coupling in a step (1: staggered)",
                            "CoupleSetIterations", n, &n, NULL));
  PetscCall(PetscOptionsReal("-couple_tolerance", "Relative tolerance of the forces in the strong coupling",
                             "CoupleSetIterations", tolerance, &tolerance, NULL));
  PetscCall(PetscOptionsReal("-couple_relaxation", "First relaxation factor of each step; Aitken's rule adapts it",
                             "CoupleSetIterations", relaxation, &relaxation, NULL));
  PetscCall(CoupleSetIterations(c, n, tolerance, relaxation));
  PetscCall(PetscOptionsEnum("-couple_transfer",
                             "What passes between fluid and structures: markers, generalised (states and forces), auto",
                             "CoupleSetTransfer", CoupleTransferTypes, transfer, &transfer, &set));
  if (set) PetscCall(CoupleSetTransfer(c, (CoupleTransferType)transfer));
  PetscCall(PetscOptionsEnum("-couple_loads",
                             "Loads over a step: its middle's, or linear in time with the slope from the last step",
                             "CoupleSetLoads", CoupleLoadsTypes, (PetscEnum)loads, (PetscEnum *)&loads, NULL));
  PetscCall(CoupleSetLoads(c, loads));
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the surface is going to be, for the fluid to be told. */
static PetscErrorCode MoveSlot(Couple c, CoupleSlot *s, PetscReal ahead)
{
  PetscFunctionBegin;
  if (s->linked) {
    PetscCall((*s->surface->ops.linkstate)(s->surface, ahead, s->state));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CoupleMoveSlot(c, s, ahead));
  if (s->w) PetscCall((*s->surface->ops.rotation)(s->surface, s->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TellSlot(Couple c, CoupleSlot *s, PetscReal unused)
{
  PetscFunctionBegin;
  (void)unused;
  if (s->linked) {
    PetscCall(SphSetGroupState(c->sph, s->group, s->state));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SphSetBoundaryMotion(c->sph, s->group, s->x, s->v, s->a));
  if (s->w) PetscCall(SphSetBoundaryRotation(c->sph, s->group, s->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveAndTell(Couple c, CoupleSlot *s, PetscReal ahead)
{
  PetscFunctionBegin;
  PetscCall(MoveSlot(c, s, ahead));
  if (c->tellable && !s->linked) PetscCall(TellSlot(c, s, ahead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleMoveMarkers(Couple c, PetscReal ahead)
{
  const PetscBool share = ahead >= 0.0 ? PETSC_TRUE : PETSC_FALSE; /* back within a step takes c->work */

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(COUPLE_Kinematics, 0, 0, 0, 0));
  PetscCall(CouplePrepare(c));
  if (share) PetscCall(CoupleShare(c, MoveAndTell, ahead));
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    const PetscBool moved = share ? CoupleShares(c, s) : PETSC_FALSE;
    if (!moved) PetscCall(MoveSlot(c, s, ahead));
    if (!moved || !c->tellable || s->linked) PetscCall(TellSlot(c, s, ahead));
  }
  PetscCall(PetscLogEventEnd(COUPLE_Kinematics, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSetUp(Couple c)
{
  PetscInt most = 0;

  PetscFunctionBegin;
  if (c->setup) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(c->sph, c->comm, PETSC_ERR_ORDER, "CoupleSetSph() must come before CoupleSetUp()");
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    const PetscReal *x, *volume, *depth;
    PetscCall((*s->surface->ops.getmarkers)(s->surface, &s->n, &x, &volume, &depth));
    PetscCall(PetscCalloc4(3 * (size_t)s->n, &s->x, 3 * (size_t)s->n, &s->v, 3 * (size_t)s->n, &s->a, 3 * (size_t)s->n, &s->f));
    if (s->surface->ops.rotation) PetscCall(PetscCalloc1(3 * (size_t)s->n, &s->w));
    if (!s->surface->held)
      PetscCall(PetscCalloc4(3 * (size_t)s->n, &s->flast, 3 * (size_t)s->n, &s->vstart, 3 * (size_t)s->n, &s->alast[0],
                             3 * (size_t)s->n, &s->alast[1]));
    most = PetscMax(most, s->n);
    PetscCall((*s->surface->ops.kinematics)(s->surface, 0.0, s->x, s->v, s->a));
    PetscCall(SphAddBoundary(c->sph, s->n, s->x, s->v, volume, depth, &s->group));
  }
  PetscCall(CoupleLinkSetUp(c));
  PetscCall(SphGetResident(c->sph, &c->tellable));
  c->tellable = (PetscBool)!c->tellable;
  PetscCall(PetscMalloc1(3 * (size_t)most, &c->work));
  PetscCall(SphSetUp(c->sph));
  PetscCall(CoupleMoveMarkers(c, 0.0));
  PetscCall(PetscCalloc1(4 * (size_t)PetscMax(1, c->n), &c->ledger));
  c->setup = PETSC_TRUE;
  PetscCall(CoupleBalanceStart(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleView(Couple c, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "Coupling: %" PetscInt_FMT
                                   " surfaces, couple_transfer %s, couple_dt_max %g s, couple_iterations %" PetscInt_FMT
                                   ", couple_tolerance %g, couple_relaxation %g, couple_loads %s\n",
                                   c->n, CoupleTransferTypes[c->transfer], (double)c->dtmax, c->maxiterations,
                                   (double)c->tolerance, (double)c->relaxation, CoupleLoadsTypes[c->loads]));
  if (c->shortrange) PetscCall(CoupleShortView(c->shortrange, viewer));
  if (c->attach) PetscCall(CoupleAttachView(c->attach, viewer));
  for (PetscInt i = 0; i < c->n; i++)
    if (c->slot[i].surface->ops.view) PetscCall((*c->slot[i].surface->ops.view)(c->slot[i].surface, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleDestroy(Couple *couple)
{
  PetscFunctionBegin;
  if (!*couple) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < (*couple)->n; i++) {
    CoupleSlot *s = &(*couple)->slot[i];
    PetscCall(CoupleLinkDestroy(s));
    if (s->x) PetscCall(PetscFree4(s->x, s->v, s->a, s->f));
    PetscCall(PetscFree(s->w));
    if (s->flast) PetscCall(PetscFree4(s->flast, s->vstart, s->alast[0], s->alast[1]));
    PetscCall(CoupleSurfaceDestroy(&s->surface));
  }
  PetscCall(CoupleIterationDestroy(*couple));
  PetscCall(PetscFree((*couple)->work));
  PetscCall(PetscFree((*couple)->ledger));
  PetscCall(PetscFree((*couple)->slot));
  PetscCall(PetscFree(*couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MarkerTotals(const CoupleSlot *s, CoupleAudit *audit)
{
  for (PetscInt i = 0; i < s->n; i++) {
    PetscReal m[3];
    CoupleCross(s->x + 3 * i, s->f + 3 * i, m);
    for (int k = 0; k < 3; k++) {
      audit->force[k] += s->f[3 * i + k];
      audit->moment[k] += m[k];
    }
    audit->power += CoupleDot(s->f + 3 * i, s->v + 3 * i);
  }
}

static PetscErrorCode TransferSlot(Couple c, CoupleSlot *s, PetscReal h)
{
  CoupleAudit audit = {0};

  PetscFunctionBegin;
  (void)c;
  (void)h;
  if (s->linked) {
    for (int k = 0; k < 3; k++) {
      audit.force[k] = s->totals.force[k];
      audit.moment[k] = s->totals.moment[k];
    }
    audit.power = s->totals.power;
    PetscCall((*s->surface->ops.applyloads)(s->surface, s->load, &s->totals, &audit));
  } else {
    MarkerTotals(s, &audit);
    PetscCall((*s->surface->ops.applyforces)(s->surface, s->f, &audit));
  }
  s->audit = audit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marker forces in s->f and short-range forces to every structure for a step h (s); s->x, s->v still hold the marker state that
   the marker forces act on. */
static PetscErrorCode Transfer(Couple c, PetscReal h)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(COUPLE_Transfer, 0, 0, 0, 0));
  for (PetscInt i = 0; i < c->n; i++) PetscCall((*c->slot[i].surface->ops.zeroloads)(c->slot[i].surface));
  PetscCall(CoupleShare(c, TransferSlot, h));
  for (PetscInt i = 0; i < c->n; i++)
    if (!CoupleShares(c, &c->slot[i])) PetscCall(TransferSlot(c, &c->slot[i], h));
  if (c->shortrange) PetscCall(CoupleShortApply(c->shortrange, h));
  PetscCall(CoupleLoadsChange(c));
  PetscCall(PetscLogEventEnd(COUPLE_Transfer, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fluid's forces on a surface that takes them marker by marker and lets threads ask. */
static PetscErrorCode ForceSlot(Couple c, CoupleSlot *s, PetscReal unused)
{
  PetscFunctionBegin;
  (void)unused;
  if (!s->linked) PetscCall(SphGetBoundaryForce(c->sph, s->group, s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of the fluid, but f for the surfaces that are not held when it is given. */
PetscErrorCode CoupleApplyForces(Couple c, PetscReal h, const PetscReal *f)
{
  PetscFunctionBegin;
  if (!f && c->tellable) PetscCall(CoupleShare(c, ForceSlot, 0.0));
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    if (!f && c->tellable && !s->linked && CoupleShares(c, s)) continue;
    if (s->linked)
      PetscCall(SphGetGroupLoad(c->sph, s->group, s->load, &s->totals));
    else if (f && !s->surface->held) {
      PetscCall(PetscArraycpy(s->f, f, 3 * s->n));
      f += 3 * s->n;
    } else
      PetscCall(SphGetBoundaryForce(c->sph, s->group, s->f));
  }
  PetscCall(Transfer(c, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SettleSlot(Couple c, CoupleSlot *s, PetscReal t)
{
  PetscFunctionBegin;
  (void)c;
  (void)t;
  if (s->surface->unsettled) PetscCall((*s->surface->settle)(s->surface));
  s->surface->unsettled = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAdvanceSurfaces(Couple c, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(COUPLE_Advance, 0, 0, 0, 0));
  if (c->attach) PetscCall(CoupleAttachAdvance(c->attach, t)); /* the surfaces then find their solvers at t */
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSurface surface = c->slot[i].surface;
    surface->unsettled = (PetscBool)(surface->settle && CoupleShares(c, &c->slot[i]));
    PetscCall((*surface->ops.advance)(surface, t));
  }
  PetscCall(CoupleShare(c, SettleSlot, t));
  if (c->shortrange) PetscCall(CoupleShortRemove(c->shortrange));
  PetscCall(PetscLogEventEnd(COUPLE_Advance, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stable step, shortened to end at tmax without leaving a sliver. */
static PetscErrorCode ChooseStep(Couple c, PetscReal tmax, PetscReal *dt)
{
  PetscReal t, left;

  PetscFunctionBegin;
  PetscCall(SphGetTime(c->sph, &t, NULL));
  PetscCall(SphComputeTimeStep(c->sph, dt));
  if (c->dtmax > 0.0) *dt = PetscMin(*dt, c->dtmax);
  left = tmax - t;
  PetscCheck(left > 0.0, c->comm, PETSC_ERR_ARG_OUTOFRANGE, "the end time %g s must lie after the current time %g s",
             (double)tmax, (double)t);
  if (left <= *dt * (1.0 + 1e-9))
    *dt = left;
  else if (left < 2.0 * *dt)
    *dt = 0.5 * left;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleStep - One step of fluid and structures, not past tmax (s); returns the step taken.

  Errors: PETSC_ERR_FP on a non-finite value, PETSC_ERR_NOT_CONVERGED when a structure's solver fails.
@*/
PetscErrorCode CoupleStep(Couple c, PetscReal tmax, PetscReal *taken)
{
  PetscReal t, dt;

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleStep()");
  PetscCall(SphGetTime(c->sph, &t, NULL));
  PetscCall(ChooseStep(c, tmax, &dt));
  PetscCall(CoupleLoadsBegin(c, dt));
  PetscCall(SphStepBegin(c->sph, dt));
  if (c->maxiterations > 1) {
    PetscCall(CoupleIterate(c, t, dt));
    PetscCall(SphStepEnd(c->sph));
  } else {
    PetscCall(CoupleMoveMarkers(c, 0.5 * dt));
    PetscCall(SphStepEnd(c->sph));
    PetscCall(CoupleApplyForces(c, dt, NULL));
    PetscCall(CoupleAdvanceSurfaces(c, t + dt));
  }
  PetscCall(CoupleMoveMarkers(c, 0.0));
  PetscCall(CoupleLoadsEnd(c));
  PetscCall(CoupleBalanceAdd(c, dt));
  if (taken) *taken = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetTime(Couple c, PetscReal *t, PetscInt *step)
{
  PetscFunctionBegin;
  PetscCall(SphGetTime(c->sph, t, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetNumSurfaces(Couple c, PetscInt *n)
{
  PetscFunctionBegin;
  *n = c->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetSurface(Couple c, PetscInt i, CoupleSurface *surface, PetscInt *group)
{
  PetscFunctionBegin;
  PetscCheck(i >= 0 && i < c->n, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "surface %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", i, c->n);
  if (surface) *surface = c->slot[i].surface;
  if (group) *group = c->slot[i].group;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetAudit(Couple c, PetscInt i, CoupleAudit *audit)
{
  PetscFunctionBegin;
  PetscCheck(i >= 0 && i < c->n, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "surface %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", i, c->n);
  *audit = c->slot[i].audit;
  PetscFunctionReturn(PETSC_SUCCESS);
}
