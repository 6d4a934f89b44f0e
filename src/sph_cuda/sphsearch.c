/* sphsearch.c - the markers around a point, and sums over the fluid ones. */
#include <math.h>
typedef double sphreal;
#include "sphsearch.h"
#include "sphopenimpl.h"
#include "sphpair.h"

static double Wrapped(const SphParams *p, int k, double x)
{
  const double length = p->hi[k] - p->lo[k];
  return p->periodic[k] ? x - length * floor((x - p->lo[k]) / length) : x;
}

/* Whether marker i is wanted: fluid or in the zone of an opening, or boundary with those too, and within 2h of the box or of its
 * periodic images. */
static int Wanted(Sph sph, PetscInt i, const PetscReal lo[3], const PetscReal hi[3], int boundary)
{
  const SphParams *p = &sph->par;

  if (sph->group[i] != -1 && !SphIsZone(sph->group[i]) && !(boundary && sph->group[i] >= 0)) return 0;
  for (int k = 0; k < p->dim && lo; k++) {
    const double x = sph->st.x[k][i];
    if (!p->periodic[k] && (x < lo[k] - 2.0 * p->h || x > hi[k] + 2.0 * p->h)) return 0;
  }
  return 1;
}

static PetscErrorCode GridOf(Sph sph, PetscInt n, const int *pick, SphGrid *g)
{
  const SphParams *p = &sph->par;
  const double want = 2.0 * p->h * (1.0 + 1e-9);
  double cells = 1.0;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    double a = HUGE_VAL, b = -HUGE_VAL;
    g->periodic[k] = k < p->dim && p->periodic[k];
    g->length[k] = g->periodic[k] ? p->hi[k] - p->lo[k] : 0.0;
    for (PetscInt j = 0; j < n && k < p->dim && !g->periodic[k]; j++) {
      a = PetscMin(a, sph->st.x[k][pick[j]]);
      b = PetscMax(b, sph->st.x[k][pick[j]]);
    }
    if (k >= p->dim || !(b >= a)) a = b = 0.0;
    g->lo[k] = g->periodic[k] ? p->lo[k] : a;
    g->n[k] = g->periodic[k] ? PetscMax(1, (int)floor(g->length[k] / want)) : (int)PetscMin(floor((b - a) / want), 1e8) + 1;
    g->edge[k] = g->periodic[k] ? g->length[k] / g->n[k] : want;
    cells *= g->n[k];
  }
  PetscCheck(cells < 2e8, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "the fluid needs %g search cells, more than 2e8", cells);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSearchCreate(Sph sph, const PetscReal lo[3], const PetscReal hi[3], int boundary, SphSearch *s)
{
  const SphParams *p = &sph->par;
  SphGrid *g = &s->grid;
  int *pick, *cell;
  PetscInt n = 0, ncell;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(PetscMax(1, sph->n), &pick, PetscMax(1, sph->n), &cell));
  for (PetscInt i = 0; i < sph->n; i++)
    if (Wanted(sph, i, lo, hi, boundary)) pick[n++] = (int)i;
  s->n = n;
  PetscCall(GridOf(sph, n, pick, g));
  ncell = (PetscInt)g->n[0] * g->n[1] * g->n[2];
  PetscCall(PetscCalloc1(ncell + 1, &s->start));
  PetscCall(PetscMalloc2(8 * (size_t)PetscMax(1, n), &s->work, PetscMax(1, n), &s->marker));
  for (int k = 0; k < 3; k++) {
    s->x[k] = s->work + k * n;
    s->v[k] = s->work + (3 + k) * n;
  }
  s->vol = s->work + 6 * n;
  s->s = s->work + 7 * n;
  for (PetscInt j = 0; j < n; j++) {
    int c[3];
    for (int k = 0; k < 3; k++) c[k] = k < p->dim ? sph_cell_coord(g, k, sph->st.x[k][pick[j]]) : 0;
    cell[j] = sph_cell_index(g, c[0], c[1], c[2]);
    s->start[cell[j] + 1]++;
  }
  for (PetscInt c = 0; c < ncell; c++) s->start[c + 1] += s->start[c];
  for (PetscInt j = n - 1; j >= 0; j--) { /* from the end: the order within a cell is kept; start[c + 1] becomes start[c] */
    const int i = pick[j];
    const PetscInt at = --s->start[cell[j] + 1];
    for (int k = 0; k < 3; k++) {
      s->x[k][at] = k < p->dim ? Wrapped(p, k, sph->st.x[k][i]) : 0.0;
      s->v[k][at] = sph->st.v[k][i];
    }
    s->vol[at] = sph->m[i] / (p->rho0 * (1.0 + sph->st.s[i]));
    s->s[at] = sph->st.s[i];
    s->marker[at] = i;
  }
  for (PetscInt c = 0; c < ncell; c++) s->start[c] = s->start[c + 1];
  s->start[ncell] = (int)n;
  PetscCall(PetscFree2(pick, cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSearchDestroy(SphSearch *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->start));
  PetscCall(PetscFree2(s->work, s->marker));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SphPointAdd(const SphParams *p, double vol, const double v[3], double s, const double d[3], SphPointSums *out)
{
  const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], w = vol * sph_w(p->kernel, sqrt(r2));
  const double value[5] = {v[0], v[1], v[2], sph_eos(s, p->B, p->gamma) + p->pb, s};
  int at = 4;

  if (!(w > 0.0)) return;
  out->markers++;
  out->w[0] += w;
  for (int k = 0; k < 3; k++) {
    out->w[1 + k] += w * d[k];
    for (int l = k; l < 3; l++) out->w[at++] += w * d[k] * d[l];
  }
  for (int f = 0; f < 5; f++) {
    out->f[f][0] += w * value[f];
    for (int k = 0; k < 3; k++) out->f[f][1 + k] += w * value[f] * d[k];
  }
}

