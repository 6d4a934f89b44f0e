/* rigidpairs.c - pairs of bodies whose bounding spheres are within reach of one another, by a grid of cells. */
#include "rigidcontact.h"
#include <stdlib.h>

int RigidComparePairs(const void *pa, const void *pb)
{
  const Pair *a = (const Pair *)pa, *b = (const Pair *)pb;
  if (a->i != b->i) return a->i < b->i ? -1 : 1;
  return a->j < b->j ? -1 : (a->j > b->j);
}

static PetscErrorCode AddPair(Rigid rigid, RigidContact c, PetscInt a, PetscInt b)
{
  const Pair p = {PetscMin(a, b), PetscMax(a, b)};
  const PetscReal reach = c->radius[a] + c->radius[b] + c->reach;
  PetscReal d2 = 0.;

  PetscFunctionBegin;
  if (a == b || (rigid->body[a].spec.motion != RIGID_FREE && rigid->body[b].spec.motion != RIGID_FREE))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) d2 += PetscSqr(RigidNearestImage(rigid->body[a].X[k] - rigid->body[b].X[k], rigid->period[k]));
  if (d2 > reach * reach) PetscFunctionReturn(PETSC_SUCCESS);
  if (c->njoined && bsearch(&p, c->joined, (size_t)c->njoined, sizeof(Pair), RigidComparePairs))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (c->npairs == c->npairalloc) {
    c->npairalloc = 2 * c->npairalloc + 64;
    PetscCall(PetscRealloc(sizeof(Pair) * (size_t)c->npairalloc, &c->pair));
  }
  c->pair[c->npairs++] = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Grid of cells no smaller than the reach of small bodies and no more than 8 n in number; the period or the bodies' box. */
static void GridSize(Rigid rigid, const RigidContact c, PetscReal lo[3], PetscReal cell[3], PetscInt n[3])
{
  const PetscInt most = 8 * rigid->n + 8;
  PetscReal size = 2. * c->small + c->reach, length[3];
  for (int k = 0; k < 3; k++) {
    PetscReal hi = 0.;
    lo[k] = 0.;
    for (PetscInt i = 0; i < rigid->n && rigid->period[k] == 0.; i++) {
      lo[k] = i ? PetscMin(lo[k], rigid->body[i].X[k]) : rigid->body[i].X[k];
      hi = i ? PetscMax(hi, rigid->body[i].X[k]) : rigid->body[i].X[k];
    }
    length[k] = rigid->period[k] > 0. ? rigid->period[k] : hi - lo[k];
  }
  do {
    PetscReal total = 1.;
    for (int k = 0; k < 3; k++) {
      n[k] = PetscMax(1, (PetscInt)PetscMin(length[k] / size, 1.e6));
      cell[k] = length[k] > 0. ? length[k] / (PetscReal)n[k] : 1.;
      total *= (PetscReal)n[k];
    }
    if (total <= (PetscReal)most) return;
    size *= 1.26;
  } while (PETSC_TRUE);
}

static void GridCell(Rigid rigid, const PetscReal X[3], const PetscReal lo[3], const PetscReal cell[3], const PetscInt n[3],
                     PetscInt id[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscReal L = rigid->period[k], x = L > 0. ? X[k] - L * PetscFloorReal(X[k] / L) : X[k] - lo[k];
    id[k] = PetscMax(0, PetscMin(n[k] - 1, (PetscInt)(x / cell[k])));
  }
}

/* Bodies of the 27 cells around that of body i which come before it in the lists built so far. */
static PetscErrorCode GridNeighbours(Rigid rigid, RigidContact c, PetscInt i, const PetscInt id[3], const PetscInt n[3])
{
  PetscFunctionBegin;
  for (int m = 0; m < 27; m++) {
    PetscInt at[3] = {id[0] + m % 3 - 1, id[1] + m / 3 % 3 - 1, id[2] + m / 9 - 1};
    PetscBool outside = PETSC_FALSE;
    for (int k = 0; k < 3; k++) {
      if (rigid->period[k] > 0.)
        at[k] = (at[k] + n[k]) % n[k];
      else if (at[k] < 0 || at[k] >= n[k])
        outside = PETSC_TRUE;
    }
    if (outside) continue;
    for (PetscInt j = c->head[at[0] + n[0] * (at[1] + n[1] * at[2])]; j >= 0; j = c->next[j]) PetscCall(AddPair(rigid, c, i, j));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs whose bounding spheres are within reach, sorted. */
PetscErrorCode RigidFindPairs(Rigid rigid, RigidContact c)
{
  PetscReal lo[3], cell[3];
  PetscInt n[3], total, m = 0;

  PetscFunctionBegin;
  GridSize(rigid, c, lo, cell, n);
  total = n[0] * n[1] * n[2];
  if (total > c->nhead) {
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)total, &c->head));
    c->nhead = total;
  }
  for (PetscInt k = 0; k < total; k++) c->head[k] = -1;
  c->npairs = 0;
  for (PetscInt i = 0; i < rigid->n; i++) {
    PetscInt id[3], at;
    if (c->radius[i] > c->small) {
      for (PetscInt j = 0; j < rigid->n; j++) PetscCall(AddPair(rigid, c, i, j));
      continue;
    }
    GridCell(rigid, rigid->body[i].X, lo, cell, n, id);
    PetscCall(GridNeighbours(rigid, c, i, id, n));
    at = id[0] + n[0] * (id[1] + n[1] * id[2]);
    c->next[i] = c->head[at];
    c->head[at] = i;
  }
  if (c->npairs) qsort(c->pair, (size_t)c->npairs, sizeof(Pair), RigidComparePairs);
  for (PetscInt k = 0; k < c->npairs; k++)
    if (m == 0 || RigidComparePairs(&c->pair[k], &c->pair[m - 1])) c->pair[m++] = c->pair[k];
  c->npairs = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}
