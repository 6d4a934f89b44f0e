/*
  rigidbvh.c - signed distance to a closed mesh: tree of bounding boxes, closest point of a triangle (Ericson, Real-Time
  Collision Detection, Sect. 5.1.5), sign from the pseudo-normal of the closest feature (Baerentzen and Aanaes, IEEE TVCG 11,
  2005).
*/
#include "rigidgeometry.h"

#define LEAF 4
#define STACK 256

static void FacetBox(const RigidMesh *m, PetscInt f, PetscReal lo[3], PetscReal hi[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscReal a = m->x[3 * m->tri[3 * f] + k], b = m->x[3 * m->tri[3 * f + 1] + k], c = m->x[3 * m->tri[3 * f + 2] + k];
    lo[k] = PetscMin(PetscMin(a, b), c);
    hi[k] = PetscMax(PetscMax(a, b), c);
  }
}

static PetscReal FacetMiddle(const RigidMesh *m, PetscInt f, int k)
{
  PetscReal lo[3], hi[3];
  FacetBox(m, f, lo, hi);
  return lo[k] + hi[k];
}

static void NodeBox(const RigidMesh *m, RigidTreeNode *n)
{
  for (PetscInt i = n->first; i < n->first + n->count; i++) {
    PetscReal lo[3], hi[3];
    FacetBox(m, m->order[i], lo, hi);
    for (int k = 0; k < 3; k++) {
      n->lo[k] = i == n->first ? lo[k] : PetscMin(n->lo[k], lo[k]);
      n->hi[k] = i == n->first ? hi[k] : PetscMax(n->hi[k], hi[k]);
    }
  }
}

/* Split node i at the middle of its facets along its longest side, or in halves of the list where that is lopsided. */
static void Split(RigidMesh *m, PetscInt i)
{
  RigidTreeNode *n = &m->node[i];
  PetscInt last = n->first + n->count, mid = n->first;
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (n->hi[k] - n->lo[k] > n->hi[axis] - n->lo[axis]) axis = k;
  for (PetscInt j = n->first; j < last; j++) {
    if (FacetMiddle(m, m->order[j], axis) < n->lo[axis] + n->hi[axis]) {
      const PetscInt f = m->order[j];
      m->order[j] = m->order[mid];
      m->order[mid++] = f;
    }
  }
  if (PetscMin(mid - n->first, last - mid) < n->count / 8 + 1) mid = n->first + n->count / 2;
  n->child = m->nnodes;
  m->nnodes += 2;
  m->node[n->child].first = n->first;
  m->node[n->child].count = mid - n->first;
  m->node[n->child + 1].first = mid;
  m->node[n->child + 1].count = last - mid;
  n->count = 0;
}

