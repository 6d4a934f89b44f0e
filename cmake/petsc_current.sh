#!/bin/sh
# petsc_current.sh [FOLDER]: the current PETSc release, from its source package on PyPI, into FOLDER (default build_petsc), then Frond
# against it and Frond's unit tests. A quarter of an hour on two cores; not part of the default checks. PETSC_VERSION=3.22.0 asks for a
# certain release, JOBS for the number of compilers.
set -eu
cd "$(dirname "$0")/.."
folder=${1:-build_petsc}
jobs=${JOBS:-$(nproc)}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
prefix=$folder/install

if [ ! -e "$prefix/lib/pkgconfig/PETSc.pc" ]; then
  ls "$folder"/petsc-*.tar.gz >/dev/null 2>&1 ||
    python3 -m pip download --quiet --no-deps --no-binary :all: --dest "$folder" "petsc${PETSC_VERSION:+==$PETSC_VERSION}"
  archive=$(ls -t "$folder"/petsc-*.tar.gz | head -n 1)
  rm -rf "$folder/source"
  mkdir "$folder/source"
  tar -xzf "$archive" -C "$folder/source" --strip-components 1
  cd "$folder/source"
  unset PETSC_DIR PETSC_ARCH
  # The options that Debian's package has and that Frond needs.
  ./configure PETSC_ARCH=frond --prefix="$prefix" --with-debugging=0 --with-shared-libraries=1 --with-fc=0 --with-x=0 \
    --with-cc=mpicc --with-cxx=mpicxx --COPTFLAGS=-O2 --CXXOPTFLAGS=-O2 --with-hwloc=0 >"$folder/configure.log" 2>&1 || {
    tail -n 40 "$folder/configure.log"
    exit 1
  }
  make -j "$jobs" PETSC_DIR="$PWD" PETSC_ARCH=frond all >"$folder/make.log" 2>&1 || {
    tail -n 40 "$folder/make.log"
    exit 1
  }
  make PETSC_DIR="$PWD" PETSC_ARCH=frond install >>"$folder/make.log" 2>&1
  cd - >/dev/null
fi

PKG_CONFIG_PATH=$prefix/lib/pkgconfig
LD_LIBRARY_PATH=$prefix/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export PKG_CONFIG_PATH LD_LIBRARY_PATH
echo "PETSc $(pkg-config --modversion PETSc)"
cmake -S . -B "$folder/frond" -DCMAKE_BUILD_TYPE=Release -DFROND_CUDA=OFF -DBUILD_TESTING=ON >"$folder/frond.log"
cmake --build "$folder/frond" -j "$jobs" >>"$folder/frond.log" 2>&1 || {
  grep -E "error|FAILED" "$folder/frond.log" | head -n 40
  exit 1
}
cd "$folder/frond"
ctest -L unit --output-on-failure
