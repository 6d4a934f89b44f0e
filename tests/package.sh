#!/bin/sh
# package.sh BUILD SOURCE FOLDER: install BUILD into FOLDER, then build a project outside of this one against it, by CMake's
# find_package(Frond) and by pkg-config, and run it.
set -eu
build=$1 source=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
cmake --install "$build" --prefix "$folder/prefix" >"$folder/install.log"

fail() {
  echo "FAILED: $*"
  exit 1
}

echo "== installed command"
"$folder/prefix/bin/frond" -version
"$folder/prefix/bin/frond" check "$folder/prefix/share/frond/examples/beam_vacuum.yaml"
if readelf -d "$folder/prefix/bin/frond" | grep -E 'R(UN)?PATH' | grep -q "$build"; then fail "the installed command looks into the build folder"; fi
readelf -d "$folder"/prefix/lib*/libfrond.so "$folder"/prefix/lib*/*/libfrond.so 2>/dev/null | grep -q 'SONAME.*libfrond\.so\.[0-9]' || fail "libfrond.so has no versioned soname"

echo "== symbols"
library=$(find "$folder/prefix" -name libfrond.so)
strange=$(nm -D --defined-only "$library" | awk '{ print $3 }' | grep -vE '^(Sph|Ancf|Rigid|Couple|Frond|ShortRange|PCBlockTri|MatBlockTri|PetscDLLibraryRegister|_edata$|_end$|__bss_start$)' || true)
[ -z "$strange" ] || fail "symbols visible that are not Frond's:" $strange
# Our code ends no program and prints nothing by itself: it goes through the viewers of PETSc, which the caller gives it. Asked of
# the objects that the library is made of: the CUDA runtime, which is linked into it, calls fwrite.
called=$(find "$build/src" -name '*.o' ! -path '*/frond_app.dir/*' -exec nm -u {} + | awk '/ U / { print $2 }' |
  grep -E '^(_?exit|abort|quick_exit|v?printf|__printf_chk|puts|putchar|fputs|fwrite)(@|$)' || true)
[ -z "$called" ] || fail "the library calls" $called

echo "== find_package(Frond)"
cp -r "$source/tests/outside" "$folder/project"
cmake -S "$folder/project" -B "$folder/project/build" -DCMAKE_PREFIX_PATH="$folder/prefix" >"$folder/cmake.log"
cmake --build "$folder/project/build" >>"$folder/cmake.log"
"$folder/project/build/outside"
"$folder/project/build/outside_cxx"

echo "== pkg-config frond"
pc=$(dirname "$(find "$folder/prefix" -name frond.pc)")
PKG_CONFIG_PATH="$pc${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
export PKG_CONFIG_PATH
version=$(pkg-config --modversion frond)
cc -Wall "$folder/project/outside.c" $(pkg-config --cflags --libs frond) -lm -o "$folder/outside_pc"
LD_LIBRARY_PATH=$(pkg-config --variable=libdir frond)${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} "$folder/outside_pc"

echo "== every header alone"
for header in "$folder"/prefix/include/frond/*.h; do
  echo "#include <frond/$(basename "$header")>" >"$folder/one.c"
  cc -Wall -Werror -c "$folder/one.c" $(pkg-config --cflags frond) -o "$folder/one.o" || fail "$(basename "$header") does not stand alone"
done
echo "PASSED: frond $version"
