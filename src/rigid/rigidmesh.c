/*
  rigidmesh.c - closed triangle meshes: welding, checks, volume integrals, body frame.

  Mass properties by the divergence theorem, as sums over the tetrahedra (0, a, b, c) of volume v = a.(b x c)/6:
    V = sum v,   V X = sum v (a + b + c)/4,   int x x^T = sum v/20 (s s^T + a a^T + b b^T + c c^T),  s = a + b + c.
*/
#include "rigidgeometry.h"
#include <stdlib.h>
#include <strings.h>

typedef struct {
  PetscInt lo, hi, facet, side; /* vertices in order, side: corner k where the edge k -> k + 1 starts; negative sense: -1 - k */
} Edge;

static int CompareEdges(const void *pa, const void *pb)
{
  const Edge *a = (const Edge *)pa, *b = (const Edge *)pb;
  if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
  if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
  return a->facet < b->facet ? -1 : (a->facet > b->facet);
}

typedef struct {
  PetscReal x[3];
  PetscInt corner;
} Corner;

static int CompareCorners(const void *pa, const void *pb)
{
  const Corner *a = (const Corner *)pa, *b = (const Corner *)pb;
  for (int k = 0; k < 3; k++)
    if (a->x[k] != b->x[k]) return a->x[k] < b->x[k] ? -1 : 1;
  return a->corner < b->corner ? -1 : (a->corner > b->corner);
}

