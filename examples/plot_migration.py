#!/usr/bin/env python3
"""Runs of migration_pipe.yaml: radius of the sphere over time, and its drift over the radius, which vanishes where it stays.

plot_migration.py RUN_DIR ... [PICTURE.png]. Times before 4 s are left out of the drift: the flow comes up with 1/(5.78 nu/R^2) = 1.7 s.
"""
import csv
import math
import os
import sys


def path(folder):
    """Times (s) and distances of the first body's centre from the axis (m)."""
    with open(os.path.join(folder, "history.csv"), newline="") as f:
        rows = list(csv.DictReader(f))
    stem = next(k for k in rows[0] if k.endswith("_y[m]"))[:-5]
    return [float(r["time[s]"]) for r in rows], [math.hypot(float(r[stem + "_y[m]"]), float(r[stem + "_z[m]"])) for r in rows]


def line(x, y):
    """Least squares: mean of x, value there, slope."""
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return mx, my, sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def drift(folder, begin=4):
    """Mean radius (m) and drift (m/s) after `begin` (s)."""
    late = [(t, r) for t, r in zip(*path(folder)) if t > begin]
    _, radius, rate = line(*zip(*late))
    return radius, rate


def main():
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    folders = [a for a in sys.argv[1:] if not a.endswith(".png")]
    picture = ([a for a in sys.argv[1:] if a.endswith(".png")] + ["migration.png"])[0]
    fig, (over, rates) = plt.subplots(1, 2, figsize=(10, 4))
    found = []
    for folder in folders:
        over.plot(*path(folder))
        found.append(drift(folder))
        rates.plot(*found[-1], "o")
        print("%s: %.4f m from the axis, drift %+.2e m/s" % (folder, *found[-1]))
    if len(found) > 1:
        radius, mean, slope = line(*zip(*found))
        ends = [min(r for r, _ in found), max(r for r, _ in found)]
        rates.plot(ends, [mean + slope * (r - radius) for r in ends], "k--", lw=0.8)
        print("no drift at %.3f m by a straight line" % (radius - mean / slope))
    rates.axhline(0, color="0.7")
    over.set(xlabel="t in s", ylabel="distance from the axis in m")
    rates.set(xlabel="distance from the axis in m", ylabel="drift in m/s")
    fig.tight_layout()
    fig.savefig(picture, dpi=120)


if __name__ == "__main__":
    main()
