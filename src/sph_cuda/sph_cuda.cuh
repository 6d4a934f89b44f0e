/*
  sph_cuda.cuh - private to the CUDA backend: device arrays, error handling, launches.

  The whole state stays on the device between calls; the arrays of struct _p_Sph are a mirror that pull() makes current. All
  work goes to one stream. Host functions that read a result synchronise that stream; nothing else does.
*/
#ifndef SPH_CUDA_CUH
#define SPH_CUDA_CUH

#include <cmath>
#include <cuda_runtime.h>
#include "frondsys.h"
#include <petscviewer.h>
extern "C" {
#include "sphlinkimpl.h"
}

#define SPH_BLOCK 128 /* threads per block */

/* As SphRates, in double precision. */
typedef struct {
  double *a[3], *dv[3], *ds;
} SphCudaRates;

/* Device pointers; n long in sorted order unless said otherwise. Passed to kernels by value. */
typedef struct {
  int n;
  SphState st, stn;
  SphCudaRates rate;
  double *m, *wallratio, *ab[3];
  double *omega; /* angular velocity at boundary markers in the order added, (n - nfluid) x 3, rad/s */
  int nfluid;
  double *xref[3]; /* positions at the last build, m */
  int *group, *id, *slot;
  unsigned *key;  /* sort key of each slot at the last build, see sphcell.h */
  int *cellstart; /* 2 ncell + 2 offsets */
} SphCudaArrays;

/* One linked group (sphlink.h): places of its first state (a flag, then the state), load and section; markers [b0, b1). */
typedef struct {
  int nnodes, slopes, state, load, nload, section0, section1, b0, b1;
} SphCudaLinkInfo;

/* Linked groups one after the other, device pointers; passed to kernels by value. */
typedef struct {
  int nlinks, nsections, nentries, nnodes, nchunks, nstate, nload;
  SphCudaLinkInfo *link;
  int *sectionlink, *rowstart;                     /* per section */
  int *section;                                    /* per boundary marker, -1: not linked */
  double *offset;                                  /* 3 per boundary marker */
  int *chunkstart, *chunk0, *chunk1;               /* chunks of a section; markers [chunk0, chunk1) of a chunk */
  int *node;                                       /* per entry, within its link */
  double *shape, *slope;                           /* per entry */
  int *nodestart, *byentry, *bysection, *nodeload; /* entries of a node, their sections; place of its load */
  double *state;
  FrondSection *frame;      /* per section */
  double *chunksums, *sums; /* SECTION_SUMS per chunk, per section */
  double *load;             /* per link: its load, then SECTION_TOTALS */
} SphCudaLinks;

typedef struct {
  void **p;
  size_t bytes;
} SphCudaTable;
#define SPH_LINKCONSTANTS 15
#define SPH_LINKTABLES 20

typedef struct {
  SphCudaArrays d;
  SphGrid grid;
  PetscInt keycap;     /* entries in d.cellstart */
  unsigned *keyalt;    /* sort work space; afterwards flags of the overlap check */
  int *from, *fromalt; /* from[new slot] = old slot */
  double *spare;       /* one array of doubles, the target of a permutation */
  void *q;             /* prepared quantities of the pair sums, 3 n four-vectors in the working precision */
  void *temp;          /* work space of CUB */
  size_t tempbytes;
  void *result, *hresult;   /* result of a reduction on the device, and in pinned memory */
  PetscInt nb;              /* boundary markers */
  double *motion, *hmotion; /* 4 x nb x 3: x, v, a, angular velocity of boundary markers in the order added; device and pinned */
  double *force, *hforce;   /* nb x 3 */
  PetscInt dirty0, dirty1;  /* range of hmotion not yet on the device */
  cudaEvent_t uploaded;     /* hmotion and hstate may be written again */
  SphCudaLinks links;
  SphCudaLinkInfo *hlink; /* links.link on the host */
  double *hstate, *hload; /* links.state and links.load in pinned memory */
  int link0, link1;       /* range of links whose state is not yet on the device */
  cudaEvent_t downloaded; /* hload has arrived */
  PetscBool loadcurrent, downloading;
  PetscBool uploading, built, hostcurrent, forcecurrent;
  PetscBool timing; /* synchronise after every stage, so that -log_view attributes its time */
  cudaStream_t stream;
  double bytes; /* device memory in use */
} SphCuda;

