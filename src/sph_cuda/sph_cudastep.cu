/*
  sph_cudastep.cu - stages of the time step, reductions over the markers, and the check for non-finite values, on the device.

  The stages are those of sphstep.h. Reductions are maxima, minima and integer counts: their
  value does not depend on the order in which the device combines them.
*/
#include "sph_cuda.cuh"
#include <cub/device/device_reduce.cuh>
#include <iterator>
typedef double sphreal;
#include "sphstep.h"

typedef enum { STAGE_HALF, STAGE_RK2, STAGE_SYMPLECTIC, STAGE_VERLET } Stage;

/* One stage of sphstep.h; boundaries keep their motion, and their density unless it is evolved. */
static __global__ void StageKernel(SphCudaArrays d, SphParams p, Stage stage, double dt, double span)
{
  const int i = SPH_ITEM;
  SphStepMarker m;

  if (i >= d.n) return;
  const int group = d.group[i], fluid = group == -1;
  if (!fluid && !(group >= 0 && p.wall == SPH_WALL_BCE)) return;
  for (int k = 0; k < 3; k++) {
    m.x[k] = d.st.x[k][i];
    m.v[k] = d.st.v[k][i];
    m.xn[k] = d.stn.x[k][i];
    m.vn[k] = d.stn.v[k][i];
    m.acc[k] = k < p.dim ? d.rate.a[k][i] + p.f[k] : 0.0;
    m.dv[k] = d.rate.dv[k][i];
  }
  m.s = d.st.s[i];
  m.sn = d.stn.s[i];
  m.ds = d.rate.ds[i];
  if (stage == STAGE_HALF)
    sph_step_half(&m, fluid, dt);
  else if (stage == STAGE_RK2)
    sph_step_full_rk2(&m, fluid, dt);
  else if (stage == STAGE_SYMPLECTIC)
    sph_step_full_symplectic(&m, fluid, dt);
  else
    sph_step_full_verlet(&m, fluid, dt, span);
  d.st.s[i] = m.s;
  d.stn.s[i] = m.sn;
  for (int k = 0; k < 3 && fluid; k++) {
    d.st.x[k][i] = m.x[k];
    d.st.v[k][i] = m.v[k];
    d.stn.x[k][i] = m.xn[k];
    d.stn.v[k][i] = m.vn[k];
  }
}

static __global__ void ReinitKernel(SphCudaArrays d)
{
  const int i = SPH_ITEM;

  if (i < d.n && d.group[i] == -1) d.st.s[i] = d.rate.ds[i];
}

/* The values f(0), f(1), ... as an input iterator of CUB. */
template <class F> struct Measure {
  typedef std::random_access_iterator_tag iterator_category;
  typedef typename F::result value_type;
  typedef ptrdiff_t difference_type;
  typedef const value_type *pointer;
  typedef value_type reference;

  F f;
  ptrdiff_t at;

  __host__ __device__ value_type operator*() const
  {
    return f((int)at);
  }
  __host__ __device__ value_type operator[](ptrdiff_t k) const
  {
    return f((int)(at + k));
  }
  __host__ __device__ Measure operator+(ptrdiff_t k) const
  {
    return Measure{f, at + k};
  }
  __host__ __device__ Measure operator-(ptrdiff_t k) const
  {
    return Measure{f, at - k};
  }
  __host__ __device__ ptrdiff_t operator-(const Measure &o) const
  {
    return at - o.at;
  }
  __host__ __device__ bool operator==(const Measure &o) const
  {
    return at == o.at;
  }
  __host__ __device__ bool operator!=(const Measure &o) const
  {
    return at != o.at;
  }
  __host__ __device__ Measure &operator+=(ptrdiff_t k)
  {
    at += k;
    return *this;
  }
  __host__ __device__ Measure &operator++()
  {
    at++;
    return *this;
  }
};

/* Squared displacement since the last build, m^2; a value that is not finite counts as far. */
struct Displacement {
  typedef double result;
  SphCudaArrays d;
  SphGrid g;
  int dim;

  __host__ __device__ double operator()(int i) const
  {
    double r2 = 0.0;
    for (int k = 0; k < dim; k++) {
      double e = d.st.x[k][i] - d.xref[k][i];
      if (g.periodic[k]) e -= g.length[k] * rint(e / g.length[k]);
      r2 += e * e;
    }
    if (d.group[i] == -2) return 0.0;
    return r2 >= 0.0 ? r2 : HUGE_VAL;
  }
};

