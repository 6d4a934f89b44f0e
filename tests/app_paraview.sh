#!/bin/sh
# app_paraview.sh FROND FOLDER SOURCE: a small run, then ParaView's own reader on it; 77 (skipped) where there is no pvpython.
set -eu
command -v pvpython >/dev/null || { echo "SKIPPED: no pvpython (Debian: paraview, python3-paraview)"; exit 77; }
rm -rf "$2"
mkdir -p "$2"
cd "$2"
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$3" /usr/bin/python3 -c 'import apptest; print(apptest.SCENE)' >small.yaml
"$1" run small.yaml -output_dir run -progress_every 0
exec pvpython --force-offscreen-rendering "$3/app_paraview.py" run