/* The operations that exist once per precision (sph_cudapairs.cuh). */
typedef struct {
  PetscErrorCode (*prepare)(Sph); /* what all of these read, from the state */
  PetscErrorCode (*aux)(Sph);     /* XSPH velocity, Eq. 11; Adami extrapolation; before the rates */
  PetscErrorCode (*rates)(Sph);   /* Eqs. 4-6 */
  PetscErrorCode (*sum)(Sph);     /* Eq. 9 into rate.ds */
} SphCudaPairs;
extern const SphCudaPairs SphCudaPairs_single, SphCudaPairs_double;

static inline const SphCudaPairs *SphCudaGetPairs(Sph sph)
{
  return sph->par.precision == SPH_PRECISION_SINGLE ? &SphCudaPairs_single : &SphCudaPairs_double;
}

extern PetscErrorCode SphCudaError(cudaError_t err, const char call[], const char function[], const char file[], int line);
extern PetscErrorCode SphCudaStageEnd(SphCuda *cuda);
extern PetscErrorCode SphCudaFlushMotion(Sph sph);
extern PetscErrorCode SphCudaReserve(SphCuda *cuda, void **p, size_t bytes);

extern PetscErrorCode SphCudaAwaitUpload(SphCuda *cuda);

/* sph_cudalink.cu */
extern void SphCudaLinkCount(Sph sph, SphCudaLinks *l);
extern int SphCudaLinkTables(SphCudaLinks *l, PetscInt nb, SphCudaTable *t);
extern PetscErrorCode SphCudaLinkSetUp(Sph sph);
extern void SphCudaLinkForget(SphCuda *cuda);
extern PetscErrorCode SphCudaLinkFlush(Sph sph);
extern PetscErrorCode SphCudaLinkMotion(Sph sph, PetscInt g);
extern PetscErrorCode SphCudaLinkReduce(Sph sph);
extern PetscErrorCode SphCudaLinkLoad(Sph sph, PetscInt g, PetscReal *load, double *totals);

/* sph_cudabuild.cu */
extern PetscErrorCode SphCudaBuild(Sph sph);
extern PetscErrorCode SphCudaRanges(SphCuda *cuda);
extern PetscErrorCode SphCudaSortBytes(PetscInt n, size_t *bytes);

/* sph_cudastep.cu */
typedef struct {
  double lo[3], hi[3];
} SphCudaBox;
extern PetscErrorCode SphCudaReduceBytes(Sph sph, size_t *bytes);
extern PetscErrorCode SphCudaMaxMove2(Sph sph, double *r2);
extern PetscErrorCode SphCudaExtent(Sph sph, SphCudaBox *box);
extern PetscErrorCode SphCudaCountLeft(Sph sph, PetscInt *left);
extern PetscErrorCode SphCudaAnyFlag(Sph sph, const unsigned *flag, PetscBool *any);
extern PetscErrorCode SphCudaCheck(Sph sph);
extern PetscErrorCode SphCudaLimits(Sph sph, PetscReal *vmax, PetscReal *amax);
extern PetscErrorCode SphCudaHalfStep(Sph sph, PetscReal dt);
extern PetscErrorCode SphCudaFullStep(Sph sph, PetscReal dt);
extern PetscErrorCode SphCudaReinit(Sph sph);

/* Every CUDA call goes through this: a failure becomes a PETSc error that names the call. */
#define SphCallCUDA(...)                                                                                                         \
  do {                                                                                                                           \
    const cudaError_t err_ = (__VA_ARGS__);                                                                                      \
    if (PetscUnlikely(err_ != cudaSuccess)) return SphCudaError(err_, #__VA_ARGS__, PETSC_FUNCTION_NAME, __FILE__, __LINE__);    \
  } while (0)

/* Run kernel(args...) with one thread for each of n items. Valid C++ for nvcc and for a host compiler. */
template <typename... P, typename... A>
static inline cudaError_t SphLaunch(cudaStream_t stream, PetscInt n, void (*kernel)(P...), A... args)
{
  cudaLaunchConfig_t config = {};

  if (n <= 0) return cudaSuccess;
  config.gridDim = dim3((unsigned)((n + SPH_BLOCK - 1) / SPH_BLOCK));
  config.blockDim = dim3(SPH_BLOCK);
  config.stream = stream;
  return cudaLaunchKernelEx(&config, kernel, static_cast<P>(args)...);
}

/* Item of this thread. */
#define SPH_ITEM ((int)(blockIdx.x * blockDim.x + threadIdx.x))

#endif
