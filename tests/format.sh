#!/bin/sh
# format.sh SOURCE: the C files are formatted as .clang-format says; 77 (skipped) where there is no clang-format.
set -eu
command -v clang-format >/dev/null || { echo "SKIPPED: no clang-format"; exit 77; }
cd "$1"
find src tests bench examples -name '*.[ch]' | sort | xargs clang-format --dry-run --Werror
