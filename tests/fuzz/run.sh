#!/bin/sh
# run.sh FOLDER [SECONDS [BUILD]]: build the fuzz targets with clang in FOLDER (or take the build folder BUILD, configured with FROND_FUZZ), and run
# each for SECONDS (default 5) from its corpus here and from what earlier runs left in FOLDER/found; prints the executions. Fails on a crash, a
# sanitizer's report, or an input that takes over 20 s.
# 77: no clang with libFuzzer or no OpenMP for it (Debian: clang, libomp-dev).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
seconds=${2:-5}
printf 'int LLVMFuzzerTestOneInput(const char *p, unsigned long n);\nint LLVMFuzzerTestOneInput(const char *p, unsigned long n)\n{\n  return n && p[0] == 1;\n}\n' >"$folder/try.c"
clang -fopenmp -fsanitize=fuzzer,address,undefined "$folder/try.c" -o "$folder/try" 2>/dev/null || {
  echo "SKIPPED: no clang with libFuzzer and OpenMP (Debian: clang, libomp-dev)"
  exit 77
}
build=${3:-$folder/build}
if [ $# -lt 3 ]; then
  launcher=""
  if command -v ccache >/dev/null; then launcher=-DCMAKE_C_COMPILER_LAUNCHER=ccache; fi
  cmake -S "$here/../.." -B "$build" -DCMAKE_C_COMPILER=clang $launcher -DCMAKE_BUILD_TYPE=Release -DFROND_FUZZ=ON -DFROND_CUDA=OFF -DFROND_NATIVE=OFF \
    -DBUILD_TESTING=OFF >"$folder/cmake.log"
fi
cmake --build "$build" --target frond_fuzz -j "$(nproc)" >"$folder/build.log" 2>&1 || {
  grep -E "error|undefined" "$folder/build.log" | head -n 20
  exit 1
}
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16 UBSAN_OPTIONS=print_stacktrace=1 OMP_NUM_THREADS=1
all=0
# PETSc loses what libyaml holds of a file that is no YAML (150 kB each): scenes are read by a new process every 3000 inputs.
for target in scene mesh table checkpoint payload history; do
  mkdir -p "$folder/found/$target"
  until=$(($(date +%s) + seconds)) n=0 runs=-1
  if [ $target = scene ]; then runs=3000; fi
  while left=$((until - $(date +%s))) && [ $left -gt 0 ]; do
    "$build/tests/fuzz/fuzz_$target" -max_total_time=$left -runs=$runs -timeout=20 -rss_limit_mb=3000 -max_len=4096 -close_fd_mask=1 \
      -print_final_stats=1 -dict="$here/$target.dict" -artifact_prefix="$folder/bad_$target-" "$folder/found/$target" "$here/corpus/$target" \
      >"$folder/$target.log" 2>&1 || {
      tail -n 40 "$folder/$target.log"
      echo "$target: FAILED, the input is $folder/bad_$target-*"
      exit 1
    }
    n=$((n + $(sed -n 's/stat::number_of_executed_units: *//p' "$folder/$target.log")))
  done
  echo "$target: $n executions"
  all=$((all + n))
done
echo "$all executions, no crash, hang or report"
