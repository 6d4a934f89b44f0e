/* coupleattach.h - private: attachments of beams to bodies, see coupleattachstep.c. */
#ifndef COUPLEATTACH_H
#define COUPLEATTACH_H

#include "coupleimpl.h"

typedef struct {
  PetscInt beam, node, body, at, set, unknown; /* at: among all nodes; set: of joined beams; unknown: free body, or -1 */
  PetscBool clamp;
  PetscReal place[3], gradient[3]; /* body frame, m and - */
  PetscReal x0[3], x1[3];          /* of the node at the ends of the step, m */
  PetscReal F[3], M[3];            /* on the beam, mean of the last step, N and N m */
  PetscReal w0[3];                 /* of its body at the start of the step, rad/s */
  PetscReal raw[6], last[6];       /* the same at the integrator's time in this step and the one before */
} Attachment;

/* Beams that hang together. */
typedef struct {
  PetscInt n, clamps;    /* attachments, and those of them that clamp */
  PetscBool closed;      /* no other support than free bodies */
  PetscReal balance[12]; /* p, L, F, T at the start of the step */
} BeamSet;

struct _p_CoupleAttach {
  MPI_Comm comm;
  Ancf ancf;
  Rigid rigid;
  PetscInt n, cap, nsets, nfree, maxiterations, iterations;
  Attachment *a;
  PetscInt nbeams, *setof; /* of each beam, -1: no attachment */
  BeamSet *sets;
  PetscInt *free;                       /* free bodies with attachments */
  PetscReal tolerance, *length, *ratio; /* of a free body: radius of gyration, m; mass of its beams over its own */
  PetscReal *X;                         /* their centres at the start of the step, m */
  CoupleExchange done;                  /* of all steps */
  PetscReal *W, *B;                     /* 6 nfree wrenches (torque over length), inverse Jacobian of R */
  PetscReal *R, *Rold, *G, *s, *y;      /* 6 nfree each */
  PetscReal *beams, *bodies, *f0, *f1, *f2, *balance;
  PetscReal sum[2][3];    /* of the beams' reactions at the ends of the last step, N */
  PetscBool setup, known; /* known: reactions of a last step */
};

/* coupleattachstep.c: B at first; place, velocity and gradient of an attachment's point on its body now (e and v, 6 each). */
/* Sums of the reactions f1 take their place at the end of a step. */
extern void CoupleAttachSum(CoupleAttach attach);
extern void CoupleAttachFirstInverse(CoupleAttach attach);
extern PetscErrorCode CoupleAttachFollow(CoupleAttach attach, const Attachment *a, PetscReal e[6], PetscReal v[6]);

/* y = R x, or R^T x */
static inline void Turn(const PetscReal R[9], PetscBool back, const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++)
    y[i] = back ? R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2] : R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

#endif
