#!/usr/bin/env bash
# analyse.sh [PIECE...]: analysers, sanitizers and fuzzing of our own code; without arguments: warnings cppcheck valgrind tsan fuzz; also: tidy asan coverage.
# Builds in ANALYSE_FOLDER (default build_analyse); one line per piece says what passed. docs/testing.md explains.
set -euo pipefail
cd "$(dirname "$0")/.."
. cmake/debian.sh
folder=${ANALYSE_FOLDER:-build_analyse}
jobs=$(nproc)
frond_install clang clang-tidy cppcheck libomp-dev valgrind gcovr
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
launcher=""
if command -v ccache >/dev/null; then launcher="-DCMAKE_C_COMPILER_LAUNCHER=ccache"; fi

fail() {
  echo "FAILED: $*"
  exit 1
}

# configure NAME [options]: a build folder without CUDA and -march=native, whose instructions valgrind and other machines may not know.
configure() {
  local name=$1
  shift
  cmake -S . -B "$folder/$name" -DCMAKE_BUILD_TYPE=None -DFROND_CUDA=OFF -DFROND_NATIVE=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON $launcher "$@" >"$folder/$name.log"
}

# build NAME TARGET...
build() {
  local name=$1
  shift
  cmake --build "$folder/$name" -j "$jobs" --target "$@" >>"$folder/$name.log" 2>&1 || {
    grep -E -A 5 'warning|error|undefined' "$folder/$name.log" | head -n 60
    fail "$name: build"
  }
}

# sources FOLDER...: the C files
sources() {
  find "$@" -name '*.c' | sort
}

# The C tests with label unit, in words; not those of the device path, which have AddressSanitizer of their own.
unit_tests() {
  (cd "$folder/$1" && ctest -N -L unit -R '^test_' | awk '/Test +#/ { print $3 }' | grep -vE '_shim$|_avx2$|_baseline$|^test_cuda')
}

# -Wall -Wextra -Wconversion with clang; gcc compiles with them in .ci/run.
do_warnings() {
  configure clang -DCMAKE_C_COMPILER=clang -DFROND_WERROR=ON -DBUILD_TESTING=ON
  sed -n 's/^ *"command": "\(.*\)",$/\1/p' "$folder/clang/compile_commands.json" | grep -E ' -c .*\.c$' | sed 's/\\\(.\)/\1/g; s/ -o [^ ]* / -fsyntax-only /; s/^[^ ]*ccache //' |
    xargs -P "$jobs" -d '\n' -n 1 sh -c >"$folder/warnings.log" 2>&1 || {
    grep -E -A 5 'warning:|error:' "$folder/warnings.log" | head -n 60
    fail "warnings of clang"
  }
  echo "warnings: none by clang in $(sources src tests bench examples | wc -l) files (-Wall -Wextra -Wconversion -Werror)"
}