PetscErrorCode RigidMeshTree(RigidMesh *m)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)m->nf, &m->order));
  PetscCall(PetscCalloc1(2 * (size_t)m->nf, &m->node));
  for (PetscInt f = 0; f < m->nf; f++) m->order[f] = f;
  m->nnodes = 1;
  m->node[0].count = m->nf;
  for (PetscInt i = 0; i < m->nnodes; i++) { /* children come after their parent */
    NodeBox(m, &m->node[i]);
    if (m->node[i].count > LEAF) Split(m, i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal BoxDistance2(const RigidTreeNode *n, const PetscReal x[3])
{
  PetscReal d2 = 0.;
  for (int k = 0; k < 3; k++) {
    const PetscReal d = PetscMax(PetscMax(n->lo[k] - x[k], x[k] - n->hi[k]), 0.);
    d2 += d * d;
  }
  return d2;
}

/* Closest point c of triangle abc to p; returns the feature: 0..2 vertex, 3..5 edge k -> k + 1, 6 face. */
static int ClosestPoint(const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], const PetscReal p[3], PetscReal y[3])
{
  PetscReal ab[3], ac[3], ap[3], bp[3], cp[3], d1, d2, d3, d4, d5, d6, va, vb, vc, t, s;
  for (int k = 0; k < 3; k++) {
    ab[k] = b[k] - a[k];
    ac[k] = c[k] - a[k];
    ap[k] = p[k] - a[k];
    bp[k] = p[k] - b[k];
    cp[k] = p[k] - c[k];
  }
#define RETURN_POINT(base, t1, u, t2, v, feature)                                                                                \
  {                                                                                                                              \
    for (int k = 0; k < 3; k++) y[k] = (base)[k] + (t1) * (u)[k] + (t2) * (v)[k];                                                \
    return feature;                                                                                                              \
  }
  d1 = Vec3Dot(ab, ap), d2 = Vec3Dot(ac, ap);
  if (d1 <= 0. && d2 <= 0.) RETURN_POINT(a, 0., ab, 0., ac, 0)
  d3 = Vec3Dot(ab, bp), d4 = Vec3Dot(ac, bp);
  if (d3 >= 0. && d4 <= d3) RETURN_POINT(b, 0., ab, 0., ac, 1)
  vc = d1 * d4 - d3 * d2;
  if (vc <= 0. && d1 >= 0. && d3 <= 0.) RETURN_POINT(a, d1 / (d1 - d3), ab, 0., ac, 3)
  d5 = Vec3Dot(ab, cp), d6 = Vec3Dot(ac, cp);
  if (d6 >= 0. && d5 <= d6) RETURN_POINT(c, 0., ab, 0., ac, 2)
  vb = d5 * d2 - d1 * d6;
  if (vb <= 0. && d2 >= 0. && d6 <= 0.) RETURN_POINT(a, 0., ab, d2 / (d2 - d6), ac, 5)
  va = d3 * d6 - d5 * d4;
  if (va <= 0. && d4 - d3 >= 0. && d5 - d6 >= 0.) {
    t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    RETURN_POINT(b, -t, ab, t, ac, 4) /* b + t (c - b) = b + t (ac - ab) */
  }
  s = 1. / (va + vb + vc);
  RETURN_POINT(a, vb * s, ab, vc * s, ac, 6)
#undef RETURN_POINT
}

static PetscReal PseudoSide(const RigidMesh *m, PetscInt f, int feature, const PetscReal y[3], const PetscReal x[3])
{
  const PetscReal *n = feature < 3 ? &m->nvert[3 * m->tri[3 * f + feature]]
                                   : (feature < 6 ? &m->nedge[9 * f + 3 * (feature - 3)] : &m->nface[3 * f]);
  return n[0] * (x[0] - y[0]) + n[1] * (x[1] - y[1]) + n[2] * (x[2] - y[2]);
}

/* Signed distance of x and the surface's closest point; `bound` is an upper bound of the distance that the caller knows, m. */
PetscReal RigidMeshClosest(const RigidMesh *m, const PetscReal x[3], PetscReal bound, PetscReal closest[3])
{
  PetscInt stack[STACK], depth = 0;
  PetscReal best = bound < 1.e150 ? bound * bound : PETSC_MAX_REAL, side = 1.;
  stack[depth++] = 0;
  while (depth) {
    const RigidTreeNode *n = &m->node[stack[--depth]];
    if (BoxDistance2(n, x) > best) continue;
    if (n->count) {
      for (PetscInt i = n->first; i < n->first + n->count; i++) {
        const PetscInt f = m->order[i];
        PetscReal y[3], d2 = 0.;
        const int feature =
            ClosestPoint(&m->x[3 * m->tri[3 * f]], &m->x[3 * m->tri[3 * f + 1]], &m->x[3 * m->tri[3 * f + 2]], x, y);
        for (int k = 0; k < 3; k++) d2 += (x[k] - y[k]) * (x[k] - y[k]);
        if (d2 < best) {
          best = d2;
          for (int k = 0; k < 3; k++) closest[k] = y[k];
          side = PseudoSide(m, f, feature, y, x);
        }
      }
    } else {
      const PetscInt near = BoxDistance2(&m->node[n->child], x) <= BoxDistance2(&m->node[n->child + 1], x) ? 0 : 1;
      if (depth + 2 > STACK) return PETSC_MAX_REAL; /* cannot happen: a child holds 7/8 of its parent at most */
      stack[depth++] = n->child + 1 - near;
      stack[depth++] = n->child + near;
    }
  }
  return side < 0. ? -PetscSqrtReal(best) : PetscSqrtReal(best);
}

PetscReal RigidMeshDistance(const RigidMesh *m, const PetscReal x[3])
{
  PetscReal y[3];
  return RigidMeshClosest(m, x, PETSC_MAX_REAL, y);
}
