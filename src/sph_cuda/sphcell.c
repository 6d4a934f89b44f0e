/* sphcell.c - cell grid, stable counting sort of the markers by cell and along a Hilbert curve within it, check for coincident
 * markers. */
#include "sphimpl.h"
#include <math.h>
#include <omp.h>

/* No side of the grid may need more cells than this; a stray marker is taken out long before. */
#define SPH_MAXCELLS 200000000.0

/* Extent that the markers may use along an open axis: the domain and the wall layers around it. */
static void OpenExtent(Sph sph, int k, double *lo, double *hi)
{
  double a = PETSC_MAX_REAL, b = PETSC_MIN_REAL;
#pragma omp parallel for schedule(static) reduction(min : a) reduction(max : b)
  for (PetscInt i = 0; i < sph->n; i++) {
    if (sph->group[i] == -2) continue;
    a = PetscMin(a, sph->st.x[k][i]);
    b = PetscMax(b, sph->st.x[k][i]);
  }
  *lo = a;
  *hi = b;
}

PetscErrorCode SphGridSetUp(Sph sph, PetscReal skin, SphGrid *g)
{
  const SphParams *p = &sph->par;
  const double want = 2.0 * p->h * (1.0 + skin);
  double cells = 1.0;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    g->periodic[k] = k < p->dim && p->periodic[k] ? 1 : 0;
    g->length[k] = 0.0;
    if (k >= p->dim) {
      g->lo[k] = -0.5;
      g->edge[k] = 1.0;
      g->n[k] = 1;
    } else if (g->periodic[k]) {
      g->length[k] = p->hi[k] - p->lo[k];
      g->lo[k] = p->lo[k];
      g->n[k] = PetscMax(1, (int)floor(g->length[k] / want));
      g->edge[k] = g->length[k] / g->n[k];
    } else {
      double lo, hi;
      OpenExtent(sph, k, &lo, &hi);
      PetscCheck((hi - lo) / want < 1e6, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "the markers spread over %g m along axis %c, more than 10^6 cells of %g m", hi - lo, 'x' + k, want);
      g->lo[k] = lo - 0.5 * want;
      g->n[k] = (int)floor((hi - lo) / want) + 2;
      g->edge[k] = want;
    }
    cells *= g->n[k];
  }
  PetscCheck(cells < SPH_MAXCELLS, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "the domain needs %g search cells, more than %g", cells,
             SPH_MAXCELLS);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline int SortKey(Sph sph, const SphGrid *g, PetscInt i)
{
  if (sph->group[i] == -2) return 2 * g->n[0] * g->n[1] * g->n[2];
  const int cx = sph_cell_coord(g, 0, sph->st.x[0][i]);
  const int cy = sph_cell_coord(g, 1, sph->st.x[1][i]);
  const int cz = sph->par.dim == 3 ? sph_cell_coord(g, 2, sph->st.x[2][i]) : 0;
  return 2 * sph_cell_index(g, cx, cy, cz) + (sph->group[i] >= 0 ? 1 : 0);
}

/* array[i] = array[from[i]] for an array of a type, or none. NOLINTBEGIN(bugprone-macro-parentheses) */
#define SPH_PERMUTE(name, type)                                                                                                  \
  static void name(type *array, void *scratch, const int *from, PetscInt n)                                                      \
  {                                                                                                                              \
    type *work = (type *)scratch;                                                                                                \
    if (!array) return;                                                                                                          \
    _Pragma("omp parallel for schedule(static)") for (PetscInt i = 0; i < n; i++) work[i] = array[from[i]];                      \
    _Pragma("omp parallel for schedule(static)") for (PetscInt i = 0; i < n; i++) array[i] = work[i];                            \
  }
/* NOLINTEND(bugprone-macro-parentheses) */
SPH_PERMUTE(PermuteDouble, double)
SPH_PERMUTE(PermuteFloat, float)
SPH_PERMUTE(PermuteInt, int)

/* from[new slot] = old slot; the order within a key is kept, so the result is the same for any number of threads. start: nkeys+1
 * offsets. */
static PetscErrorCode CountingSort(PetscInt n, const int *key, PetscInt nkeys, int *start, int *from)
{
  const int threads = omp_get_max_threads();
  int *count; /* per thread and key: how many, then where the next one goes */
  PetscInt sum = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)threads * (size_t)nkeys, &count));