# invalidPointerCast: scratch memory serves for doubles, then for integers.
do_cppcheck() {
  cppcheck src $(printf -- '-I%s ' src src/*/) --enable=warning,performance,portability --inline-suppr --std=c11 -j "$jobs" -q --suppress=invalidPointerCast \
    --include=tests/analyse/cppcheck.h --error-exitcode=1 >"$folder/cppcheck.log" 2>&1 || {
    cat "$folder/cppcheck.log"
    fail "cppcheck"
  }
  echo "cppcheck: nothing in $(sources src | wc -l) files"
}

do_tidy() {
  [ -e "$folder/clang/compile_commands.json" ] || configure clang -DCMAKE_C_COMPILER=clang -DBUILD_TESTING=ON
  sources src | xargs -P "$jobs" -n 4 clang-tidy -p "$folder/clang" --quiet >"$folder/tidy.log" 2>/dev/null || {
    cat "$folder/tidy.log"
    fail "clang-tidy"
  }
  echo "clang-tidy: nothing in $(sources src | wc -l) files"
}

# A coupled scene of all parts, some steps: fluid, two linked beams, a ball, walls; a checkpoint and the restart from it.
scene() {
  cat >"$folder/scene.yaml" <<'S'
scene_name: small
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0.4]
domain_periodic: [x, y]
walls: [zmin, zmax]
beams: rod
beam_rod: {start: [0.05, 0.2, 0.2], end: [0.2, 0.2, 0.2], elements: 2, diameter: 0.06, density: 2000, young: 1e6, end0: clamp}
bodies: ball
body_ball: {shape: sphere, size: [0.06, 0, 0], density: 1000, position: [0.31, 0.2, 0.2]}
sph: {dp: 0.04, density: 1000, viscosity: 1, max_speed: 1}
time_end: 0.004
output_every: 0.002
history_every: 0.001
checkpoint_every: 0.002
S
}

# short_run COMMAND...: COMMAND (a program with its wrapper) runs the scene and restarts it.
short_run() {
  scene
  rm -rf "$folder/run" "$folder"/valgrind.*.log
  "$@" run "$folder/scene.yaml" -output_dir "$folder/run" &&
    "$@" run "$folder/scene.yaml" -output_dir "$folder/run" -restart "$(ls -d "$folder"/run/checkpoint* | head -n 1)" -time_end 0.005
}

# memcheck on a short coupled run and its restart; what Open MPI and PETSc are known to do is suppressed by lists.
do_valgrind() {
  configure gcc -DCMAKE_C_FLAGS="-O1 -g" -DBUILD_TESTING=OFF
  build gcc frond_app
  OMP_NUM_THREADS=1 short_run valgrind --error-exitcode=9 --suppressions=/usr/share/openmpi/openmpi-valgrind.supp --suppressions=tests/analyse/valgrind.supp \
    --log-file="$folder/valgrind.%p.log" "$folder/gcc/bin/frond" >"$folder/valgrind.out" 2>&1 || {
    cat "$folder/valgrind.out"
    for log in "$folder"/valgrind.*.log; do grep -B 2 -A 30 'Invalid\|uninitialised\|ERROR SUMMARY' "$log" | head -n 60; done
    fail "valgrind"
  }
  echo "valgrind: $(grep -h 'ERROR SUMMARY' "$folder"/valgrind.*.log | awk '{ errors += $4; runs++ } END { printf "%d errors in %d processes (a run and its restart)", errors, runs }')"
}

# run_all LOG SECONDS PROGRAM...: two at a time, one thread each unless OMP_NUM_THREADS says otherwise; the failed ones are named in LOG.
run_all() {
  local log=$1 limit=$2
  shift 2
  rm -f "$log" "$log".*.out
  printf '%s\n' "$@" | LOG="$log" LIMIT="$limit" xargs -P "$jobs" -n 1 sh -c \
    'timeout "$LIMIT" "$0" >"$LOG.$(basename "$0").out" 2>&1 || { echo "$(basename "$0"): exit code $?"; tail -n 40 "$LOG.$(basename "$0").out"; }' >"$log" 2>&1
}

# One build for asan and fuzz: libFuzzer's targets and the tests.
configure_asan() {
  configure asan -DCMAKE_C_COMPILER=clang -DCMAKE_C_FLAGS="-O1" -DFROND_FUZZ=ON -DBUILD_TESTING=ON
}

# AddressSanitizer and UndefinedBehaviorSanitizer: the C unit tests, a coupled run and its restart. Leaks are not looked for: Open MPI has many.
do_asan() {
  local tests n
  configure_asan
  tests=$(unit_tests asan)
  n=$(echo "$tests" | wc -l)
  build asan frond_app $tests
  export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 OMP_NUM_THREADS=1
  run_all "$folder/asan.tests" 600 $(printf "$folder/asan/tests/%s " $tests)
  [ ! -s "$folder/asan.tests" ] || { cat "$folder/asan.tests"; fail "asan"; }
  short_run "$folder/asan/bin/frond" >"$folder/asan.run" 2>&1 || { tail -n 60 "$folder/asan.run"; fail "asan: frond run"; }
  unset ASAN_OPTIONS UBSAN_OPTIONS OMP_NUM_THREADS
  echo "asan: no report of AddressSanitizer and UndefinedBehaviorSanitizer in $n unit tests, a run and its restart"
}

# Some seconds of each fuzz target from the committed corpus.
do_fuzz() {
  configure_asan
  sh tests/fuzz/run.sh "$folder/fuzz" "${FUZZ_SECONDS:-4}" "$folder/asan" >"$folder/fuzz.out" || { cat "$folder/fuzz.out"; fail "fuzz"; }
  echo "fuzz: $(awk '{ printf "%s%s", (NR > 1 ? "; " : ""), $0 }' "$folder/fuzz.out")"
}

# ThreadSanitizer with Archer, which tells it of OpenMP's barriers: a coupled run with two threads.
do_tsan() {
  local archer
  archer=$(ls /usr/lib/llvm-*/lib/libarcher.so 2>/dev/null | sort -V | tail -n 1)
  [ -n "$archer" ] || fail "tsan: no libarcher.so (Debian: libomp-dev)"
  configure tsan -DCMAKE_C_COMPILER=clang -DCMAKE_C_FLAGS="-O1" -DFROND_SANITIZE=thread -DBUILD_TESTING=OFF
  build tsan frond_app
  export OMP_TOOL_LIBRARIES=$archer TSAN_OPTIONS=ignore_noninstrumented_modules=1:exitcode=66 OMP_NUM_THREADS=2
  short_run "$folder/tsan/bin/frond" >"$folder/tsan.run" 2>&1 || { head -n 100 "$folder/tsan.run"; fail "tsan"; }
  unset OMP_TOOL_LIBRARIES TSAN_OPTIONS OMP_NUM_THREADS
  echo "tsan: no race in a run with two threads and its restart"
}

