/* coupleimpl.h - private: surfaces, the coupled system, small vector helpers. */
#ifndef COUPLEIMPL_H
#define COUPLEIMPL_H

#include "couple.h"

struct _p_CoupleSurface {
  MPI_Comm comm;
  char name[64];
  CoupleSurfaceOps ops;
  void *ctx;
  PetscBool held;
  PetscInt refct;
  /* Surfaces whose kinematics, rotation, linkstate, applyforces and applyloads may be called for several of them by different
     threads, once prepare was called for each (it makes current what they share); the others have no prepare. */
  PetscErrorCode (*prepare)(CoupleSurface);
  PetscErrorCode (*settle)(CoupleSurface); /* what is left of advance when `unsettled` is set; also by different threads */
  PetscBool unsettled;
};

typedef struct {
  CoupleSurface surface;
  PetscInt group, n;
  PetscReal *x, *v, *a, *f;             /* n x 3 */
  PetscReal *flast, *vstart, *alast[2]; /* not held: force of the last step, velocity at the start of this one, mean
                                         * accelerations over the last two */
  PetscReal *w;                         /* n x 3, angular velocity, rad/s; NULL for surfaces that do not turn */
  CoupleAudit audit;
  PetscBool linked;        /* moved by its state (sphlink.h); x, v, f are then filled when somebody asks */
  PetscReal *state, *load; /* of the link */
  SphLinkTotals totals;
} CoupleSlot;

typedef struct _p_CoupleIteration *CoupleIteration;

struct _p_Couple {
  MPI_Comm comm;
  Sph sph;
  CoupleAttach attach; /* NULL without */
  CoupleSlot *slot;
  PetscInt n, cap, nshared; /* surfaces; room; of them with prepare */
  PetscReal dtmax;
  CoupleTransferType transfer;
  PetscBool setup, tellable; /* tellable: the fluid takes motions from several threads */
  PetscInt maxiterations, iterations,
      unconverged; /* of the strong coupling: allowed per step; made; steps that missed the tolerance */
  PetscReal tolerance, relaxation;
  CoupleShort shortrange;    /* NULL: none */
  CoupleIteration iteration; /* made at the first iterated step */
  CoupleLoads loads;
  PetscReal dt, dtlast[2]; /* the step being made, the two before it, s; 0: none */
  PetscReal *work;         /* 3 per marker of the largest surface */
  PetscReal p0[3];         /* momentum at set-up */
  PetscReal mass;          /* of the fluid, kg; for `left` markers gone */
  PetscReal net;           /* that openings had let in by then, kg */
  PetscInt left;
  CoupleBalance balance; /* impulses accumulated so far */
  PetscReal *ledger;     /* n x 4: work (J) and angular impulse (N m s) of the fluid on each surface */
};

extern PetscLogEvent COUPLE_Kinematics, COUPLE_Transfer, COUPLE_Advance;

/* couple.c: every surface's markers at the structures' own time plus ahead (s), to the fluid. */
extern PetscErrorCode CoupleMoveMarkers(Couple couple, PetscReal ahead);

/* couple.c: forces (3 per marker of the surfaces that are not held) onto the structures for a step h (s); every
   structure to time t. */
extern PetscErrorCode CoupleApplyForces(Couple couple, PetscReal h, const PetscReal *f);
extern PetscErrorCode CoupleAdvanceSurfaces(Couple couple, PetscReal t);

/* couplehost.c: the host is one of ours, and can serve several threads. */
extern PetscErrorCode CoupleHostShare(CoupleSurface surface);
/*
  couplethreads.c: share the surfaces that can be among threads, in a function for one of them; the others wait for the caller.
  The decision does not depend on the number of threads.
*/
typedef PetscErrorCode (*CoupleSlotWork)(Couple couple, CoupleSlot *slot, PetscReal number);
extern PetscBool CoupleShares(Couple couple, const CoupleSlot *slot);
extern PetscErrorCode CoupleShare(Couple couple, CoupleSlotWork work, PetscReal number);
extern PetscErrorCode CouplePrepare(Couple couple);

/* couplelink.c */
extern PetscErrorCode CoupleLinkSetUp(Couple couple);
extern PetscErrorCode CoupleLinkDestroy(CoupleSlot *slot);
extern PetscErrorCode CoupleLinkFetch(Couple couple, PetscInt i);
extern PetscErrorCode CoupleLinkForces(Couple couple, CoupleSlot *slot);
/* coupleloads.c: before and after a step; the loads just applied made linear; a slot's markers at the structure's time plus
 * ahead, s. */
extern PetscErrorCode CoupleLoadsBegin(Couple couple, PetscReal dt);
extern PetscErrorCode CoupleLoadsEnd(Couple couple);
extern PetscErrorCode CoupleLoadsChange(Couple couple);
extern PetscErrorCode CoupleMoveSlot(Couple couple, CoupleSlot *slot, PetscReal ahead);
extern PetscErrorCode CoupleLoadsMoveState(Couple couple, FrondState *state);

/* coupleiterate.c */
extern PetscErrorCode CoupleIterate(Couple couple, PetscReal t, PetscReal dt);
extern PetscErrorCode CoupleIterationDestroy(Couple couple);

/* coupleattach.c: reals that attachments carry from step to step, to or from an array of so many. */
extern void CoupleAttachCount(CoupleAttach attach, PetscInt *n);
/* Last step: force of the beams on all free bodies; of other bodies on the beams; mean of the beams' reactions at its ends, N. */
extern void CoupleAttachTotal(CoupleAttach attach, PetscReal bodies[3], PetscReal held[3], PetscReal ends[3]);
extern void CoupleAttachCopy(CoupleAttach attach, PetscBool load, PetscReal *state);

/* couplebalance.c */
extern PetscErrorCode CoupleBalanceStart(Couple couple);
extern PetscErrorCode CoupleBalanceAdd(Couple couple, PetscReal dt);
extern PetscErrorCode CoupleOpenings(Couple couple, PetscReal *mass, PetscReal momentum[3]);

static inline void CoupleCross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline PetscReal CoupleDot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#endif