/* Neighbour of cell coordinate c, and by how much its markers' images are displaced along axis k; -1 when there is none. */
static int Neighbour(const SphGrid *g, int k, int c, int o, double *shift)
{
  *shift = 0.0;
  c += o;
  if (!g->periodic[k]) return c < 0 || c >= g->n[k] ? -1 : c;
  if (c < 0) *shift = -g->length[k];
  if (c >= g->n[k]) *shift = g->length[k];
  return c < 0 ? c + g->n[k] : (c >= g->n[k] ? c - g->n[k] : c);
}

int SphSearchRanges(const Sph sph, const SphSearch *s, const PetscReal xp[3], double x[3], SphSearchRange range[27])
{
  const SphParams *p = &sph->par;
  const SphGrid *g = &s->grid;
  int c[3] = {0, 0, 0}, n = 0;

  for (int k = 0; k < 3; k++) x[k] = 0.0;
  if (!s->n) return 0;
  for (int k = 0; k < p->dim; k++) {
    x[k] = Wrapped(p, k, xp[k]);
    c[k] = sph_cell_coord(g, k, PetscMax(PetscMin(x[k], g->lo[k] + (g->n[k] + 2) * g->edge[k]), g->lo[k] - 2.0 * g->edge[k]));
  }
  for (int o = 0; o < (p->dim == 3 ? 27 : 9); o++) {
    double shift[3] = {0.0, 0.0, 0.0};
    const int a = Neighbour(g, 0, c[0], o % 3 - 1, &shift[0]), b = Neighbour(g, 1, c[1], o / 3 % 3 - 1, &shift[1]);
    const int e = p->dim == 3 ? Neighbour(g, 2, c[2], o / 9 - 1, &shift[2]) : 0;
    if (a < 0 || b < 0 || e < 0) continue;
    const int cell = sph_cell_index(g, a, b, e);
    range[n++] = (SphSearchRange){s->start[cell], s->start[cell + 1], {shift[0], shift[1], shift[2]}};
  }
  return n;
}

void SphSearchSum(const Sph sph, const SphSearch *s, const PetscReal xp[3], SphPointSums *out)
{
  const SphParams *p = &sph->par;
  SphSearchRange range[27];
  double x[3];
  const int n = SphSearchRanges(sph, s, xp, x, range);

  memset(out, 0, sizeof(*out));
  for (int o = 0; o < n; o++) {
    const double *shift = range[o].shift;
    for (int j = range[o].first; j < range[o].last; j++) {
      const double d[3] = {(s->x[0][j] + shift[0] - x[0]) / p->h, (s->x[1][j] + shift[1] - x[1]) / p->h,
                           (s->x[2][j] + shift[2] - x[2]) / p->h};
      const double v[3] = {s->v[0][j], s->v[1][j], s->v[2][j]};
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < 4.0) SphPointAdd(p, s->vol[j], v, s->s[j], d, out);
    }
  }
}

/* Solve the symmetric positive definite system A c = (1, u) of order n (row-major 4 x 4) by Cholesky's factors; 0 when a pivot
 * says that the markers do not span the space. */
static int SolveUnit(int n, double A[4][4], const double u[3], double c[4])
{
  const double scale = A[0][0];

  for (int j = 0; j < n; j++) {
    for (int k = 0; k < j; k++) A[j][j] -= A[j][k] * A[j][k];
    if (!(A[j][j] > (j ? 0.005 : 0.0) * scale)) return 0;
    A[j][j] = sqrt(A[j][j]);
    for (int i = j + 1; i < n; i++) {
      for (int k = 0; k < j; k++) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  for (int i = 0; i < n; i++) {
    c[i] = i == 0 ? 1.0 : u[i - 1];
    for (int k = 0; k < i; k++) c[i] -= A[i][k] * c[k];
    c[i] /= A[i][i];
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) c[i] -= A[k][i] * c[k];
    c[i] /= A[i][i];
  }
  return 1;
}

int SphPointValues(const SphPointSums *s, int dim, int order, double value[5])
{
  return SphPointValuesAt(s, dim, order, (const double[3]){0.0, 0.0, 0.0}, value);
}

int SphPointValuesAt(const SphPointSums *s, int dim, int order, const double u[3], double value[5])
{
  const double *w = s->w;
  double A[4][4] = {{w[0], w[1], w[2], w[3]}, {w[1], w[4], w[5], w[6]}, {w[2], w[5], w[7], w[8]}, {w[3], w[6], w[8], w[9]}};
  double c[4] = {0.0, 0.0, 0.0, 0.0};

  for (int f = 0; f < 5; f++) value[f] = 0.0;
  if (!(w[0] > 0.0)) return -1;
  if (order == 1 && s->markers > dim && SolveUnit(dim + 1, A, u, c)) {
    for (int f = 0; f < 5; f++)
      for (int k = 0; k <= dim; k++) value[f] += c[k] * s->f[f][k];
    return 1;
  }
  for (int f = 0; f < 5; f++) value[f] = s->f[f][0] / w[0];
  return 0;
}
