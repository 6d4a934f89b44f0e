#!/usr/bin/env python3
"""Scene of a dense suspension of spheres that flows through a pipe with a step, periodic along it (Fig. 8a of the paper).

    make_suspension.py > suspension_pipe.yaml                                       the example, coarse: 2 spacings in a radius
    make_suspension.py --dp 0.0005 --time 1 > suspension_fine.yaml                  4 spacings
    make_suspension.py --dp 0.0005 --scale 2 --time 1 > suspension_large.yaml       8 times as many spheres

The spheres are placed at random and pushed apart until none touches another or the wall. Needs numpy.
"""
import argparse
import sys

import numpy as np

arg = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arg.add_argument("--dp", type=float, default=0.001, help="spacing of markers, m")
arg.add_argument("--fraction", type=float, default=0.25, help="volume of the spheres over that of the pipe")
arg.add_argument("--scale", type=int, default=1, help="the pipe's size over that of the example; the spheres stay")
arg.add_argument("--time", type=float, default=0.1, help="end of the run, s")
arg.add_argument("--seed", type=int, default=8)
args = arg.parse_args()

a, dp = 0.002, args.dp
wide, narrow, length = 0.010 * args.scale, 0.006 * args.scale, 0.040 * args.scale
step, back = length / 4, 3 * length / 4
viscosity, density, force = 0.05, 1000.0, 2.0
gap = 0.1 * a  # at the start, to one another and to the wall
volume = np.pi * (wide**2 + narrow**2) * length / 2
n = int(args.fraction * volume / (4 / 3 * np.pi * a**3))
random = np.random.default_rng(args.seed)


def into_pipe(x):
    """Move centres to where a sphere and its gap fit: the nearest such place, radially or along the axis."""
    keep = a + gap
    x[:, 0] %= length
    r = np.hypot(x[:, 1], x[:, 2])
    R = np.where((x[:, 0] < step) | (x[:, 0] > back), wide, narrow)
    # in the wide part near the steps: round the edge of the narrow one
    for face, side in ((step, -1), (back, 1)):
        away = side * (x[:, 0] - face)
        beside = (away >= 0) & (away < keep) & (r > narrow - keep)
        flat = beside & (r >= narrow)
        x[flat, 0] += side * (keep - away[flat])
        edge = beside & (r < narrow)
        d = np.hypot(away, narrow - r)
        close = edge & (d < keep)
        grow = np.where(close, (narrow - (narrow - r) * keep / np.maximum(d, 1e-12)) / np.maximum(r, 1e-12), 1)
        x[close, 0] += side * (away * (keep / np.maximum(d, 1e-12) - 1))[close]
        x[close, 1:] *= grow[close, None]
    r = np.hypot(x[:, 1], x[:, 2])
    most = np.where((x[:, 0] < step) | (x[:, 0] > back), wide, narrow) - keep
    out = r > most
    x[out, 1:] *= (most[out] / r[out])[:, None]


def apart(x):
    """Push pairs that are too near half way apart each; the largest overlap."""
    d = x[:, None, :] - x[None, :, :]
    d[:, :, 0] -= length * np.round(d[:, :, 0] / length)
    r = np.linalg.norm(d, axis=2)
    np.fill_diagonal(r, 1)
    over = np.maximum(2 * a + gap - r, 0)
    x += 0.55 * np.einsum("ij,ijk->ik", over / np.maximum(r, 1e-9), d)
    return over.max()


x = np.column_stack([random.uniform(0, length, n), random.uniform(-narrow, narrow, n) / 2, random.uniform(-narrow, narrow, n) / 2])
part = random.uniform(0, wide**2 + narrow**2, n) < wide**2  # as many per volume in both parts
x[:, 0] = np.where(part, back + random.uniform(0, length / 2, n), step + random.uniform(0, length / 2, n))
angle, R = random.uniform(0, 2 * np.pi, n), np.where(part, wide, narrow) - a
radius = R * np.sqrt(random.uniform(0, 1, n))
x[:, 1], x[:, 2] = radius * np.cos(angle), radius * np.sin(angle)
for sweep in range(20000):
    into_pipe(x)
    if apart(x.copy()) < 0.5 * gap:
        break
    apart(x)
else:
    sys.exit("make_suspension.py: %d spheres do not fit; choose a lower --fraction" % n)

wall = np.ceil(wide / dp + 0.5) * dp
print("""# A dense suspension of spheres that flows through a pipe with a step, as in Fig. 8a of the paper, whose figures are not given there.
# Made by make_suspension.py: %d neutrally buoyant spheres of radius %g m, %.3g of the volume; %.2g spacings in a radius.
# frond run %s.yaml; plot_suspension.py draws it.
# Periodic along x; the force per mass acts on fluid and spheres alike, as a pressure gradient would.
domain_lo: [0, %.10g, %.10g]
domain_hi: [%.10g, %.10g, %.10g]
domain_periodic: x
regions: pipe
region_pipe:
  shape: pipe
  start: [0, 0, 0]
  end: [%.10g, 0, 0]
  radius: %.10g
  radius2: %.10g
  step: %.10g
  back: %.10g

sph:
  dp: %.10g
  density: %g
  viscosity: %g
  max_speed: 0.2
  body_force: [%g, 0, 0]

rigid:
  lubrication_viscosity: %g
  lubrication_cutoff: %.10g
  roughness: %.10g
  contact_modulus: 1e6

time_end: %g
output_every: %g
history_every: %g

body:
  shape: sphere
  motion: free
  size: [%g, 0, 0]
  density: %g
  gravity: [%g, 0, 0]""" % (n, a, n * 4 / 3 * np.pi * a**3 / volume, a / dp, "suspension_pipe", -wall, -wall, length, wall, wall, length, wide, narrow, step,
                             back, dp, density, viscosity, force, viscosity, dp, 0.02 * a, args.time, args.time / 10, args.time / 100, a, density, force))
print("bodies: [%s]" % ", ".join("b%d" % i for i in range(n)))
for i, p in enumerate(x):
    print("body_b%d: {position: [%.6f, %.6f, %.6f]}" % (i, *p))
