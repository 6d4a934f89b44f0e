/* sph_cudapairs_double.cu - the pair sums of the CUDA backend in double precision. */
typedef double sphreal;
#include "sph_cudapairs.cuh"

const SphCudaPairs SphCudaPairs_double = {Prepare, Aux, Rates, Sum};
