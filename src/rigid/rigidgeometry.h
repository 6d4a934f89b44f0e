/* rigidgeometry.h - private: closed meshes and composites. */
#ifndef RIGIDGEOMETRY_H
#define RIGIDGEOMETRY_H

#include "rigidimpl.h"

/* Node of the tree of bounding boxes; leaves hold order[first .. first + count). */
typedef struct {
  PetscReal lo[3], hi[3];
  PetscInt child, first, count; /* children are child and child + 1; count = 0 for inner nodes */
} RigidTreeNode;

typedef struct {
  PetscInt nv, nf;
  PetscReal *x;     /* nv x 3, body frame, m */
  PetscInt *tri;    /* nf x 3 */
  PetscReal *nface; /* nf x 3, unit normals */
  PetscReal *nedge; /* nf x 3 x 3, pseudo-normal of edge k -> k + 1 */
  PetscReal *nvert; /* nv x 3, angle-weighted pseudo-normals */
  PetscInt nnodes, *order;
  RigidTreeNode *node;
} RigidMesh;

struct _p_RigidGeometry {
  MPI_Comm comm;
  PetscInt refct, dim;
  RigidShape shape;       /* RIGID_MESH or RIGID_COMPOSITE */
  PetscReal volume;       /* m^3 */
  PetscReal density;      /* composite: mean density, kg/m^3 */
  PetscReal J[3];         /* principal moments per unit of (mean) density */
  PetscReal center[3];    /* centre of mass in the given frame, m */
  PetscReal q[4];         /* given frame = R(q) body frame */
  PetscReal centroid[3];  /* of the volume, body frame, m: where buoyancy acts */
  PetscReal lo[3], hi[3]; /* bounding box, body frame, m */
  RigidMesh mesh;
  PetscInt nparts;
  RigidBodySpec *part; /* position in the body frame */
  PetscReal *partq;    /* nparts x 4, body frame = R part frame */
};

extern PetscErrorCode RigidGeometryCreate_Private(MPI_Comm comm, RigidShape shape, PetscInt dim, RigidGeometry *g);
extern PetscErrorCode RigidGeometryReference(RigidGeometry g);
extern PetscReal RigidGeometryDistance(RigidGeometry g, const PetscReal x[3]);
extern PetscErrorCode RigidMeshReadFile(MPI_Comm comm, const char kind[], const char filename[], size_t *size, char **data);
extern PetscErrorCode RigidMeshScale(MPI_Comm comm, const char kind[], const char filename[], PetscReal scale, PetscInt nf,
                                     PetscReal corners[]);
extern PetscErrorCode RigidMeshReadOBJ(MPI_Comm comm, const char filename[], PetscReal scale, PetscInt *nf, PetscReal **corners);
extern PetscErrorCode RigidMeshReadSTL(MPI_Comm comm, const char filename[], PetscReal scale, PetscInt *nf, PetscReal **corners);
extern PetscErrorCode RigidMeshTopology(MPI_Comm comm, const char name[], RigidMesh *m);
extern PetscErrorCode RigidMeshTree(RigidMesh *m);
extern PetscReal RigidMeshClosest(const RigidMesh *m, const PetscReal x[3], PetscReal bound, PetscReal closest[3]);
extern PetscReal RigidMeshDistance(const RigidMesh *m, const PetscReal x[3]);
extern void RigidPrincipalAxes(const PetscReal A[9], PetscReal J[3], PetscReal q[4]);

#endif
