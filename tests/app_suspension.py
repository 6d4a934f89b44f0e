"""The suspension in a step pipe of examples/: no overlap, no leak, momentum closed, the same flow in both parts. Arguments of
make_suspension.py and the end of the run, s, may follow: a finer or longer one."""
import csv
import os
import subprocess
import sys

import apptest

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

frond, examples = apptest.Frond(sys.argv[1], sys.argv[2]), os.path.join(sys.argv[3], "examples")
check, near = apptest.check, apptest.near
end = float(sys.argv[4]) if len(sys.argv) > 4 else 0.03
make = [sys.executable, os.path.join(examples, "make_suspension.py")]
text = open(os.path.join(examples, "suspension_pipe.yaml")).read()
made = subprocess.run(make + sys.argv[5:], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
if len(sys.argv) <= 5:
    check([w for line in made.splitlines() if "position" not in line for w in line.split()] ==
          [w for line in text.splitlines() if "position" not in line for w in line.split()], "suspension_pipe.yaml is not what make_suspension.py makes")
else:
    text = made
frond.write("scene.yaml", text)
value = {line.split(":")[0].strip(): line.split(":", 1)[1].strip() for line in text.splitlines() if ":" in line and not line.startswith("#")}
dp, a, length = float(value["dp"]), 0.002, float(value["end"][1:].split(",")[0])
wide, narrow, step, back = (float(value[k]) for k in ("radius", "radius2", "step", "back"))
frond.runs("run", "scene.yaml", "-output_dir", "out", "-time_end", str(end), "-output_every", str(end), "-history_every", str(end / 20), "-sph_precision",
           "double", "-progress_every", "0", timeout=7000)


def gap(x):
    """Distance from the pipe's wall, in the pipe > 0: the least distance to its outline in the plane of axis and radius."""
    s, r = x[:, 0] % length, np.hypot(x[:, 1], x[:, 2])
    best = np.full(len(s), np.inf)
    for s0, s1, r0, r1 in ((0, step, wide, wide), (step, step, narrow, wide), (step, back, narrow, narrow), (back, back, narrow, wide), (back, length, wide, wide)):
        for shift in (-length, 0, length):
            best = np.minimum(best, np.hypot(s + shift - np.clip(s + shift, s0, s1), r - np.clip(r, r0, r1)))
    inside = r < np.where((s < step) | (s > back), wide, narrow)
    return np.where(inside, best, -best)


with h5py.File(frond.path("out", "frame_00001.h5")) as h:
    x, v, group = h["markers/position"][:], h["markers/velocity"][:].astype(float), h["markers/group"][:]
with open(frond.path("out", "history.csv"), newline="") as f:
    rows = list(csv.DictReader(f))
names = [k[:-5] for k in rows[0] if k.endswith("_x[m]")]
centre = np.array([[float(rows[-1]["%s_%s[m]" % (n, k)]) for k in "xyz"] for n in names])
check(len(centre) == text.count("position:"), "%d spheres in the history" % len(centre))
d = centre[:, None] - centre[None]
d[..., 0] -= length * np.round(d[..., 0] / length)
r = np.linalg.norm(d, axis=2) + 9 * np.eye(len(centre))
print("%d spheres after %g s: gap to one another at least %.2g m, to the wall %.2g m (roughness %.2g m)" %
      (len(centre), end, r.min() - 2 * a, gap(centre).min() - a, 0.02 * a))
check(r.min() > 2 * a, "two spheres overlap by %g m" % (2 * a - r.min()))
check(gap(centre).min() > a, "a sphere overlaps the wall by %g m" % (a - gap(centre).min()))

fluid = x[group == -1]
apart = fluid[:, None] - centre[None]
apart[..., 0] -= length * np.round(apart[..., 0] / length)
depth = a - np.linalg.norm(apart, axis=2).min(axis=1)
print("fluid: at most %.2f dp in the wall, %.2f dp in a sphere" % (-gap(fluid).min() / dp, depth.max() / dp))
check(len(fluid) == np.sum(group < 0), "%d markers left" % np.sum(group < -1))
check(gap(fluid).min() > -dp / 2, "a fluid marker is %g dp in the wall" % (-gap(fluid).min() / dp))
check(depth.max() < dp / 2, "a fluid marker is %g dp in a sphere" % (depth.max() / dp))

# In double precision the momentum balances to the round-off of some 1e4 markers' sums over some hundred steps.
last = rows[-1]
residual = max(abs(float(last["momentum_residual_%s[kg m/s]" % k])) for k in "xyz")
momentum = sum(abs(float(last[k])) for k in last if k.startswith("fluid_momentum"))
print("momentum: residual %.1e of %.1e kg m/s" % (residual, momentum))
check(residual < 1e-9 * momentum, "momentum: residual %g of %g kg m/s" % (residual, momentum))

# Flow of fluid and spheres together: the same in both parts once sound (2 m/s) has gone through the pipe ten times; their ends are
# known to dp/2 each, and 0.02 are allowed for waves (of order of the Mach number 0.1, squared and of either sign in both parts).
volume = np.where(group == -1, dp**3, 0.0)
moved = np.abs(v).sum(axis=1) > 0
for g in np.unique(group[group >= 0]):
    own = group == g
    if moved[own].any():
        volume[own] = 4 / 3 * np.pi * a**3 / own.sum()
inwide = (x[:, 0] % length < step) | (x[:, 0] % length > back)
part = back - step, length - (back - step)
flow = [np.sum((volume * v[:, 0])[sel]) / L for sel, L in ((~inwide, part[0]), (inwide, part[1]))]
print("flow: %.4g m^3/s in the narrow part, %.4g in the wide one" % tuple(flow))
if end > 10 * length / 2:
    near(flow[1] / flow[0], 1, dp / min(part) + 0.02, "flow of the wide part over that of the narrow one")
apptest.report()
