/* rigidsystem.h - rows of all joints together, shared by rigidconstraint.c and rigidposition.c. */
#ifndef RIGIDSYSTEM_H
#define RIGIDSYSTEM_H
#include "rigidimpl.h"
#include <petscsnes.h>

struct _p_RigidSystem {
  PetscInt n;              /* rows */
  PetscInt *joint, *local; /* of each row */
  RigidRow *row0, *row1;   /* at q_n, q_{n+1} */
  PetscReal *W;            /* n x 2 x 6: M^-1 J^T of each end */
  PetscReal *lambda, *res; /* n */
  PetscReal *length;       /* n */
  PetscReal *drive;        /* n: velocity that the bodies that are not free give the row */
  PetscBool *active;       /* n */
  PetscInt *start, *entry; /* rows of body i: entry[start[i] .. start[i + 1]), 2 row + end */
  PetscReal *wrench;       /* bodies x 6 */
  RigidBody *saved;        /* bodies */
  PetscScalar *value;      /* matrix values of one row */
  PetscInt *column;
  Mat A;
  SNES snes; /* of stage 1; its unknowns are the multipliers */
  KSP ksp;   /* of the SNES */
  Vec x, b;
  PetscReal h, worst, last; /* step, s; worst residual over its tolerance, in this iteration and the one before */
  PetscInt where;           /* its row */
};

/* Body of one end of a row. */
static inline PetscInt RigidRowEnd(Rigid rigid, PetscInt row, int end)
{
  const RigidJointSpec *s = &rigid->joint[rigid->system->joint[row]].spec;
  return end ? s->b : s->a;
}

/* rigidconstraint.c */
extern void RigidSystemRows(Rigid rigid, RigidRow *row);
extern PetscErrorCode RigidSystemAssemble(Rigid rigid, const RigidRow *row, PetscReal h);
extern void RigidSystemWrench(Rigid rigid, const RigidRow *row, const PetscReal y[], int kind);
extern void RigidSystemKick(Rigid rigid, PetscReal h);
/* rigidposition.c */
extern PetscErrorCode RigidPositionCreate(Rigid rigid);
extern PetscErrorCode RigidPositionSolve(Rigid rigid, PetscReal h);

#endif
