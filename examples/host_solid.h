/*
  host_solid.h - the host of host_plate.c: a linear-elastic solid in plane strain on PETSc, knowing nothing of fluids.

  Mesh from a Gmsh file through DMPlex; quadratic quadrilaterals of nine nodes (one on every vertex, edge and cell), displacements
  u; M u'' + c M u' + K u = f, integrated by TSALPHA2 (Chung, Hulbert, J. Appl. Mech. 60 (1993)). Per unit depth.
*/
#ifndef HOST_SOLID_H
#define HOST_SOLID_H

#include "frondsys.h"
#include <petscdmplex.h>
#include <petscts.h>

typedef struct {
  PetscReal young, poisson, density, gravity, damping; /* E, Pa; nu; kg/m^3; along -y, m/s^2; c, 1/s */
  DM dm;
  PetscInt n, nfree, c0, c1; /* nodes = points of the mesh; free displacements; cells */
  PetscReal *X;              /* rest positions, n x 2, m */
  PetscInt *dof;             /* n x 2: number of the free displacement, or -1 */
  PetscInt (*cell)[9];       /* nodes of each cell: vertices, edges from each to the next, middle */
  Mat M, K, J;
  Vec U, V, f, weight;
  TS ts;
} Solid;

PetscErrorCode SolidCreate(const char mesh[], Solid *solid);
PetscErrorCode SolidDestroy(Solid *solid);
/* Shape functions of the nine nodes of a cell at (xi, eta) in [-1,1]^2, and their derivatives along x, 1/m. */
void SolidShape(const Solid *solid, PetscInt cell, PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal Nx[9]);
/* The cell that holds the point x and its coordinates in it. Errors: none does. */
PetscErrorCode SolidFind(const Solid *solid, const PetscReal x[2], PetscInt *cell, PetscReal *xi, PetscReal *eta);
/* f = weight + nodal forces Q (n x 3). */
PetscErrorCode SolidSetLoads(Solid *solid, const PetscReal *Q);
/* Nodal forces (n x 3) of a pressure (Pa) on the edges with the physical number `tag` of the mesh, along -y. */
PetscErrorCode SolidPressure(Solid *solid, PetscInt tag, PetscReal pressure, PetscReal *Q);
/* The static displacements under f, into U. */
PetscErrorCode SolidStatic(Solid *solid);
PetscErrorCode SolidAdvance(Solid *solid, PetscReal t);
/* Displacement component c of node i from a vector of free ones. */
static inline PetscReal SolidValue(const Solid *s, const PetscScalar *u, PetscInt i, int c)
{
  return s->dof[2 * i + c] < 0 ? 0.0 : PetscRealPart(u[s->dof[2 * i + c]]);
}

#endif
