#!/bin/sh
# host_plugin.sh LIBRARY FOLDER: a stock PETSc example (KSP tutorial ex1 of Debian's libpetsc3.18-dev-examples, a tridiagonal system),
# unchanged and not linked with Frond, solves with PCBLOCKTRI after -dll_append LIBRARY.
set -eu
library=$1 folder=$2
source=$(ls /usr/share/petsc/*/share/petsc/examples/src/ksp/ksp/tutorials/ex1.c 2>/dev/null | head -n 1)
[ -n "$source" ] || {
  echo "SKIPPED: no PETSc examples here (Debian: libpetsc3.18-dev-examples)"
  exit 77
}
mkdir -p "$folder"
cc -w "$source" $(pkg-config --cflags --libs PETSc) $(pkg-config --cflags --libs ompi 2>/dev/null || pkg-config --cflags --libs mpi-c) -lm -o "$folder/ex1"
if ldd "$folder/ex1" | grep -q frond; then
  echo "FAILED: the example is linked with Frond"
  exit 1
fi

echo "== without the plugin"
if "$folder/ex1" -ksp_type preonly -pc_type blocktri >"$folder/without" 2>&1; then
  echo "FAILED: PCBLOCKTRI is known without the plugin"
  exit 1
fi
grep -m 1 -i "unknown type" "$folder/without"

echo "== with it"
for n in 10 1000; do
  "$folder/ex1" -dll_append "$library" -n $n -ksp_type preonly -pc_type blocktri -ksp_view >"$folder/with"
  grep -E "type: blocktri|Norm of error" "$folder/with"
  grep -q "type: blocktri" "$folder/with"
  # The condition number of the n x n Laplacian is about 0.4 n^2: the error of an exact elimination is within n^2 eps |u|, u = 1.
  awk -v n=$n '/Norm of error/ { sub(/.*error */, ""); sub(/,.*/, ""); e = $0 + 0; found = 1 } END { exit !(found && e <= n * n * 2.3e-16 * sqrt(n)) }' "$folder/with" || {
    echo "FAILED: the error is not round-off"
    exit 1
  }
done
