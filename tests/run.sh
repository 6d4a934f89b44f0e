#!/bin/sh
# Build and run the tests. Arguments go to ctest: sh tests/run.sh -L unit; the long validations: sh tests/run.sh -L validation-long
set -eu
cd "$(dirname "$0")/.."
. cmake/debian.sh

frond_install $frond_packages
frond_build build all -DBUILD_TESTING=ON
[ $# -gt 0 ] || set -- -LE validation-long
cd build
exec ctest --output-on-failure "$@"
