"""Every pair loop of the fluid is turned into vectors of the full width, in each of its forms, by gcc's own report.

Usage: sph_vectorised.py COMPILER SOURCE_FOLDER INCLUDE_FOLDER... - a loop marked `omp simd` in sph_cpupairs.c must be reported as
vectorised once for each form: kernels x viscosities x two velocities x diffusion = 2 x 3 x 2 x 2 for the rates, 2 kernels for the others.
"""
import os
import re
import subprocess
import sys
import tempfile

COMPILER, ROOT, INCLUDES = sys.argv[1], sys.argv[2], [f for f in sys.argv[3:] if f]
SOURCE = os.path.join(ROOT, "src", "sph_cuda", "sph_cpupairs.c")
FORMS = {"Rates": 24}  # any other loop: 2
failed = 0

with open(SOURCE) as f:
    lines = f.read().split("\n")
loops = []  # name of the function, line of the pragma
for number, line in enumerate(lines, 1):
    if line.startswith("SPH_INLINE"):
        name = re.search(r"(\w+)\(", line).group(1)
    if "omp simd" in line:
        loops.append((name, number))
assert len(loops) >= 5, "the pair loops of sph_cpupairs.c were not found"
for march, width in (("x86-64-v3", 32), ("x86-64-v4", 64)):
    with tempfile.TemporaryDirectory() as folder:
        command = [COMPILER, "-std=gnu11", "-O3", "-fno-math-errno", "-fno-trapping-math", "-Wno-psabi", "-march=" + march, "-DSPH_PAIRS_single", "-fopenmp",
                   "-fopt-info-vec-optimized", "-c", SOURCE, "-o", os.path.join(folder, "x.o")]
        command += ["-I" + f for f in [os.path.join(ROOT, "src")] + INCLUDES]
        report = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=True).stderr
    for name, number in loops:
        found = re.findall(r"sph_cpupairs\.c:%d:\d+: optimized: +loop vectorized using %d byte vectors" % (number, width), report)
        wanted = FORMS.get(name, 2)
        print("%s, %s: %d of %d forms in vectors of %d bytes" % (march, name, len(found), wanted, width))
        if len(found) != wanted:
            failed += 1
print("%d failed" % failed)
sys.exit(1 if failed else 0)