struct SpeedAcceleration {
  double v2, a2;
};

struct Limit {
  typedef SpeedAcceleration result;
  SphCudaArrays d;
  SphParams p;

  __host__ __device__ SpeedAcceleration operator()(int i) const
  {
    const int fluid = d.group[i] == -1;
    SpeedAcceleration r = {0.0, 0.0};
    for (int k = 0; k < p.dim; k++) {
      const double a = fluid ? d.rate.a[k][i] + p.f[k] : 0.0;
      r.v2 += d.st.v[k][i] * d.st.v[k][i];
      r.a2 += a * a;
    }
    if (!(r.v2 >= 0.0)) r.v2 = HUGE_VAL;
    if (!(r.a2 >= 0.0)) r.a2 = HUGE_VAL;
    return r;
  }
};

struct Extent {
  typedef SphCudaBox result;
  SphCudaArrays d;

  __host__ __device__ SphCudaBox operator()(int i) const
  {
    const int in = d.group[i] != -2;
    SphCudaBox b;
    for (int k = 0; k < 3; k++) {
      b.lo[k] = in ? d.st.x[k][i] : HUGE_VAL;
      b.hi[k] = in ? d.st.x[k][i] : -HUGE_VAL;
    }
    return b;
  }
};

struct Left {
  typedef int result;
  const int *group;

  __host__ __device__ int operator()(int i) const
  {
    return group[i] == -2;
  }
};

struct Flag {
  typedef int result;
  const unsigned *flag;

  __host__ __device__ int operator()(int i) const
  {
    return (int)flag[i];
  }
};

struct NonFinite {
  typedef int result;
  SphCudaArrays d;

  __host__ __device__ int operator()(int i) const
  {
    double zero = 0.0 * d.st.s[i]; /* 0 x is NaN for every x that is not finite */
    for (int k = 0; k < 3; k++) zero += 0.0 * d.st.x[k][i] + 0.0 * d.st.v[k][i] + 0.0 * d.rate.a[k][i];
    return zero == 0.0 ? 0 : 1;
  }
};

struct Largest {
  __host__ __device__ double operator()(double a, double b) const
  {
    return a < b ? b : a;
  }
  __host__ __device__ int operator()(int a, int b) const
  {
    return a < b ? b : a;
  }
  __host__ __device__ SpeedAcceleration operator()(const SpeedAcceleration &a, const SpeedAcceleration &b) const
  {
    return SpeedAcceleration{a.v2 < b.v2 ? b.v2 : a.v2, a.a2 < b.a2 ? b.a2 : a.a2};
  }
  __host__ __device__ SphCudaBox operator()(const SphCudaBox &a, const SphCudaBox &b) const
  {
    SphCudaBox c;
    for (int k = 0; k < 3; k++) {
      c.lo[k] = a.lo[k] < b.lo[k] ? a.lo[k] : b.lo[k];
      c.hi[k] = a.hi[k] < b.hi[k] ? b.hi[k] : a.hi[k];
    }
    return c;
  }
};

struct Plus {
  __host__ __device__ int operator()(int a, int b) const
  {
    return a + b;
  }
};

template <class F, class Op> static cudaError_t ReduceBytes(F f, Op op, typename F::result init, int n, size_t *bytes)
{
  size_t need = 0;
  const cudaError_t err =
      cub::DeviceReduce::Reduce(NULL, need, Measure<F>{f, 0}, (typename F::result *)NULL, n, op, init, (cudaStream_t)0);

  if (need > *bytes) *bytes = need;
  return err;
}

/* op over f(0..n-1); waits for the result. */
template <class F, class Op> static PetscErrorCode Reduce(Sph sph, F f, Op op, typename F::result init, typename F::result *out)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  size_t bytes = cuda->tempbytes;

  PetscFunctionBegin;
  static_assert(sizeof(typename F::result) <= sizeof(SphCudaBox), "cuda->result has the size of the largest result");
  SphCallCUDA(cub::DeviceReduce::Reduce(cuda->temp, bytes, Measure<F>{f, 0}, (typename F::result *)cuda->result, cuda->d.n, op,
                                        init, cuda->stream));
  SphCallCUDA(cudaMemcpyAsync(cuda->hresult, cuda->result, sizeof(typename F::result), cudaMemcpyDeviceToHost, cuda->stream));
  SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  *out = *(typename F::result *)cuda->hresult;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SphCudaBox nowhere = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
