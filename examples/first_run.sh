#!/bin/sh
# From a fresh clone on Debian 12 to the first pictures: packages, build, the cantilever in a viscous fluid, plots.
set -eu
cd "$(dirname "$0")/.."
. cmake/debian.sh

frond_install $frond_packages
frond_build build frond_app -DBUILD_TESTING=OFF
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-$(nproc)}" OMP_WAIT_POLICY="${OMP_WAIT_POLICY:-PASSIVE}" # waiting threads sleep: other programs run too
build/bin/frond run examples/cantilever_fluid.yaml -output_dir out_cantilever_fluid -output_overwrite
/usr/bin/python3 examples/plot_run.py out_cantilever_fluid
