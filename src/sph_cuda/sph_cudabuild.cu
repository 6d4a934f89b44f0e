/*
  sph_cudabuild.cu - the search structure on the device: markers that left, sort keys, radix sort, permutation, cell ranges.

  The order is that of sphcell.c: a stable sort by the key of sphcell.h, so that markers of a cell keep their order and
  sums run in the same order whatever the device does.
*/
#include "sph_cuda.cuh"
#include <cub/device/device_radix_sort.cuh>

/* Cells are 5 % larger than the support, so that they serve until a marker has moved half of that. */
#define SPH_SKIN 0.05

/* Fluid markers beyond an open side by more than the wall layers are frozen and taken out of all sums. */
static __global__ void LeftKernel(SphCudaArrays d, SphParams p)
{
  const int i = SPH_ITEM;
  const double margin = 2.0 * p.h + p.dp;
  int out = 0;

  if (i >= d.n || d.group[i] != -1) return;
  for (int k = 0; k < p.dim; k++)
    if (!p.periodic[k] && (d.st.x[k][i] < p.lo[k] - margin || d.st.x[k][i] > p.hi[k] + margin)) out = 1;
  if (!out) return;
  d.group[i] = -2;
  for (int k = 0; k < 3; k++) d.st.v[k][i] = d.rate.a[k][i] = d.rate.dv[k][i] = 0.0;
  d.rate.ds[i] = 0.0;
}

/* Wrap into the period; sort key and present slot of every marker. */
static __global__ void KeyKernel(SphCudaArrays d, SphGrid g, int dim, unsigned *key, int *from)
{
  const int i = SPH_ITEM;
  int c[3] = {0, 0, 0};

  if (i >= d.n) return;
  for (int k = 0; k < dim; k++) {
    double x = d.st.x[k][i];
    if (g.periodic[k]) {
      x -= g.length[k] * floor((x - g.lo[k]) / g.length[k]);
      d.st.x[k][i] = x;
    }
    c[k] = sph_cell_coord(&g, k, x);
  }
  const int group = d.group[i];
  from[i] = i;
  key[i] = group == -2 ? 2u * (unsigned)(g.n[0] * g.n[1] * g.n[2])
                       : 2u * (unsigned)sph_cell_index(&g, c[0], c[1], c[2]) + (group >= 0 ? 1u : 0u);
}

template <typename T> static __global__ void GatherKernel(T *dst, const T *src, const int *from, int n)
{
  const int i = SPH_ITEM;

  if (i < n) dst[i] = src[from[i]];
}

static __global__ void SlotKernel(SphCudaArrays d)
{
  const int i = SPH_ITEM;

  if (i < d.n) d.slot[d.id[i]] = i;
}

/* cellstart[k] = first slot whose key is at least k, by bisection. */
static __global__ void RangeKernel(const unsigned *key, int n, int *cellstart, int nstart)
{
  const int k = SPH_ITEM;
  int a = 0, b = n;

  if (k >= nstart) return;
  while (a < b) {
    const int mid = a + (b - a) / 2;
    if (key[mid] < (unsigned)k)
      a = mid + 1;
    else
      b = mid;
  }
  cellstart[k] = a;
}

/* flag[i] = 1 when a marker behind i lies within tol of it. */
static __global__ void OverlapKernel(SphCudaArrays d, SphGrid g, int dim, double tol, unsigned *flag)
{
  const int i = SPH_ITEM;

  if (i >= d.n) return;
  flag[i] = 0;
  const int cell = (int)(d.key[i] >> 1);
  if (cell >= g.n[0] * g.n[1] * g.n[2]) return;
  for (int o = 0; o < 27; o++) {
    const int nx = sph_cell_neighbour(&g, 0, cell % g.n[0], o % 3 - 1),
              ny = sph_cell_neighbour(&g, 1, cell / g.n[0] % g.n[1], o / 3 % 3 - 1),
              nz = sph_cell_neighbour(&g, 2, cell / (g.n[0] * g.n[1]), o / 9 - 1);
    if (nx < 0 || ny < 0 || nz < 0) continue;
    const int c = sph_cell_index(&g, nx, ny, nz);
    for (int j = d.cellstart[2 * c]; j < d.cellstart[2 * c + 2]; j++) {
      double r2 = 0.0;
      for (int k = 0; k < dim; k++) {
        double e = d.st.x[k][i] - d.st.x[k][j];
        if (g.periodic[k]) e -= g.length[k] * rint(e / g.length[k]);
        r2 += e * e;
      }
      if (i < j && r2 < tol * tol) flag[i] = 1;
    }
  }
}

