/*
  sphlink.h - boundary groups that follow generalised coordinates: a rigid body's pose, or nodes with shape functions.

  A group is linked once; from then on it is moved by the state of its structure and asked for generalised forces. The cuda
  backend moves the markers and sums their forces on the device, in a fixed order: only states and generalised forces cross the
  bus. Other backends do the same on the host. Equations: sectionmath.h; Source: Pazouki, Serban, Negrut, Eqs. 12, 14, 23 and
  Sect. 2.4.
*/
#ifndef SPHLINK_H
#define SPHLINK_H

#include "sph.h"

/*
  How the markers of a group hang on coordinates. nnodes = 0: on a rigid body, with nsections = 1; rowstart, node, shape, slope
  and section are not read. Else every marker belongs to a section at r = sum_j S_j q_j of the nodes q_j; with slopes the section
  has a tangent r_s = sum_j S'_j q_j and markers off the point.
*/
typedef struct {
  PetscInt nnodes;          /* nodes of 3 numbers, or 0 for a rigid body */
  PetscInt nsections;       /* sections */
  const PetscInt *rowstart; /* nsections + 1: entries of section i are rowstart[i] ... rowstart[i+1]-1 */
  const PetscInt *node;     /* rowstart[nsections]: node of each entry, in [0, nnodes) */
  const PetscReal *shape;   /* as many: S */
  const PetscReal *slope;   /* as many: S', 1/m, or NULL for sections without slopes */
  const PetscInt *section;  /* markers of the group: the section of each, ascending */
  const PetscReal *offset;  /* markers x 3, m: body frame; sections with slopes: along d1, t x d1 and t; else 0 */
} SphLinkSpec;

/* What the markers of a linked group feel together. */
typedef struct {
  PetscReal force[3], moment[3]; /* N, N m about the origin */
  PetscReal power;               /* W */
  PetscReal twist, axial[3];     /* torque about the tangents, that no node takes up: sum, and as a vector; N m */
} SphLinkTotals;

/*
  Link a group, after SphAddBoundary() and before SphSetUp(); SphSetBoundaryMotion() then refuses it. group: as SphAddBoundary()
  gave it. spec: copied. Errors: numbers out of range.
*/
FROND_EXTERN PetscErrorCode SphSetGroupLink(Sph sph, PetscInt group, const SphLinkSpec *spec);
/*
  Each output may be NULL. group: a linked group. state: reals of a state: body 24, else 9 nnodes, and 3 nsections with slopes.
  load: reals of its generalised forces: body 6, else 3 nnodes.
*/
FROND_EXTERN PetscErrorCode SphGetGroupLinkSize(Sph sph, PetscInt group, PetscInt *state, PetscInt *load);
/*
  Move the markers of a linked group. group: a linked group. state: body: centre, velocity, acceleration, angular velocity and
  acceleration (3 each, SI) and the rotation matrix by rows (9); nodes: q, q', q'' (nnodes x 3 each) and with slopes for each
  section a unit normal of a moment before (3), which is carried along to the new tangent.
*/
FROND_EXTERN PetscErrorCode SphSetGroupState(Sph sph, PetscInt group, const PetscReal *state);
/*
  Generalised forces of the fluid on a linked group in the state that was set last. group: a linked group. load: body: force and
  moment about its centre (N, N m); nodes: Q (nnodes x 3, N). totals: sums over the markers, or NULL.
*/
FROND_EXTERN PetscErrorCode SphGetGroupLoad(Sph sph, PetscInt group, PetscReal *load, SphLinkTotals *totals);
/*
  yes: whether markers live in another memory than the host's, so that linked groups save transfers. Goes by the type as it is
  set; asks for a device when that is auto.
*/
FROND_EXTERN PetscErrorCode SphGetResident(Sph sph, PetscBool *yes);

#endif
