/*
  couplelink.c - surfaces whose markers the fluid moves by itself (sphlink.h): states of structures go to the fluid, generalised
  forces come back.
*/
#include "coupleimpl.h"

const char *const CoupleTransferTypes[] = {"auto", "markers", "generalised", "CoupleTransferType", "COUPLE_TRANSFER_", NULL};

/*@
  CoupleSetTransfer - What passes between coupling and fluid, before CoupleSetUp().

  Errors: after CoupleSetUp().
@*/
PetscErrorCode CoupleSetTransfer(Couple c, CoupleTransferType transfer)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "couple_transfer = %s: cannot change after CoupleSetUp()",
             CoupleTransferTypes[transfer]);
  c->transfer = transfer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Link the surfaces that can be, when asked for or worth it; before SphSetUp(). */
PetscErrorCode CoupleLinkSetUp(Couple c)
{
  PetscBool resident;

  PetscFunctionBegin;
  PetscCheck(c->transfer != COUPLE_TRANSFER_GENERALISED || c->maxiterations == 1, c->comm, PETSC_ERR_SUP,
             "couple_transfer = generalised: not with couple_iterations = %" PetscInt_FMT ", which compares marker forces",
             c->maxiterations);
  PetscCheck(c->transfer != COUPLE_TRANSFER_GENERALISED || c->loads == COUPLE_LOADS_CONSTANT, c->comm, PETSC_ERR_SUP,
             "couple_transfer = generalised: not with couple_loads = linear, which follows marker forces");
  PetscCall(SphGetResident(c->sph, &resident));
  if (c->transfer == COUPLE_TRANSFER_MARKERS || c->maxiterations > 1 || c->loads != COUPLE_LOADS_CONSTANT)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (c->transfer == COUPLE_TRANSFER_AUTO && !resident) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    SphLinkSpec spec;
    PetscInt state, load;
    if (!s->surface->ops.getlink) continue;
    PetscCall((*s->surface->ops.getlink)(s->surface, &spec));
    PetscCall(SphSetGroupLink(c->sph, s->group, &spec));
    PetscCall(SphGetGroupLinkSize(c->sph, s->group, &state, &load));
    PetscCall(PetscCalloc2(state, &s->state, load, &s->load));
    s->linked = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleLinkDestroy(CoupleSlot *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(s->state, s->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleLinkForces(Couple c, CoupleSlot *s)
{
  PetscFunctionBegin;
  if (s->linked) PetscCall(SphGetBoundaryForce(c->sph, s->group, s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The markers of surface i between two steps: the structure is where it was when they were moved last. */
PetscErrorCode CoupleLinkFetch(Couple c, PetscInt i)
{
  CoupleSlot *s = &c->slot[i];

  PetscFunctionBegin;
  if (!s->linked) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall((*s->surface->ops.kinematics)(s->surface, 0.0, s->x, s->v, s->a));
  PetscCall(CoupleLinkForces(c, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
