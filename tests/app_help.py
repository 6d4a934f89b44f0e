"""frond -help and -version, and README.md's option reference against them."""
import os
import re
import subprocess
import sys

import apptest

frond, source = apptest.Frond(sys.argv[1], sys.argv[2]), sys.argv[3]
check = apptest.check

rc, out, err = frond("-version")
check(rc == 0 and re.match(r"frond \d+\.\d+\.\d+ \(.*PETSc.*HDF5.*CUDA (yes|no)\)", out, re.I), "-version: %s" % out)

for args in (("-help",), ("help",), ("--help",), ()):
    rc, out, err = frond(*args)
    check(rc == 0 and not err, "frond %s: exit code %d %s" % (" ".join(args), rc, err))
    for word in ("frond run FILE", "frond check FILE", "Exit codes", "-sph_viscosity", "-beam_young", "-body_shape", "-time_end", "-ancf_ts_type", "-couple_"):
        check(word in out, "frond %s lists %s" % (" ".join(args), word))

# With a scene, the help shows the scene's values and its names.
frond.write("small.yaml", apptest.SCENE)
out = frond.runs("run", "small.yaml", "-help")
check(re.search(r"-beam_rod_young:? <.*1e\+06", out), "the scene's value of beam_rod_young is shown")
check(not os.path.exists(frond.path("out_small")), "-help runs nothing")

# Every option that the command's own sources read is in -help.
for name in re.findall(r'\{OPT_\w+, "(\w+)"', open(os.path.join(source, "src", "app", "scene.c")).read()):
    check(re.search(r"-(beam_|body_|wall_)?%s\b" % name, out), "-help lists " + name)

done = subprocess.run([sys.executable, os.path.join(source, "docs", "options.py"), frond.program, "--check"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                      universal_newlines=True, env=frond.env)
check(done.returncode == 0, "README.md's option reference: %s" % done.stdout[-1500:])
apptest.report()