/* Corners with the same coordinates become one vertex. */
static PetscErrorCode Weld(PetscInt nf, const PetscReal corners[], RigidMesh *m)
{
  Corner *c;

  PetscFunctionBegin;
  m->nf = nf;
  PetscCall(PetscMalloc1(3 * (size_t)nf, &c));
  PetscCall(PetscMalloc1(9 * (size_t)nf, &m->x));
  PetscCall(PetscMalloc1(3 * (size_t)nf, &m->tri));
  for (PetscInt i = 0; i < 3 * nf; i++) {
    for (int k = 0; k < 3; k++) c[i].x[k] = corners[3 * i + k] + 0.; /* -0 becomes 0 */
    c[i].corner = i;
  }
  qsort(c, 3 * (size_t)nf, sizeof(*c), CompareCorners);
  for (PetscInt i = 0; i < 3 * nf; i++) {
    if (i == 0 || c[i].x[0] != c[i - 1].x[0] || c[i].x[1] != c[i - 1].x[1] || c[i].x[2] != c[i - 1].x[2]) {
      PetscCall(PetscArraycpy(&m->x[3 * m->nv], c[i].x, 3));
      m->nv++;
    }
    m->tri[c[i].corner] = m->nv - 1;
  }
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FacetNormal(const RigidMesh *m, PetscInt f, PetscReal n[3])
{
  const PetscReal *a = &m->x[3 * m->tri[3 * f]], *b = &m->x[3 * m->tri[3 * f + 1]], *c = &m->x[3 * m->tri[3 * f + 2]];
  PetscReal u[3], v[3];
  for (int k = 0; k < 3; k++) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  Vec3Cross(u, v, n);
}

static PetscErrorCode FacetNormals(MPI_Comm comm, const char name[], RigidMesh *m)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * (size_t)m->nf, &m->nface));
  PetscCall(PetscMalloc1(9 * (size_t)m->nf, &m->nedge));
  PetscCall(PetscCalloc1(3 * (size_t)m->nv, &m->nvert));
  for (PetscInt f = 0; f < m->nf; f++) {
    PetscReal *n = &m->nface[3 * f], norm;
    FacetNormal(m, f, n);
    norm = Vec3Norm(n);
    PetscCheck(norm > 0., comm, PETSC_ERR_ARG_WRONG, "Mesh %s: facet %" PetscInt_FMT " has no area", name, f);
    for (int k = 0; k < 3; k++) n[k] /= norm;
    for (int k = 0; k < 3; k++) { /* vertices: weighted by the facet's angle there */
      const PetscReal *a = &m->x[3 * m->tri[3 * f + k]], *b = &m->x[3 * m->tri[3 * f + (k + 1) % 3]],
                      *c = &m->x[3 * m->tri[3 * f + (k + 2) % 3]];
      PetscReal u[3], v[3], w[3], angle;
      for (int d = 0; d < 3; d++) {
        u[d] = b[d] - a[d];
        v[d] = c[d] - a[d];
      }
      Vec3Cross(u, v, w);
      angle = PetscAtan2Real(Vec3Norm(w), Vec3Dot(u, v));
      for (int d = 0; d < 3; d++) m->nvert[3 * m->tri[3 * f + k] + d] += angle * n[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run e[0..count) of one edge must be two facets that run along it in opposite senses. */
static PetscErrorCode CheckEdge(MPI_Comm comm, const char name[], const RigidMesh *m, const Edge *e, PetscInt count)
{
  const PetscReal *a = &m->x[3 * e->lo], *b = &m->x[3 * e->hi];

  PetscFunctionBegin;
  PetscCheck(count == 2, comm, PETSC_ERR_ARG_WRONG,
             "Mesh %s is not closed: edge (%g, %g, %g)-(%g, %g, %g) of facet %" PetscInt_FMT " belongs to %" PetscInt_FMT
             " facet(s); must be 2",
             name, (double)a[0], (double)a[1], (double)a[2], (double)b[0], (double)b[1], (double)b[2], e->facet, count);
  PetscCheck((e[0].side < 0) != (e[1].side < 0), comm, PETSC_ERR_ARG_WRONG,
             "Mesh %s is not oriented: facets %" PetscInt_FMT " and %" PetscInt_FMT
             " run along edge (%g, %g, %g)-(%g, %g, %g) in the same sense",
             name, e[0].facet, e[1].facet, (double)a[0], (double)a[1], (double)a[2], (double)b[0], (double)b[1], (double)b[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normals and pseudo-normals (Baerentzen and Aanaes, IEEE TVCG 11, 2005); errors name the mesh and the facet or edge. */
PetscErrorCode RigidMeshTopology(MPI_Comm comm, const char name[], RigidMesh *m)
{
  Edge *e;

  PetscFunctionBegin;
  PetscCall(FacetNormals(comm, name, m));
  PetscCall(PetscMalloc1(3 * (size_t)m->nf, &e));
  for (PetscInt i = 0; i < 3 * m->nf; i++) {
    const PetscInt f = i / 3, k = i % 3, a = m->tri[i], b = m->tri[3 * f + (k + 1) % 3];
    e[i].lo = PetscMin(a, b);
    e[i].hi = PetscMax(a, b);
    e[i].facet = f;
    e[i].side = a < b ? k : -1 - k;
  }
  qsort(e, 3 * (size_t)m->nf, sizeof(*e), CompareEdges);
  for (PetscInt i = 0, j; i < 3 * m->nf; i = j) {
    for (j = i + 1; j < 3 * m->nf && e[j].lo == e[i].lo && e[j].hi == e[i].hi; j++) {
    }
    PetscCall(CheckEdge(comm, name, m, &e[i], j - i));
    for (PetscInt s = 0; s < 2; s++) {
      const Edge *me = &e[i + s], *other = &e[i + 1 - s];
      const PetscInt k = me->side < 0 ? -1 - me->side : me->side;
      for (int d = 0; d < 3; d++)
        m->nedge[9 * me->facet + 3 * k + d] = m->nface[3 * me->facet + d] + m->nface[3 * other->facet + d];
    }
  }
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* V, V X (3) and int x x^T (9) of the solid about the origin. */
static void MeshIntegrals(const RigidMesh *m, PetscReal *V, PetscReal VX[3], PetscReal S[9])
{
  *V = 0.;
  for (int k = 0; k < 3; k++) VX[k] = 0.;
  for (int k = 0; k < 9; k++) S[k] = 0.;
  for (PetscInt f = 0; f < m->nf; f++) {
    const PetscReal *a = &m->x[3 * m->tri[3 * f]], *b = &m->x[3 * m->tri[3 * f + 1]], *c = &m->x[3 * m->tri[3 * f + 2]];
    PetscReal bc[3], s[3], v;
    Vec3Cross(b, c, bc);
    v = Vec3Dot(a, bc) / 6.;
    *V += v;
    for (int k = 0; k < 3; k++) {
      s[k] = a[k] + b[k] + c[k];
      VX[k] += v * s[k] / 4.;
    }
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) S[3 * i + j] += v / 20. * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
  }
}

/* Eigenvalues J and right-handed axes of a symmetric tensor by Jacobi rotations: A = R(q) diag(J) R(q)^T. */
void RigidPrincipalAxes(const PetscReal A[9], PetscReal J[3], PetscReal q[4])
{
  PetscReal B[9];
  const PetscReal scale = PetscAbsReal(A[0]) + PetscAbsReal(A[4]) + PetscAbsReal(A[8]);
  for (int k = 0; k < 9; k++) B[k] = A[k];
  q[0] = 1.;
  q[1] = q[2] = q[3] = 0.;
  for (int sweep = 0; sweep < 50; sweep++) {
    PetscReal off = PetscAbsReal(B[1]) + PetscAbsReal(B[2]) + PetscAbsReal(B[5]);
    if (off <= 1.e-14 * scale) break;
    for (int k = 0; k < 3; k++) { /* turn about axis k by the angle that removes B_ij */
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const PetscReal bij = B[3 * i + j], angle = bij == 0. ? 0. : .5 * PetscAtan2Real(2. * bij, B[4 * i] - B[4 * j]);
      PetscReal v[3] = {0., 0., 0.}, e[4], qn[4], R[9], C[9];
      /* the turn by atan2/2 sorts the two values; take the smaller of the equivalent turns */
      v[k] = angle > .25 * PETSC_PI ? angle - .5 * PETSC_PI : (angle < -.25 * PETSC_PI ? angle + .5 * PETSC_PI : angle);
      QuatExp(v, e);
      QuatMult(q, e, qn);
      for (int d = 0; d < 4; d++) q[d] = qn[d];
      QuatNormalize(q);
      QuatMatrix(e, R);
      for (int r = 0; r < 3; r++) /* B = R^T B R */
        for (int c = 0; c < 3; c++) {
          C[3 * r + c] = 0.;
          for (int s = 0; s < 3; s++)
            for (int t = 0; t < 3; t++) C[3 * r + c] += R[3 * s + r] * B[3 * s + t] * R[3 * t + c];
        }
      for (int d = 0; d < 9; d++) B[d] = C[d];
    }
  }
  for (int k = 0; k < 3; k++) J[k] = B[4 * k];
}

/* Takes the vertices to the body frame and fills in the integrals. */
static PetscErrorCode MeshBodyFrame(RigidGeometry g, const char name[])
{
  RigidMesh *m = &g->mesh;
  PetscReal VX[3] = {0}, S[9], A[9], size = 0.;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) g->center[k] = m->x[k];
  for (int pass = 0; pass < 2; pass++) { /* second pass about the centre: no cancellation for far-off meshes */
    for (PetscInt i = 0; i < 3 * m->nv; i++) m->x[i] -= pass == 0 ? g->center[i % 3] : VX[i % 3];
    if (pass == 1)
      for (int k = 0; k < 3; k++) g->center[k] += VX[k];
    MeshIntegrals(m, &g->volume, VX, S);
    PetscCheck(g->volume != 0., g->comm, PETSC_ERR_ARG_WRONG, "Mesh %s encloses no volume", name);
    for (int k = 0; k < 3; k++) VX[k] /= g->volume;
  }
  for (PetscInt i = 0; i < 3 * m->nv; i++) size = PetscMax(size, PetscAbsReal(m->x[i]));
  PetscCheck(g->volume > 1.e-12 * size * size * size, g->comm, PETSC_ERR_ARG_WRONG,
             "Mesh %s encloses a volume of %g m^3; must be > 0: facets are counter-clockwise seen from outside", name,
             (double)g->volume);
  for (int k = 0; k < 9; k++) A[k] = -S[k];
  for (int k = 0; k < 3; k++) A[4 * k] += S[0] + S[4] + S[8];
  RigidPrincipalAxes(A, g->J, g->q);
  for (PetscInt i = 0; i < m->nv; i++) {
    PetscReal y[3];
    QuatRotateBack(g->q, &m->x[3 * i], y);
    for (int k = 0; k < 3; k++) {
      m->x[3 * i + k] = y[k];
      g->lo[k] = i ? PetscMin(g->lo[k], y[k]) : y[k];
      g->hi[k] = i ? PetscMax(g->hi[k], y[k]) : y[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeshFinish(RigidGeometry g, const char name[])
{
  RigidMesh check = g->mesh;

  PetscFunctionBegin;
  PetscCall(RigidMeshTopology(g->comm, name, &check)); /* in the given frame, so that messages name the file's coordinates */
  PetscCall(PetscFree(check.nface));
  PetscCall(PetscFree(check.nedge));
  PetscCall(PetscFree(check.nvert));
  PetscCall(MeshBodyFrame(g, name));
  PetscCall(RigidMeshTopology(g->comm, name, &g->mesh));
  PetscCall(RigidMeshTree(&g->mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A mesh of nf facets with these corners, which are freed. */
static PetscErrorCode MeshFromCorners(MPI_Comm comm, const char filename[], PetscInt nf, PetscReal *corners,
                                      RigidGeometry *geometry)
{
  PetscFunctionBegin;
  PetscCall(RigidGeometryCreate_Private(comm, RIGID_MESH, 3, geometry));
  PetscCall(Weld(nf, corners, &(*geometry)->mesh));
  PetscCall(PetscFree(corners));
  PetscCall(MeshFinish(*geometry, filename));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryCreateSTL(MPI_Comm comm, const char filename[], PetscReal scale, RigidGeometry *geometry)
{
  PetscReal *corners;
  PetscInt nf;

  PetscFunctionBegin;
  PetscCall(RigidMeshReadSTL(comm, filename, scale, &nf, &corners));
  PetscCall(MeshFromCorners(comm, filename, nf, corners, geometry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryCreateOBJ(MPI_Comm comm, const char filename[], PetscReal scale, RigidGeometry *geometry)
{
  PetscReal *corners;
  PetscInt nf;

  PetscFunctionBegin;
  PetscCall(RigidMeshReadOBJ(comm, filename, scale, &nf, &corners));
  PetscCall(MeshFromCorners(comm, filename, nf, corners, geometry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryCreateFile(MPI_Comm comm, const char filename[], PetscReal scale, RigidGeometry *geometry)
{
  const char *dot = strrchr(filename, '.');

  PetscFunctionBegin;
  if (dot && !strcasecmp(dot, ".obj"))
    PetscCall(RigidGeometryCreateOBJ(comm, filename, scale, geometry));
  else
    PetscCall(RigidGeometryCreateSTL(comm, filename, scale, geometry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryCreateMesh(MPI_Comm comm, PetscInt nv, const PetscReal x[], PetscInt nf, const PetscInt facets[],
                                       RigidGeometry *geometry)
{
  RigidMesh *m;

  PetscFunctionBegin;
  PetscCheck(nf > 0 && nv > 0, comm, PETSC_ERR_ARG_SIZ,
             "Mesh of %" PetscInt_FMT " vertices and %" PetscInt_FMT " facets; must hold some of both", nv, nf);
  for (PetscInt i = 0; i < 3 * nf; i++)
    PetscCheck(facets[i] >= 0 && facets[i] < nv, comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Mesh: facet %" PetscInt_FMT " names vertex %" PetscInt_FMT "; must be 0 ... %" PetscInt_FMT, i / 3, facets[i],
               nv - 1);
  for (PetscInt i = 0; i < 3 * nv; i++)
    PetscCheck(!PetscIsInfOrNanReal(x[i]), comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Mesh: vertex %" PetscInt_FMT " has a coordinate that is not finite", i / 3);
  PetscCall(RigidGeometryCreate_Private(comm, RIGID_MESH, 3, geometry));
  m = &(*geometry)->mesh;
  m->nv = nv;
  m->nf = nf;
  PetscCall(PetscMalloc1(3 * (size_t)nv, &m->x));
  PetscCall(PetscMalloc1(3 * (size_t)nf, &m->tri));
  PetscCall(PetscArraycpy(m->x, x, 3 * nv));
  PetscCall(PetscArraycpy(m->tri, facets, 3 * nf));
  PetscCall(MeshFinish(*geometry, "of the caller"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
