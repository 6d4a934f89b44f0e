/*
  couplehost.h - a host code's own structure in the coupling: nodes, shape functions, generalised forces S^T F.

  The host owns its mesh, its state and its integrator. It describes once how BCE markers hang on its nodes, gives the nodes'
  motion when asked, and receives the generalised nodal forces that hold over the step it then takes. A section is a point r =
  sum_j S_j q_j of the structure, q_j the host's nodes; S are its shape functions there. Two kinds: without slopes: the section's
  markers lie at r, as on a mesh of solid elements; with slopes: r_s = sum_j S'_j q_j is a tangent as well, and markers lie off r
  on a rigid cross-section normal to it, as on the disks of a beam's axis (Sect. 2.4 of Pazouki, Serban, Negrut) or across the
  thickness of a plate strip. Transfer of a force F on a marker at offset o: Q_j = S_j F + S'_j ((o x F) x t)/|r_s|, t =
  r_s/|r_s|, so that Q . q' = F . x' (Eq. 23 and its off-axis part). Force, moment and power are conserved to round-off, but for
  the torque about t of a section with slopes, which no node coordinate takes up: CoupleAudit.twist.
*/
#ifndef COUPLEHOST_H
#define COUPLEHOST_H

#include "couple.h"

/* How markers hang on the nodes. Arrays are copied. */
typedef struct {
  PetscInt dim;               /* 2 or 3; nodes have 3 numbers in both, the third 0 in 2D */
  PetscInt nnodes;            /* nodes */
  const PetscBool *direction; /* nnodes, or NULL for none: the node is a direction (a position gradient), not a position */
  PetscInt nsections;         /* sections */
  const PetscInt *rowstart;   /* nsections + 1: entries of section i are rowstart[i] ... rowstart[i+1]-1 */
  const PetscInt *node;       /* rowstart[nsections]: node of each entry, in [0, nnodes) */
  const PetscReal *shape;     /* as many: S; over position nodes they add up to 1 in each section */
  const PetscReal *slope;     /* as many, or NULL for sections without slopes: S'; over position nodes they add up to 0 */
  PetscInt nmarkers;          /* BCE markers */
  const PetscInt *section;    /* nmarkers, ascending: the section of each */
  const PetscReal *offset;    /* nmarkers x 2, or NULL for 0: m along the normals d1 and t x d1 (2D: along d1 = (-t_y, t_x)) */
  const PetscReal *volume;    /* nmarkers: the volume that each stands for, m^3 (2D: m^2) */
  const PetscReal *depth;     /* nmarkers: depth below the wet surface, m */
} CoupleHostSpec;

/* What the host does. All but getloads and those below "optional" must be given. */
typedef struct {
  /* Time (s; NULL: not wanted) and state of the nodes then, nnodes x 3 each, borrowed until the host is called again. */
  PetscErrorCode (*getstate)(void *ctx, PetscReal *t, const PetscReal **q, const PetscReal **qdot, const PetscReal **qddot);
  /* The host's own array for Q (nnodes x 3, N), which the coupling zeroes and adds to; needed when several surfaces share the
     host. NULL: the surface keeps one. */
  PetscErrorCode (*getloads)(void *ctx, PetscReal **Q);
  /* Integrate to t (s) under Q (nnodes x 3, N, constant but for changeloads: the force at the middle of the step), in as many
     steps as the host likes. Called for every surface of the host: do nothing when already there. */
  PetscErrorCode (*advance)(void *ctx, PetscReal t, const PetscReal *Q);
  /* Optional, as in CoupleSurfaceOps. */
  PetscErrorCode (*momentum)(void *ctx, PetscReal p[3], PetscReal weight[3], PetscReal support[3]);
  PetscErrorCode (*statesize)(void *ctx, PetscInt *n);       /* optional: reals of the state */
  PetscErrorCode (*save)(void *ctx, PetscReal *state);       /* optional: write them */
  PetscErrorCode (*load)(void *ctx, const PetscReal *state); /* optional: go back to them */
  PetscErrorCode (*view)(void *ctx, PetscViewer viewer);     /* optional: print */
  PetscErrorCode (*destroy)(void *ctx);                      /* optional: free ctx */
  /* Optional, for COUPLE_LOADS_LINEAR; called after all loads are there and before advance: they change by dQ (nnodes x 3, N)
     over it, linearly in time, about the mean Q. */
  PetscErrorCode (*changeloads)(void *ctx, const PetscReal *dQ);
} CoupleHostOps;

/*
  Surface of a host's structure at its present state. Refused: node or section numbers out of range, shape functions that do
  not add up, offsets without slopes, volumes <= 0. comm: communicator of the fluid. name: copied. spec: how the markers hang
  on the nodes; copied. ops: what the host does; copied. ctx: the host's, goes to every operation. surface: the new surface.
  Source: the paper, Eq. 23 and Sect. 2.4.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreateHost(MPI_Comm comm, const char name[], const CoupleHostSpec *spec,
                                                    const CoupleHostOps *ops, void *ctx, CoupleSurface *surface);
/* Q: the generalised forces of the last transfer, nnodes x 3, N; borrowed. */
FROND_EXTERN PetscErrorCode CoupleSurfaceHostGetLoads(CoupleSurface surface, const PetscReal **Q);
/* spec: how the markers of a host's or of a beam's surface hang on its nodes; arrays borrowed. */
FROND_EXTERN PetscErrorCode CoupleSurfaceHostGetSpec(CoupleSurface surface, CoupleHostSpec *spec);

#endif
