#!/bin/sh
# cuda_resources.sh - registers, spills and stack of every kernel of the fluid, per architecture, as a table (Markdown).
#
#   bench/cuda_resources.sh [sm_75 sm_80 sm_90]      needs nvcc (or CUDACXX), pkg-config PETSc and mpicc
set -eu
cd "$(dirname "$0")/../src/sph_cuda"
nvcc=${CUDACXX:-nvcc}
include=$( (pkg-config --cflags-only-I PETSc; mpicc --showme:compile 2>/dev/null || mpicc -compile_info) | tr ' ' '\n' | sed -n 's/^-I/-isystem /p' | tr '\n' ' ')
"$nvcc" --version | sed -n 's/^Cuda compilation tools, //p'
echo
echo "| architecture | file | kernel | registers | stack (B) | spill stores (B) | spill loads (B) |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
for arch in "${@:-sm_75}"; do
  for file in sph_cuda.cu sph_cudalink.cu sph_cudabuild.cu sph_cudastep.cu sph_cudapairs_single.cu sph_cudapairs_double.cu; do
    flags=
    if [ "$file" = sph_cudapairs_single.cu ]; then flags="-prec-div=false -prec-sqrt=false"; fi # as src/sph_cuda/cuda.cmake
    # shellcheck disable=SC2086
    "$nvcc" -std=c++17 -Wno-deprecated-gpu-targets -arch="$arch" -Xptxas -v $flags -I. -I.. $include -c "$file" -o /dev/null 2>&1 | c++filt |
      awk -v arch="$arch" -v file="$file" '
        /Compiling entry function/ { name = $0; sub(/^[^\047]*\047/, "", name); sub(/\047.*/, "", name); sub(/^void /, "", name); sub(/\(.*/, "", name) }
        /bytes stack frame/ { stack = $1; stores = $5; loads = $9 }
        /Used [0-9]+ registers/ { for (i = 1; i < NF; i++) if ($i == "Used") regs = $(i + 1)
          if (name !~ /^cub::|EmptyKernel|thrust/) printf "| %s | %s | %s | %s | %s | %s | %s |\n", arch, file, name, regs, stack, stores, loads }'
  done
done