#pragma omp parallel num_threads(threads)
  {
    const PetscInt t = omp_get_thread_num(), nt = omp_get_num_threads(), i0 = n * t / nt, i1 = n * (t + 1) / nt;
    int *mine = count + t * nkeys;
    for (PetscInt k = 0; k < nkeys; k++) mine[k] = 0;
    for (PetscInt i = i0; i < i1; i++) mine[key[i]]++;
#pragma omp barrier
#pragma omp single
    {
      for (PetscInt k = 0; k < nkeys; k++) {
        start[k] = (int)sum;
        for (PetscInt o = 0; o < nt; o++) {
          const int c = count[o * nkeys + k];
          count[o * nkeys + k] = (int)sum;
          sum += c;
        }
      }
      start[nkeys] = (int)sum;
    }
    for (PetscInt i = i0; i < i1; i++) from[mine[key[i]]++] = (int)i;
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subdivision of a cell, 2^SPH_SUBBITS per axis, numbered along a Hilbert curve. */
#define SPH_SUBBITS 2
#define SPH_SUB (1 << SPH_SUBBITS)
#define SPH_NSUB (SPH_SUB * SPH_SUB * SPH_SUB)

/* Number of point x along the Hilbert curve: Skilling, AIP Conf. Proc. 707 (2004), transposed index of SPH_SUBBITS bits per axis.
 */
static int HilbertNumber(int axes, const int p[3])
{
  const int dim = PetscMin(axes, 3);
  int x[3] = {p[0], p[1], p[2]}, t = 0, number = 0;

  for (int q = SPH_SUB / 2; q > 1; q >>= 1)
    for (int i = 0; i < dim; i++) {
      if (x[i] & q)
        x[0] ^= q - 1;
      else {
        const int s = (x[0] ^ x[i]) & (q - 1);
        x[0] ^= s;
        x[i] ^= s;
      }
    }
  for (int i = 1; i < dim; i++) x[i] ^= x[i - 1];
  for (int q = SPH_SUB / 2; q > 1; q >>= 1)
    if (x[dim - 1] & q) t ^= q - 1;
  for (int b = SPH_SUBBITS - 1; b >= 0; b--)
    for (int i = 0; i < dim; i++) number = 2 * number + (((x[i] ^ t) >> b) & 1);
  return number;
}

/* Stable order of from[0..m) by place within the cell: consecutive markers lie close together, as the pair sums want them. */
static void OrderWithinCell(Sph sph, const SphGrid *g, const int curve[SPH_NSUB], int *from, int m, int *work)
{
  int count[SPH_NSUB + 1] = {0};
  int *sub = work, *sorted = work + m;

  for (int j = 0; j < m; j++) {
    int o[3] = {0, 0, 0};
    for (int k = 0; k < sph->par.dim; k++) {
      const double u = (sph->st.x[k][from[j]] - g->lo[k]) / g->edge[k];
      o[k] = (int)((u - floor(u)) * SPH_SUB);
      o[k] = o[k] < 0 ? 0 : (o[k] >= SPH_SUB ? SPH_SUB - 1 : o[k]);
    }
    sub[j] = curve[(o[2] * SPH_SUB + o[1]) * SPH_SUB + o[0]];
    count[sub[j] + 1]++;
  }
  for (int s = 0; s < SPH_NSUB; s++) count[s + 1] += count[s];
  for (int j = 0; j < m; j++) sorted[count[sub[j]]++] = from[j];
  for (int j = 0; j < m; j++) from[j] = sorted[j];
}

static PetscErrorCode OrderWithinCells(Sph sph, const SphGrid *g, const int *start, PetscInt nkeys, int *from)
{
  int curve[SPH_NSUB], most = 0, *work;

  PetscFunctionBegin;
  for (int k = 0; k < SPH_NSUB; k++)
    curve[k] = HilbertNumber((int)sph->par.dim, (const int[3]){k % SPH_SUB, k / SPH_SUB % SPH_SUB, k / (SPH_SUB * SPH_SUB)});
  for (PetscInt k = 0; k < nkeys; k++) most = PetscMax(most, start[k + 1] - start[k]);
  PetscCall(PetscMalloc1((size_t)omp_get_max_threads() * 2 * (size_t)most, &work));
#pragma omp parallel for schedule(static)
  for (PetscInt k = 0; k < nkeys; k++) {
    const int m = start[k + 1] - start[k];
    if (m > 1) OrderWithinCell(sph, g, curve, from + start[k], m, work + (size_t)omp_get_thread_num() * 2 * (size_t)most);
  }
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All arrays that live in sorted order; the saved state only where it must survive from step to step. work: n doubles. */
static void PermuteAll(Sph sph, const int *from, double *work)
{
  const PetscInt n = sph->n;
  const int saved = sph->par.integrator == SPH_INTEGRATOR_VERLET;
  double *const arrays[] = {sph->st.x[0], sph->st.x[1],  sph->st.x[2],  sph->st.v[0], sph->st.v[1], sph->st.v[2],
                            sph->st.s,    sph->m,        sph->ab[0],    sph->ab[1],   sph->ab[2],   sph->wallratio,
                            sph->stn.s,   sph->stn.v[0], sph->stn.v[1], sph->stn.v[2]};
  const SphRates *r = &sph->rate;
  const SphValues *const rates[] = {&r->a[0], &r->a[1], &r->a[2], &r->dv[0], &r->dv[1], &r->dv[2], &r->ds};

  for (size_t k = 0; k < sizeof(arrays) / sizeof(arrays[0]) - (saved ? 0 : 4); k++) PermuteDouble(arrays[k], work, from, n);
  for (size_t k = 0; k < sizeof(rates) / sizeof(rates[0]); k++) {
    PermuteDouble(rates[k]->d, work, from, n);
    PermuteFloat(rates[k]->f, work, from, n);
  }
  PermuteInt(sph->group, work, from, n);
  PermuteInt(sph->id, work, from, n);
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < n; i++) sph->slot[sph->id[i]] = (int)i;
}

PetscErrorCode SphSortMarkers(Sph sph, const SphGrid *g, int **cellstart, PetscInt *cellcap, void *scratch)
{
  const PetscInt n = sph->n, nkeys = 2 * (PetscInt)g->n[0] * g->n[1] * g->n[2] + 1;
  double *work = (double *)scratch;
  int *key = (int *)work, *from = (int *)(work + n);

  PetscFunctionBegin;
  if (nkeys + 1 > *cellcap) {
    PetscCall(PetscFree(*cellstart));
    *cellcap = nkeys + 1 + nkeys / 8;
    PetscCall(PetscMalloc1(*cellcap, cellstart));
  }
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < sph->par.dim; k++) { /* wrap fluid and boundary markers into the period */
      if (g->periodic[k]) sph->st.x[k][i] -= g->length[k] * floor((sph->st.x[k][i] - g->lo[k]) / g->length[k]);
    }
    key[i] = SortKey(sph, g, i);
  }
  PetscCall(CountingSort(n, key, nkeys, *cellstart, from));
  PetscCall(OrderWithinCells(sph, g, *cellstart, nkeys - 1, from));
  PermuteAll(sph, from, work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Squared distance of markers i and j, nearest images, m^2. */
static double Distance2(Sph sph, const SphGrid *g, PetscInt i, PetscInt j)
{
  double r2 = 0.0;
  for (int k = 0; k < sph->par.dim; k++) {
    double d = sph->st.x[k][i] - sph->st.x[k][j];
    if (g->periodic[k]) d -= g->length[k] * rint(d / g->length[k]);
    r2 += d * d;
  }
  return r2;
}

/* A pair of markers of cells c and d closer than tol, as numbers in added order, the smallest first; huge numbers when there is
 * none. */
static void ClosePair(Sph sph, const SphGrid *g, const int *cellstart, int c, int d, double tol, PetscInt pair[2])
{
  for (int i = cellstart[2 * c]; i < cellstart[2 * c + 2]; i++)
    for (int j = c == d ? i + 1 : cellstart[2 * d]; j < cellstart[2 * d + 2]; j++) {
      if (fabs(sph->st.x[0][i] - sph->st.x[0][j]) >= tol && !g->periodic[0]) continue;
      if (Distance2(sph, g, i, j) < tol * tol) {
        const PetscInt a = PetscMin(sph->id[i], sph->id[j]), b = PetscMax(sph->id[i], sph->id[j]);
        if (a < pair[0] || (a == pair[0] && b < pair[1])) {
          pair[0] = a;
          pair[1] = b;
        }
      }
    }
}

/* Each pair of neighbouring cells is looked at from one of its sides: half of the 27 neighbours and the cell itself. */
PetscErrorCode SphCheckOverlap(Sph sph, const SphGrid *g, const int *cellstart)
{
  const double tol = 0.1 * sph->par.dp;
  const int ncell = g->n[0] * g->n[1] * g->n[2];
  PetscInt pair[2] = {PETSC_MAX_INT, PETSC_MAX_INT};

  PetscFunctionBegin;
#pragma omp parallel
  {
    PetscInt mine[2] = {PETSC_MAX_INT, PETSC_MAX_INT};
#pragma omp for schedule(dynamic, 64)
    for (int c = 0; c < ncell; c++) {
      const int cc[3] = {c % g->n[0], c / g->n[0] % g->n[1], c / (g->n[0] * g->n[1])};
      if (cellstart[2 * c] == cellstart[2 * c + 2]) continue;
      for (int o = 13; o < 27; o++) {
        const int nx = sph_cell_neighbour(g, 0, cc[0], o % 3 - 1), ny = sph_cell_neighbour(g, 1, cc[1], o / 3 % 3 - 1),
                  nz = sph_cell_neighbour(g, 2, cc[2], o / 9 - 1);
        if (nx >= 0 && ny >= 0 && nz >= 0) ClosePair(sph, g, cellstart, c, sph_cell_index(g, nx, ny, nz), tol, mine);
      }
    }
#pragma omp critical
    if (mine[0] < pair[0] || (mine[0] == pair[0] && mine[1] < pair[1])) {
      pair[0] = mine[0];
      pair[1] = mine[1];
    }
  }
  if (pair[0] < PETSC_MAX_INT) {
    const int i = sph->slot[pair[0]];
    SETERRQ(sph->comm, PETSC_ERR_ARG_WRONG,
            "markers %" PetscInt_FMT " and %" PetscInt_FMT " (groups %d and %d)"
            " lie on top of one another at (%g, %g, %g): their distance %.3g m must be at least 0.1 sph_dp = %.3g m",
            pair[0], pair[1], sph->group[i], sph->group[sph->slot[pair[1]]], sph->st.x[0][i], sph->st.x[1][i], sph->st.x[2][i],
            sqrt(Distance2(sph, g, i, sph->slot[pair[1]])), tol);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
