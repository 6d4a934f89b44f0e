# The CUDA backend. Physics and index arithmetic come from the headers that the CPU uses.
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86-real 89-real 90 CACHE STRING "CUDA architectures; 90 also carries PTX for later ones")
endif()
enable_language(CUDA)
find_package(CUDAToolkit REQUIRED)

add_library(frond_sph_cuda OBJECT sph_cuda.cu sph_cudalink.cu sph_cudabuild.cu sph_cudastep.cu sph_cudapairs_single.cu sph_cudapairs_double.cu)
# Single-precision divisions and roots to 2 ulp: within the error bound of the pair sums, and much shorter.
set_source_files_properties(sph_cudapairs_single.cu PROPERTIES COMPILE_OPTIONS "-prec-div=false;-prec-sqrt=false")
set_target_properties(frond_sph_cuda PROPERTIES POSITION_INDEPENDENT_CODE ON CUDA_STANDARD 17 CUDA_STANDARD_REQUIRED ON)
target_compile_definitions(frond_sph_cuda PRIVATE FROND_HAVE_CUDA)
target_include_directories(frond_sph_cuda PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
# Not the PkgConfig target: its compiler flags are for the C compiler, nvcc rejects them.
target_include_directories(frond_sph_cuda SYSTEM PRIVATE ${PETSC_INCLUDE_DIRS} ${MPI_C_INCLUDE_DIRS})
target_compile_options(frond_sph_cuda PRIVATE -Xcompiler=-Wall,-Wextra,-fvisibility=hidden
  $<$<BOOL:${FROND_WERROR}>:-Werror=all-warnings> $<$<BOOL:${FROND_WERROR}>:-Xcompiler=-Werror>)
target_link_libraries(frond_sph_cuda INTERFACE CUDA::cudart_static stdc++)

target_compile_definitions(frond_sph PRIVATE FROND_HAVE_CUDA)