static const SpeedAcceleration atrest = {0.0, 0.0};

/* Work space that the largest of the reductions below needs. */
PetscErrorCode SphCudaReduceBytes(Sph sph, size_t *bytes)
{
  const SphCudaArrays *d = &((SphCuda *)sph->data)->d;
  const SphGrid g = {};

  PetscFunctionBegin;
  SphCallCUDA(ReduceBytes(Displacement{*d, g, 3}, Largest(), 0.0, d->n, bytes));
  SphCallCUDA(ReduceBytes(Limit{*d, sph->par}, Largest(), atrest, d->n, bytes));
  SphCallCUDA(ReduceBytes(Extent{*d}, Largest(), nowhere, d->n, bytes));
  SphCallCUDA(ReduceBytes(Left{d->group}, Plus(), 0, d->n, bytes));
  SphCallCUDA(ReduceBytes(Flag{NULL}, Largest(), 0, d->n, bytes));
  SphCallCUDA(ReduceBytes(NonFinite{*d}, Largest(), 0, d->n, bytes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaMaxMove2(Sph sph, double *r2)
{
  const SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  PetscCall(Reduce(sph, Displacement{cuda->d, cuda->grid, (int)sph->par.dim}, Largest(), 0.0, r2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaExtent(Sph sph, SphCudaBox *box)
{
  PetscFunctionBegin;
  PetscCall(Reduce(sph, Extent{((SphCuda *)sph->data)->d}, Largest(), nowhere, box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaCountLeft(Sph sph, PetscInt *left)
{
  int n = 0;

  PetscFunctionBegin;
  PetscCall(Reduce(sph, Left{((SphCuda *)sph->data)->d.group}, Plus(), 0, &n));
  *left = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaAnyFlag(Sph sph, const unsigned *flag, PetscBool *any)
{
  int most = 0;

  PetscFunctionBegin;
  PetscCall(Reduce(sph, Flag{flag}, Largest(), 0, &most));
  *any = most ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The state crosses the bus only when there is something to report. */
PetscErrorCode SphCudaCheck(Sph sph)
{
  int bad = 0;

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  PetscCall(Reduce(sph, NonFinite{((SphCuda *)sph->data)->d}, Largest(), 0, &bad));
  if (!bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(SphCheckFinite(sph));
  SETERRQ(sph->comm, PETSC_ERR_PLIB, "the device found a non-finite value that the host does not see");
}

PetscErrorCode SphCudaLimits(Sph sph, PetscReal *vmax, PetscReal *amax)
{
  SpeedAcceleration r = atrest;

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  PetscCall(Reduce(sph, Limit{((SphCuda *)sph->data)->d, sph->par}, Largest(), atrest, &r));
  *vmax = sqrt(r.v2);
  *amax = sqrt(r.a2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveStage(Sph sph, Stage stage, PetscReal dt)
{
  SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, StageKernel, cuda->d, sph->par, stage, dt, sph->verletspan));
  cuda->hostcurrent = PETSC_FALSE;
  PetscCall(SphCudaStageEnd(cuda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaHalfStep(Sph sph, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCall(MoveStage(sph, STAGE_HALF, dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaFullStep(Sph sph, PetscReal dt)
{
  static const Stage stage[] = {STAGE_RK2, STAGE_VERLET, STAGE_SYMPLECTIC}; /* SphIntegratorType */

  PetscFunctionBegin;
  PetscCall(MoveStage(sph, stage[sph->par.integrator], dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaReinit(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  PetscCall((*SphCudaGetPairs(sph)->prepare)(sph));
  PetscCall((*SphCudaGetPairs(sph)->sum)(sph));
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, ReinitKernel, cuda->d));
  cuda->hostcurrent = PETSC_FALSE;
  PetscCall(SphCudaStageEnd(cuda));
  PetscFunctionReturn(PETSC_SUCCESS);
}
