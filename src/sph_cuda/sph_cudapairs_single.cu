/* sph_cudapairs_single.cu - the pair sums of the CUDA backend in single precision. */
typedef float sphreal;
#include "sph_cudapairs.cuh"

const SphCudaPairs SphCudaPairs_single = {Prepare, Aux, Rates, Sum};
