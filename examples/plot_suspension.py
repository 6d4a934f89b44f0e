#!/usr/bin/env python3
"""Pictures of a run of suspension_pipe.yaml: plot_suspension.py [out_suspension_pipe]

Mid-plane as in Fig. 8a of the paper (left half: spheres only; right half: fluid by its speed, too), volume fraction of the spheres and
mean velocities along the pipe, and the mean velocities over time. Needs numpy, h5py and matplotlib.
"""
import csv
import glob
import os
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "out_suspension_pipe"
settings = dict(line.strip().lstrip("-").replace(": ", " ").split(None, 1) for line in open(os.path.join(folder, "settings.txt")) if line.startswith("-") and " " in line)


def option(name):
    return [float(w) for w in settings[name].replace(",", " ").split()]


radius = option("body_size")[0]
wide, narrow, step, back = (option("region_pipe_" + k)[0] for k in ("radius", "radius2", "step", "back"))
length = option("region_pipe_end")[0]
with open(os.path.join(folder, "history.csv"), newline="") as f:
    rows = list(csv.DictReader(f))
names = [k[:-5] for k in rows[0] if k.endswith("_x[m]")]
time = np.array([float(r["time[s]"]) for r in rows])
centre = np.array([[[float(r["%s_%s[m]" % (n, k)]) for k in "xyz"] for n in names] for r in rows])
with h5py.File(sorted(glob.glob(os.path.join(folder, "frame_*.h5")))[-1]) as h:
    x, v, group = h["markers/position"][:], h["markers/velocity"][:], h["markers/group"][:]
    at = float(h.attrs["time"])
fluid = group == -1
last = centre[int(np.argmin(np.abs(time - at)))].copy()
last[:, 0] %= length

fig, (flow, along, over) = plt.subplots(3, 1, figsize=(9, 10), gridspec_kw={"height_ratios": [2, 1, 1]})
mm = 1e3
outline = np.array([[0, wide], [step, wide], [step, narrow], [back, narrow], [back, wide], [length, wide]]) * mm
for side in (1, -1):
    flow.plot(outline[:, 0], side * outline[:, 1], "k")
thin = fluid & (np.abs(x[:, 2]) < 0.25 * radius) & (x[:, 0] > length / 2)
dots = flow.scatter(x[thin, 0] * mm, x[thin, 1] * mm, 6, v[thin, 0], cmap="viridis")
fig.colorbar(dots, ax=flow, label="fluid, $v_x$ in m/s")
for p in last:
    if abs(p[2]) < radius or p[0] < length / 2:
        cut = radius if p[0] < length / 2 else np.sqrt(radius**2 - p[2] ** 2)
        flow.add_patch(plt.Circle((p[0] * mm, p[1] * mm), cut * mm, fc="0.8", ec="0.3", lw=0.5))
flow.set(aspect="equal", xlabel="x in mm", ylabel="y in mm", title="%d spheres, t = %g s" % (len(names), at))

bins = np.linspace(0, length, 21)
mid = (bins[1:] + bins[:-1]) / 2
offset = radius * np.linspace(-1, 1, 41)  # slices of a sphere: their volumes over the bins
share = np.diff(np.concatenate([[0], np.cumsum(1 - (offset / radius) ** 2)]))
where = (last[:, 0][:, None] + offset) % length
spheres = np.histogram(where, bins, weights=np.broadcast_to(share / share.sum(), where.shape))[0] * 4 / 3 * np.pi * radius**3
area = np.pi * np.where((mid < step) | (mid > back), wide, narrow) ** 2
along.step(mid * mm, spheres / (area * np.diff(bins)), where="mid", label="volume fraction of the spheres")
speed = np.histogram(x[fluid, 0], bins, weights=v[fluid, 0])[0] / np.maximum(np.histogram(x[fluid, 0], bins)[0], 1)
along.plot(mid * mm, speed / speed.max(), "o-", label="mean velocity of the fluid over %.3g m/s" % speed.max())
along.set(xlabel="x in mm", ylim=(0, 1.05))
along.legend()

for label, inside in (("wide part", lambda s: (s < step) | (s > back)), ("narrow part", lambda s: (s >= step) & (s <= back))):
    s, dx = centre[:-1, :, 0] % length, np.diff(centre[:, :, 0], axis=0) / np.diff(time)[:, None]
    over.plot(time[1:], np.nanmean(np.where(inside(s), dx, np.nan), axis=1), label="spheres in the " + label)
over.set(xlabel="time in s", ylabel="mean $v_x$ in m/s")
over.legend()
fig.tight_layout()
fig.savefig("suspension_pipe.png", dpi=150)
print("suspension_pipe.png: volume fraction %.3g in the narrow part, %.3g in the wide one" %
      tuple(4 / 3 * np.pi * radius**3 * np.sum(sel) / (np.pi * R**2 * L) for sel, R, L in (
          ((last[:, 0] > step) & (last[:, 0] < back), narrow, back - step), ((last[:, 0] <= step) | (last[:, 0] >= back), wide, length - back + step))))