PetscErrorCode SphCudaSortBytes(PetscInt n, size_t *bytes)
{
  cub::DoubleBuffer<unsigned> key(NULL, NULL);
  cub::DoubleBuffer<int> from(NULL, NULL);
  size_t need = 0;

  PetscFunctionBegin;
  SphCallCUDA(cub::DeviceRadixSort::SortPairs(NULL, need, key, from, (int)n, 0, 32, (cudaStream_t)0));
  *bytes = PetscMax(*bytes, need);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Grid over the markers as they are: two corner markers stand for all of them. */
static PetscErrorCode GridSetUp(Sph sph, SphCuda *cuda)
{
  struct _p_Sph corners = *sph;
  int group[2] = {0, 0};
  double x[3][2];
  SphCudaBox box;

  PetscFunctionBegin;
  PetscCall(SphCudaExtent(sph, &box));
  for (int k = 0; k < 3; k++) {
    x[k][0] = box.lo[k];
    x[k][1] = box.hi[k];
    corners.st.x[k] = x[k];
  }
  corners.n = 2;
  corners.group = group;
  PetscCall(SphGridSetUp(&corners, SPH_SKIN, &cuda->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Permute(SphCuda *cuda, double **a)
{
  double *old = *a;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, GatherKernel<double>, cuda->spare, old, cuda->from, cuda->d.n));
  *a = cuda->spare;
  cuda->spare = old;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PermuteInt(SphCuda *cuda, int **a)
{
  int *old = *a;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, GatherKernel<int>, cuda->fromalt, old, cuda->from, cuda->d.n));
  *a = cuda->fromalt;
  cuda->fromalt = old;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* keepold: the state before the present one is still needed (verlet). */
static PetscErrorCode PermuteAll(SphCuda *cuda, PetscBool keepold)
{
  SphCudaArrays *d = &cuda->d;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCall(Permute(cuda, &d->st.x[k]));
    PetscCall(Permute(cuda, &d->st.v[k]));
    PetscCall(Permute(cuda, &d->rate.a[k]));
    PetscCall(Permute(cuda, &d->rate.dv[k]));
    PetscCall(Permute(cuda, &d->ab[k]));
    if (keepold) PetscCall(Permute(cuda, &d->stn.v[k]));
  }
  if (keepold) PetscCall(Permute(cuda, &d->stn.s));
  PetscCall(Permute(cuda, &d->st.s));
  PetscCall(Permute(cuda, &d->rate.ds));
  PetscCall(Permute(cuda, &d->m));
  PetscCall(Permute(cuda, &d->wallratio));
  PetscCall(PermuteInt(cuda, &d->group));
  PetscCall(PermuteInt(cuda, &d->id));
  SphCallCUDA(SphLaunch(cuda->stream, d->n, SlotKernel, *d));
  for (int k = 0; k < 3; k++)
    SphCallCUDA(cudaMemcpyAsync(d->xref[k], d->st.x[k], (size_t)d->n * sizeof(double), cudaMemcpyDeviceToDevice, cuda->stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sort by key; d.key and from are valid afterwards. */
static PetscErrorCode Sort(Sph sph, SphCuda *cuda, unsigned nkeys)
{
  SphCudaArrays *d = &cuda->d;
  cub::DoubleBuffer<unsigned> key(d->key, cuda->keyalt);
  cub::DoubleBuffer<int> from(cuda->from, cuda->fromalt);
  size_t bytes = cuda->tempbytes;
  int bits = 1;

  PetscFunctionBegin;
  while (bits < 32 && (nkeys - 1) >> bits) bits++;
  SphCallCUDA(SphLaunch(cuda->stream, d->n, KeyKernel, *d, cuda->grid, (int)sph->par.dim, d->key, cuda->from));
  SphCallCUDA(cub::DeviceRadixSort::SortPairs(cuda->temp, bytes, key, from, d->n, 0, bits, cuda->stream));
  d->key = key.Current();
  cuda->keyalt = key.Alternate();
  cuda->from = from.Current();
  cuda->fromalt = from.Alternate();
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckOverlap(Sph sph, SphCuda *cuda)
{
  const PetscInt nkeys = 2 * (PetscInt)cuda->grid.n[0] * cuda->grid.n[1] * cuda->grid.n[2] + 1;
  PetscBool any;
  int *cellstart;

  PetscFunctionBegin;
  SphCallCUDA(
      SphLaunch(cuda->stream, cuda->d.n, OverlapKernel, cuda->d, cuda->grid, (int)sph->par.dim, 0.1 * sph->par.dp, cuda->keyalt));
  PetscCall(SphCudaAnyFlag(sph, cuda->keyalt, &any));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(PetscMalloc1(nkeys + 1, &cellstart));
  SphCallCUDA(cudaMemcpy(cellstart, cuda->d.cellstart, (size_t)(nkeys + 1) * sizeof(int), cudaMemcpyDeviceToHost));
  PetscCall(SphCheckOverlap(sph, &cuda->grid, cellstart)); /* names the markers */
  PetscCall(PetscFree(cellstart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cell ranges from the sorted keys. */
PetscErrorCode SphCudaRanges(SphCuda *cuda)
{
  SphCudaArrays *d = &cuda->d;
  const PetscInt nstart = 2 * (PetscInt)cuda->grid.n[0] * cuda->grid.n[1] * cuda->grid.n[2] + 2;

  PetscFunctionBegin;
  if (nstart > cuda->keycap) {
    cuda->keycap = nstart + nstart / 8;
    PetscCall(SphCudaReserve(cuda, (void **)&d->cellstart, (size_t)cuda->keycap * sizeof(int)));
  }
  SphCallCUDA(SphLaunch(cuda->stream, nstart, RangeKernel, d->key, d->n, d->cellstart, (int)nstart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaBuild(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  SphCudaArrays *d = &cuda->d;
  const double allowed = 0.5 * SPH_SKIN * 2.0 * sph->par.h * 0.5; /* half: the other half is for the motion within the step */
  double move2;

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  if (cuda->built) {
    PetscCall(SphCudaMaxMove2(sph, &move2));
    if (move2 <= allowed * allowed) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SphCudaCheck(sph));
  SphCallCUDA(SphLaunch(cuda->stream, d->n, LeftKernel, *d, sph->par));
  PetscCall(SphCudaCountLeft(sph, &sph->left));
  PetscCall(GridSetUp(sph, cuda));
  PetscCall(Sort(sph, cuda, (unsigned)(2 * cuda->grid.n[0] * cuda->grid.n[1] * cuda->grid.n[2] + 1)));
  PetscCall(PermuteAll(cuda, sph->par.integrator == SPH_INTEGRATOR_VERLET ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(SphCudaRanges(cuda));
  cuda->hostcurrent = PETSC_FALSE;
  if (!cuda->built && !sph->step) PetscCall(CheckOverlap(sph, cuda));
  cuda->built = PETSC_TRUE;
  PetscCall(SphCudaStageEnd(cuda));
  PetscFunctionReturn(PETSC_SUCCESS);
}
