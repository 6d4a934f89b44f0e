/*
  sph_cuda.cu - the CUDA backend: device choice, memory, transfers, table of operations.

  Memory is reserved once, in SphSetUp; a step allocates nothing unless the grid of search cells grows. The state crosses the
  bus only for output, and for SphSetFields(). Boundary motion is collected in pinned memory and sent in one piece before it is
  used; boundary forces come back in one piece when the first of them is asked for.
*/
#include "sph_cuda.cuh"

static PetscBool DeviceLost(cudaError_t err)
{
  static const cudaError_t lost[] = {
      cudaErrorNoDevice,         cudaErrorInvalidDevice,      cudaErrorDevicesUnavailable,  cudaErrorInsufficientDriver,
      cudaErrorECCUncorrectable, cudaErrorHardwareStackError, cudaErrorNvlinkUncorrectable, cudaErrorSystemDriverMismatch};

  for (size_t k = 0; k < sizeof(lost) / sizeof(lost[0]); k++)
    if (err == lost[k]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Asynchronous failures surface at the next synchronising call; -sph_cuda_timing narrows them down to a stage. */
PetscErrorCode SphCudaError(cudaError_t err, const char call[], const char function[], const char file[], int line)
{
  const char *name = cudaGetErrorName(err), *text = cudaGetErrorString(err);

  if (DeviceLost(err))
    return PetscError(PETSC_COMM_SELF, line, function, file, PETSC_ERR_LIB, PETSC_ERROR_INITIAL,
                      "the CUDA device is absent or lost (%s: %s) in %s: restart from the last output, or use sph_type cpu", name,
                      text, call);
  return PetscError(PETSC_COMM_SELF, line, function, file, PETSC_ERR_LIB, PETSC_ERROR_INITIAL, "CUDA error %s (%s) in %s", name,
                    text, call);
}

/*@
  SphCudaAvailable - Is there a CUDA device? No driver and no device are answers, not errors.
@*/
PetscErrorCode SphCudaAvailable(PetscBool *yes)
{
  int n = 0;
  const cudaError_t err = cudaGetDeviceCount(&n);

  PetscFunctionBegin;
  *yes = err == cudaSuccess && n > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (err != cudaSuccess) (void)cudaGetLastError();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphCudaStageEnd(SphCuda *cuda)
{
  PetscFunctionBegin;
  if (cuda->timing) SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replace *p by `bytes` of zeroed device memory; says beforehand when it does not fit. */
PetscErrorCode SphCudaReserve(SphCuda *cuda, void **p, size_t bytes)
{
  size_t free, total;

  PetscFunctionBegin;
  SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  SphCallCUDA(cudaFree(*p));
  *p = NULL;
  SphCallCUDA(cudaMemGetInfo(&free, &total));
  PetscCheck(
      bytes <= free, PETSC_COMM_SELF, PETSC_ERR_MEM,
      "sph_type = cuda: the search cells need %.0f bytes of device memory, %.0f are free: use a larger sph_dp or sph_type cpu",
      (double)bytes, (double)free);
  SphCallCUDA(cudaMalloc(p, bytes));
  SphCallCUDA(cudaMemsetAsync(*p, 0, bytes, cuda->stream));
  cuda->bytes += (double)bytes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define SPH_MAXBUFFERS 96

typedef struct {
  SphCudaTable b[SPH_MAXBUFFERS];
  int n;
} BufferList;

static void Want(BufferList *list, void *p, size_t bytes)
{
  list->b[list->n].p = (void **)p;
  list->b[list->n++].bytes = PetscMax(bytes, (size_t)16);
}

/* The one list of device memory that a run needs. */
static void ListBuffers(Sph sph, SphCuda *cuda, BufferList *list)
{
  const size_t n = (size_t)sph->n, nd = n * sizeof(double), nb = (size_t)cuda->nb * 3 * sizeof(double);
  SphCudaArrays *d = &cuda->d;

  for (int k = 0; k < 3; k++) {
    double **a[] = {&d->st.x[k], &d->st.v[k], &d->stn.x[k], &d->stn.v[k], &d->rate.a[k], &d->rate.dv[k], &d->ab[k], &d->xref[k]};
    for (size_t j = 0; j < sizeof(a) / sizeof(a[0]); j++) Want(list, a[j], nd);
  }
  double **a[] = {&d->st.s, &d->stn.s, &d->rate.ds, &d->m, &d->wallratio, &cuda->spare};
  for (size_t j = 0; j < sizeof(a) / sizeof(a[0]); j++) Want(list, a[j], nd);
  int **b[] = {&d->group, &d->id, &d->slot, &cuda->from, &cuda->fromalt};
  for (size_t j = 0; j < sizeof(b) / sizeof(b[0]); j++) Want(list, b[j], n * sizeof(int));
  Want(list, &d->key, n * sizeof(unsigned));
  Want(list, &cuda->keyalt, n * sizeof(unsigned));
  Want(list, &d->cellstart, (size_t)cuda->keycap * sizeof(int));
  Want(list, &cuda->q, 12 * n * (sph->par.precision == SPH_PRECISION_SINGLE ? sizeof(float) : sizeof(double)));
  Want(list, &cuda->temp, cuda->tempbytes);
  Want(list, &cuda->result, sizeof(SphCudaBox));
  Want(list, &cuda->motion, 4 * nb);
  Want(list, &d->omega, nb);
  Want(list, &cuda->force, nb);
  SphCudaTable t[SPH_LINKTABLES];
  const int nt = SphCudaLinkTables(&cuda->links, cuda->nb, t);
  for (int k = 0; k < nt; k++) Want(list, t[k].p, t[k].bytes);
}

/* All device memory at once, or a message before anything is allocated. */
static PetscErrorCode Allocate(Sph sph, SphCuda *cuda)
{
  BufferList list = {};
  size_t need = 0, free, total;

  PetscFunctionBegin;
  ListBuffers(sph, cuda, &list);
  for (int k = 0; k < list.n; k++) need += (list.b[k].bytes + 511) / 512 * 512;
  SphCallCUDA(cudaMemGetInfo(&free, &total));
  PetscCheck(need <= free, sph->comm, PETSC_ERR_MEM,
             "sph_type = cuda: %" PetscInt_FMT
             " markers need %.0f bytes of device memory, %.0f of %.0f are free: use fewer markers or sph_type cpu",
             sph->n, (double)need, (double)free, (double)total);
  for (int k = 0; k < list.n; k++) {
    SphCallCUDA(cudaMalloc(list.b[k].p, list.b[k].bytes));
    SphCallCUDA(cudaMemsetAsync(*list.b[k].p, 0, list.b[k].bytes, cuda->stream));
  }
  cuda->bytes = (double)need;
  SphCallCUDA(cudaMallocHost((void **)&cuda->hresult, sizeof(SphCudaBox)));
  SphCallCUDA(cudaMallocHost((void **)&cuda->hmotion, PetscMax(12 * (size_t)cuda->nb * sizeof(double), (size_t)16)));
  SphCallCUDA(cudaMallocHost((void **)&cuda->hforce, PetscMax(3 * (size_t)cuda->nb * sizeof(double), (size_t)16)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Device arrays and their mirrors. */
typedef struct {
  void *device, *host;
  size_t size;
} Mirror;

static int ListMirrors(Sph sph, const SphCudaArrays *d, Mirror *m)
{
  const int old = sph->par.integrator == SPH_INTEGRATOR_VERLET; /* the state before lives from step to step */
  int n = 0;
#define MIRROR(dev, host)                                                                                                        \
  m[n++] = Mirror                                                                                                                \
  {                                                                                                                              \
    dev, host, sizeof(*(host))                                                                                                   \
  }
  for (int k = 0; k < 3; k++) {
    MIRROR(d->st.x[k], sph->st.x[k]);
    MIRROR(d->st.v[k], sph->st.v[k]);
    MIRROR(d->rate.a[k], sph->rate.a[k].d);
    MIRROR(d->rate.dv[k], sph->rate.dv[k].d);
    MIRROR(d->ab[k], sph->ab[k]);
    if (old) MIRROR(d->stn.v[k], sph->stn.v[k]);
  }
  MIRROR(d->st.s, sph->st.s);
  MIRROR(d->rate.ds, sph->rate.ds.d);
  if (old) MIRROR(d->stn.s, sph->stn.s);
  MIRROR(d->m, sph->m);
  MIRROR(d->wallratio, sph->wallratio);
  MIRROR(d->group, sph->group);
  MIRROR(d->id, sph->id);
  MIRROR(d->slot, sph->slot);
#undef MIRROR
  return n;
}

static PetscErrorCode Push_CUDA(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  Mirror m[32];
  const int n = ListMirrors(sph, &cuda->d, m);

  PetscFunctionBegin;
  for (int k = 0; k < n; k++)
    SphCallCUDA(cudaMemcpyAsync(m[k].device, m[k].host, (size_t)sph->n * m[k].size, cudaMemcpyHostToDevice, cuda->stream));
  SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  for (PetscInt b = 0; b < cuda->nb; b++) {
    const int i = sph->slot[sph->nfluid + b];
    for (int k = 0; k < 3; k++) {
      cuda->hmotion[3 * b + k] = sph->st.x[k][i];
      cuda->hmotion[3 * (cuda->nb + b) + k] = sph->st.v[k][i];
      cuda->hmotion[3 * (2 * cuda->nb + b) + k] = sph->ab[k][i];
      cuda->hmotion[3 * (3 * cuda->nb + b) + k] = sph->omega ? sph->omega[3 * b + k] : 0.0;
    }
  }
  cuda->dirty0 = cuda->dirty1 = 0;
  SphCudaLinkForget(cuda);
  cuda->uploading = PETSC_FALSE;
  cuda->built = PETSC_FALSE;
  cuda->hostcurrent = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pull_CUDA(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  Mirror m[32];
  const int n = ListMirrors(sph, &cuda->d, m);

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  if (cuda->hostcurrent) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < n; k++)
    SphCallCUDA(cudaMemcpyAsync(m[k].host, m[k].device, (size_t)sph->n * m[k].size, cudaMemcpyDeviceToHost, cuda->stream));
  SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  cuda->hostcurrent = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boundary markers [b0, b1) take the motion in `motion`. */
static __global__ void MotionKernel(SphCudaArrays d, int dim, int nfluid, int nb, const double *motion, const int *section,
                                    int b0, int b1)
{
  const int b = b0 + SPH_ITEM;

  if (b >= b1 || (section && section[b] >= 0)) return; /* linked ones move by their state */
  const int i = d.slot[nfluid + b];
  const size_t o = 3 * (size_t)b, stride = 3 * (size_t)nb;
  for (int k = 0; k < dim; k++) {
    d.st.x[k][i] = motion[o + k];
    d.st.v[k][i] = motion[stride + o + k];
    d.ab[k][i] = motion[2 * stride + o + k];
  }
  for (int k = 0; k < 3; k++) d.omega[o + k] = motion[3 * stride + o + k];
}

static __global__ void ForceKernel(SphCudaArrays d, int nfluid, int nb, double *force)
{
  const int b = SPH_ITEM;

  if (b >= nb) return;
  const int i = d.slot[nfluid + b];
  for (int k = 0; k < 3; k++) force[3 * (size_t)b + k] = d.m[i] * d.rate.a[k][i];
}

/* Send the motion of groups that are not linked. */
static PetscErrorCode FlushMarkers(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const size_t first = 3 * (size_t)cuda->dirty0, bytes = 3 * (size_t)(cuda->dirty1 - cuda->dirty0) * sizeof(double),
               stride = 3 * (size_t)cuda->nb;

  PetscFunctionBegin;
  if (cuda->dirty0 == cuda->dirty1) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 4; k++)
    SphCallCUDA(cudaMemcpyAsync(cuda->motion + k * stride + first, cuda->hmotion + k * stride + first, bytes,
                                cudaMemcpyHostToDevice, cuda->stream));
  SphCallCUDA(cudaEventRecord(cuda->uploaded, cuda->stream));
  SphCallCUDA(SphLaunch(cuda->stream, cuda->dirty1 - cuda->dirty0, MotionKernel, cuda->d, (int)sph->par.dim, (int)sph->nfluid,
                        (int)cuda->nb, cuda->motion, (const int *)cuda->links.section, (int)cuda->dirty0, (int)cuda->dirty1));
  cuda->uploading = PETSC_TRUE;
  cuda->hostcurrent = PETSC_FALSE;
  cuda->dirty0 = cuda->dirty1 = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Send the motion collected since the last time. */
PetscErrorCode SphCudaFlushMotion(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  if (cuda->dirty0 == cuda->dirty1 && cuda->link0 == cuda->link1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FlushMarkers(sph));
  PetscCall(SphCudaLinkFlush(sph));
  PetscCall(SphCudaStageEnd(cuda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The copy engine may still be reading hmotion and hstate. */
PetscErrorCode SphCudaAwaitUpload(SphCuda *cuda)
{
  PetscFunctionBegin;
  if (cuda->uploading) SphCallCUDA(cudaEventSynchronize(cuda->uploaded));
  cuda->uploading = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are the n values of x (zeros when NULL) those in h? */
static PetscBool Same(const double *h, const PetscReal *x, PetscInt n)
{
  for (PetscInt i = 0; i < n; i++)
    if (h[i] != (x ? x[i] : 0.0)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Boundary markers [b0, b1) of hmotion are to be sent. */
static void MarkDirty(SphCuda *cuda, PetscInt b0, PetscInt b1)
{
  const PetscBool none = cuda->dirty0 == cuda->dirty1 ? PETSC_TRUE : PETSC_FALSE;

  cuda->dirty0 = none ? b0 : PetscMin(cuda->dirty0, b0);
  cuda->dirty1 = none ? b1 : PetscMax(cuda->dirty1, b1);
}

static PetscErrorCode Rotation_CUDA(Sph sph, PetscInt group)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const PetscInt b0 = sph->groupstart[group] - sph->nfluid, b1 = sph->groupstart[group + 1] - sph->nfluid;

  PetscFunctionBegin;
  PetscCall(SphCudaAwaitUpload(cuda));
  PetscCall(PetscArraycpy(cuda->hmotion + 9 * cuda->nb + 3 * b0, sph->omega + 3 * b0, 3 * (b1 - b0)));
  MarkDirty(cuda, b0, b1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers that stay as they are, walls above all, are not sent again. */
static PetscErrorCode Motion_CUDA(Sph sph, PetscInt group, const PetscReal *x, const PetscReal *v, const PetscReal *a)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const PetscInt b0 = sph->groupstart[group] - sph->nfluid, b1 = sph->groupstart[group + 1] - sph->nfluid;
  double *hx = cuda->hmotion + 3 * b0, *hv = hx + 3 * cuda->nb, *ha = hv + 3 * cuda->nb;

  PetscFunctionBegin;
  if (Same(hx, x, 3 * (b1 - b0)) && Same(hv, v, 3 * (b1 - b0)) && Same(ha, a, 3 * (b1 - b0))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphCudaAwaitUpload(cuda));
  PetscCall(PetscArraycpy(hx, x, 3 * (b1 - b0)));
  PetscCall(PetscArraycpy(hv, v, 3 * (b1 - b0)));
  if (a)
    PetscCall(PetscArraycpy(ha, a, 3 * (b1 - b0)));
  else
    PetscCall(PetscArrayzero(ha, 3 * (b1 - b0)));
  MarkDirty(cuda, b0, b1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Force_CUDA(Sph sph, PetscInt group, PetscReal *f)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const PetscInt b0 = sph->groupstart[group] - sph->nfluid, b1 = sph->groupstart[group + 1] - sph->nfluid;

  PetscFunctionBegin;
  if (!cuda->forcecurrent) {
    SphCallCUDA(SphLaunch(cuda->stream, cuda->nb, ForceKernel, cuda->d, (int)sph->nfluid, (int)cuda->nb, cuda->force));
    SphCallCUDA(
        cudaMemcpyAsync(cuda->hforce, cuda->force, 3 * (size_t)cuda->nb * sizeof(double), cudaMemcpyDeviceToHost, cuda->stream));
    SphCallCUDA(cudaStreamSynchronize(cuda->stream));
    cuda->forcecurrent = PETSC_TRUE;
  }
  PetscCall(PetscArraycpy(f, cuda->hforce + 3 * b0, 3 * (b1 - b0)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Rates_CUDA(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const SphCudaPairs *pairs = SphCudaGetPairs(sph);

  PetscFunctionBegin;
  PetscCall(SphCudaFlushMotion(sph));
  PetscCall(PetscLogEventBegin(SPH_Aux, 0, 0, 0, 0));
  PetscCall((*pairs->prepare)(sph));
  if (SphTwoVelocities(&sph->par)) PetscCall((*pairs->aux)(sph));
  PetscCall(SphCudaStageEnd(cuda));
  PetscCall(PetscLogEventEnd(SPH_Aux, 0, 0, 0, 0));
  PetscCall(PetscLogEventBegin(SPH_Rates, 0, 0, 0, 0));
  PetscCall((*pairs->rates)(sph));
  PetscCall(SphCudaStageEnd(cuda));
  PetscCall(PetscLogEventEnd(SPH_Rates, 0, 0, 0, 0));
  cuda->hostcurrent = cuda->forcecurrent = cuda->loadcurrent = PETSC_FALSE;
  /* forces of a second stage go to the host while the device takes the step */
  if (cuda->links.nlinks && sph->insidestep) PetscCall(SphCudaLinkReduce(sph));
  sph->evaluations += (PetscReal)(sph->n - sph->left);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The search structure of sphstate.c: grid, keys and the positions they were made at. After a load the device has all of the
 * state. */
static PetscErrorCode State_CUDA(Sph sph, FrondState *s)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const size_t n = (size_t)sph->n, nd = n * sizeof(double), nk = n * sizeof(unsigned);
  const int load = s->way == FROND_STATE_LOAD;
  PetscBool built = cuda->built, there = PETSC_TRUE;
  const char *const name[] = {"fluid/search_cuda/x", "fluid/search_cuda/y", "fluid/search_cuda/z"};
  double *x[3];
  unsigned *key;

  PetscFunctionBegin;
  if (load) {
    PetscCall((*s->has)(s, "fluid/search_cuda/built", &there));
    cuda->forcecurrent = cuda->loadcurrent = PETSC_FALSE;
    if (sph->omega)
      SphCallCUDA(cudaMemcpyAsync(cuda->d.omega, sph->omega, 3 * (size_t)cuda->nb * sizeof(double), cudaMemcpyHostToDevice,
                                  cuda->stream));
  }
  if (!there) { /* a state of the other backend */
    PetscCall(Push_CUDA(sph));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  FrondMoveBool(s, "fluid/search_cuda/built", &built);
  PetscCall(SphMoveGrid(s, "fluid/search_cuda", &cuda->grid));
  PetscCall(PetscMalloc4(n, &x[0], n, &x[1], n, &x[2], n, &key));
  if (s->way == FROND_STATE_SAVE) {
    for (int k = 0; k < 3; k++) SphCallCUDA(cudaMemcpyAsync(x[k], cuda->d.xref[k], nd, cudaMemcpyDeviceToHost, cuda->stream));
    SphCallCUDA(cudaMemcpyAsync(key, cuda->d.key, nk, cudaMemcpyDeviceToHost, cuda->stream));
    SphCallCUDA(cudaStreamSynchronize(cuda->stream));
  }
  for (int k = 0; k < 3; k++) FrondMoveReal(s, name[k], x[k], n);
  FrondMoveInt32(s, "fluid/search_cuda/key", key, n);
  if (load) {
    PetscCall(Push_CUDA(sph));
    for (int k = 0; k < 3; k++) SphCallCUDA(cudaMemcpyAsync(cuda->d.xref[k], x[k], nd, cudaMemcpyHostToDevice, cuda->stream));
    SphCallCUDA(cudaMemcpyAsync(cuda->d.key, key, nk, cudaMemcpyHostToDevice, cuda->stream));
    if (built) PetscCall(SphCudaRanges(cuda));
    SphCallCUDA(cudaStreamSynchronize(cuda->stream));
    cuda->built = built;
  }
  PetscCall(PetscFree4(x[0], x[1], x[2], key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_CUDA(Sph sph)
{
  SphCuda *cuda;
  SphGrid grid;

  PetscFunctionBegin;
  PetscCall(PetscNew(&cuda));
  sph->data = cuda;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-log_view", &cuda->timing));
  PetscOptionsBegin(sph->comm, sph->prefix[0] ? sph->prefix : NULL, "SPH fluid on a CUDA device", "Sph");
  PetscCall(PetscOptionsBool("-sph_cuda_timing", "Wait for the device after every stage, so that -log_view attributes its time",
                             "SphSetType", cuda->timing, &cuda->timing, NULL));
  PetscOptionsEnd();
  PetscCall(SphGridSetUp(sph, 0.0, &grid)); /* the cells of a build are larger, so there are not more of them */
  cuda->keycap = 2 * (PetscInt)grid.n[0] * grid.n[1] * grid.n[2];
  cuda->keycap += cuda->keycap / 4 + 2;
  cuda->d.n = (int)sph->n;
  cuda->nb = sph->n - sph->nfluid;
  cuda->d.nfluid = (int)sph->nfluid;
  SphCallCUDA(cudaStreamCreateWithFlags(&cuda->stream, cudaStreamNonBlocking));
  SphCallCUDA(cudaEventCreateWithFlags(&cuda->uploaded, cudaEventDisableTiming));
  SphCallCUDA(cudaEventCreateWithFlags(&cuda->downloaded, cudaEventDisableTiming));
  SphCudaLinkCount(sph, &cuda->links);
  PetscCall(SphCudaSortBytes(sph->n, &cuda->tempbytes));
  PetscCall(SphCudaReduceBytes(sph, &cuda->tempbytes));
  PetscCall(Allocate(sph, cuda));
  PetscCall(SphCudaLinkSetUp(sph));
  PetscCall(Push_CUDA(sph));
  PetscCall(
      PetscInfo(NULL, "CUDA backend: %g bytes of device memory, %g per marker\n", cuda->bytes, cuda->bytes / (double)sph->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs also after a failure of the device, so the results of these calls are not looked at. */
static PetscErrorCode Destroy_CUDA(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  BufferList list = {};

  PetscFunctionBegin;
  if (!cuda) PetscFunctionReturn(PETSC_SUCCESS);
  ListBuffers(sph, cuda, &list);
  if (cuda->stream) (void)cudaStreamSynchronize(cuda->stream);
  for (int k = 0; k < list.n; k++) (void)cudaFree(*list.b[k].p);
  (void)cudaFreeHost(cuda->hresult);
  (void)cudaFreeHost(cuda->hmotion);
  (void)cudaFreeHost(cuda->hforce);
  (void)cudaFreeHost(cuda->hstate);
  (void)cudaFreeHost(cuda->hload);
  PetscCall(PetscFree(cuda->hlink));
  if (cuda->downloaded) (void)cudaEventDestroy(cuda->downloaded);
  if (cuda->uploaded) (void)cudaEventDestroy(cuda->uploaded);
  if (cuda->stream) (void)cudaStreamDestroy(cuda->stream);
  (void)cudaGetLastError();
  PetscCall(PetscFree(sph->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

extern "C" const SphOps SphOps_CUDA = {SetUp_CUDA,      SphCudaBuild,  Rates_CUDA,   SphCudaHalfStep, SphCudaFullStep,
                                       SphCudaReinit,   Motion_CUDA,   Force_CUDA,   SphCudaLimits,   Pull_CUDA,
                                       Push_CUDA,       Destroy_CUDA,  SphCudaCheck, State_CUDA,      SphCudaLinkMotion,
                                       SphCudaLinkLoad, Rotation_CUDA, NULL};
