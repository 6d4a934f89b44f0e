#!/bin/sh
# host_headers.sh SOURCE: every public header compiles by itself, as C11 and as C++11, and all of them together, without a warning.
set -eu
source=$1
cxx=$(command -v c++ || command -v g++ || true)
[ -n "$cxx" ] || {
  echo "SKIPPED: no C++ compiler"
  exit 77
}
flags="-I$source/src -Wall -Wextra -Werror -fsyntax-only"
for folder in sph_cuda ancf_petsc rigid couple plugin; do flags="$flags -I$source/src/$folder"; done
# the headers of PETSc and MPI are not ours to warn about
system=$(pkg-config --cflags PETSc ompi 2>/dev/null || pkg-config --cflags PETSc mpi-c)
system=$(echo "$system" | sed 's/-I/-isystem /g')
headers=$(sed -n '/^install(FILES src/,/DESTINATION/p' "$source/cmake/FrondInstall.cmake" | grep -o 'src/[a-z_/]*\.h')
n=0
for header in $headers; do
  name=$(basename "$header")
  echo "#include \"$name\"" | cc -std=c11 $flags $system -x c -
  echo "#include \"$name\"" | $cxx -std=c++11 $flags $system -x c++ -
  n=$((n + 1))
done
for header in $headers; do echo "#include \"$(basename "$header")\""; done | $cxx -std=c++11 $flags $system -x c++ -
echo "$n headers compile as C11 and as C++11"
[ "$n" -ge 9 ]