# Lines and branches of src that the C unit tests, some tests of the command and a restart reach; tests fail elsewhere, here they only count.
do_coverage() {
  local tests name
  configure coverage -DCMAKE_C_FLAGS="--coverage -O1 -g" -DBUILD_TESTING=ON
  tests=$(unit_tests coverage)
  build coverage frond_app $tests
  find "$folder/coverage" -name '*.gcda' -delete
  export OMP_NUM_THREADS=1
  for name in run mesh probes sections motion links help; do
    printf '#!/bin/sh\nexec /usr/bin/python3 %s %s %s %s\n' "$PWD/tests/app_$name.py" "$folder/coverage/bin/frond" "$folder/coverage/app_$name" "$PWD" >"$folder/coverage/app_$name.sh"
    chmod +x "$folder/coverage/app_$name.sh"
  done
  run_all "$folder/coverage.tests" 300 $(printf "$folder/coverage/tests/%s " $tests) "$folder"/coverage/app_*.sh
  short_run "$folder/coverage/bin/frond" >"$folder/coverage.run" 2>&1 || true
  unset OMP_NUM_THREADS
  gcovr -r . --filter src/ "$folder/coverage" -j "$jobs" --exclude-unreachable-branches --json "$folder/coverage.json" 2>"$folder/coverage.gcovr" >&2 || {
    tail -n 20 "$folder/coverage.gcovr"
    fail "gcovr"
  }
  python3 tests/analyse/coverage.py "$folder/coverage.json" "$folder/coverage.txt" 90 >"$folder/coverage.sum" || fail "coverage of lines below 90 %: $(cat "$folder/coverage.sum")"
  echo "coverage: $(cat "$folder/coverage.sum")"
  echo "(what is not reached: $folder/coverage.txt)"
}

[ $# -gt 0 ] || set -- warnings cppcheck valgrind tsan fuzz
for piece in "$@"; do
  seconds=$SECONDS
  "do_$piece"
  echo "($piece: $((SECONDS - seconds)) s)"
done
