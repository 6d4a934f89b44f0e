#!/usr/bin/python3
"""Pictures of a run of frond.

    /usr/bin/python3 plot_run.py RUN_DIR [--time T] [--out DIR]

history.png: the beam tips, body centres or fluid speed over time. view.png: beams, bodies and a slice of the fluid
coloured by speed. Needs numpy, h5py and matplotlib (Debian: python3-h5py, python3-matplotlib).
"""
import argparse
import csv
import glob
import os
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

BEAM, BODY, WALL = "#b3261e", "#7a4f9a", "#9a9a9a"


def read_history(run):
    """Columns of history.csv: name -> (unit, values)."""
    with open(os.path.join(run, "history.csv"), newline="") as f:
        rows = list(csv.reader(f))
    data = np.array(rows[1:], dtype=float)
    columns = {}
    for i, head in enumerate(rows[0]):
        name, unit = head.rstrip("]").split("[", 1)
        columns[name] = (unit, data[:, i])
    return columns


def history_panels(columns):
    """What to draw: one panel per beam tip or body centre, else the fluid's speed."""
    panels = []
    for name in columns:
        if name.endswith("_tip_x"):
            panels.append((name[: -len("_tip_x")] + ": tip", name[:-1], "position, m"))
        elif name.endswith("_x") and name[:-2] + "_wx" in columns:
            panels.append((name[:-2] + ": centre", name[:-1], "position, m"))
    return panels[:4]


def plot_history(run, out):
    columns = read_history(run)
    t = columns["time"][1]
    panels = history_panels(columns)
    if not panels:
        fig, ax = plt.subplots(figsize=(7, 4))
        unit, v = columns["fluid_speed_max"]
        ax.plot(t, v, color="#1f5fa8")
        ax.set(xlabel="time, s", ylabel="largest fluid speed, " + unit)
    else:
        fig, axes = plt.subplots(len(panels), 1, figsize=(7, 1.2 + 2.8 * len(panels)), squeeze=False, sharex=True)
        for ax, (title, stem, label) in zip(axes[:, 0], panels):
            for c, colour in zip("xyz", ("#1f5fa8", "#3a8f4d", BEAM)):
                v = columns[stem + c][1]
                if np.ptp(v) > 1e-9 * max(1.0, np.abs(v).max()):
                    ax.plot(t, v, color=colour, label=c)
            ax.set(title=title, ylabel=label)
            if ax.lines:
                ax.legend(frameon=False)
        axes[-1, 0].set_xlabel("time, s")
    for ax in fig.axes:
        ax.grid(alpha=0.25)
        ax.margins(x=0)
    fig.tight_layout()
    path = os.path.join(out, "history.png")
    fig.savefig(path, dpi=130)
    plt.close(fig)
    return path


def find_frame(run, time):
    frames = sorted(glob.glob(os.path.join(run, "frame_*.h5")))
    if not frames:
        sys.exit("plot_run: no frame_*.h5 in " + run)
    if time is None:
        return frames[-1], frames
    times = []
    for f in frames:
        with h5py.File(f) as h:
            times.append(h.attrs["time"])
    return frames[int(np.argmin(np.abs(np.array(times) - time)))], frames


def beam_lines(path, a, b):
    with h5py.File(path) as h:
        return [(g["line/position"][:][:, [a, b]], g.attrs["diameter"]) for g in h.get("beams", {}).values()]


def draw_beam(ax, line, diameter, **style):
    """A ribbon as wide as the beam is thick."""
    d = np.gradient(line, axis=0)
    n = np.stack([-d[:, 1], d[:, 0]], axis=1)
    n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
    edge = np.vstack([line + 0.5 * diameter * n, (line - 0.5 * diameter * n)[::-1]])
    ax.fill(edge[:, 0], edge[:, 1], linewidth=0, **style)


def draw_markers(ax, fig, h, a, b, c, level):
    m = h["markers"]
    x, group = m["position"][:], m["group"][:]
    dp = float(m.attrs["spacing"])
    away = np.abs(x[:, c] - level) if h.attrs["dimension"] == 3 else np.zeros(len(x))
    slab = away <= 1.6 * dp
    names = {int(k[6:]): v.decode() if isinstance(v, bytes) else str(v) for k, v in m.attrs.items() if k.startswith("group_")}
    fluid = np.flatnonzero(slab & (group == -1))
    fluid = fluid[np.argsort(-away[fluid])]  # the nearest last, on top
    span = np.ptp(x[:, [a, b]], axis=0).max()
    size = (1.1 * dp / span * 6.2 * 72) ** 2
    speed = np.linalg.norm(m["velocity"][:][fluid], axis=1)
    top = np.percentile(speed, 99.8) if speed.size and speed.max() > 0 else 1.0
    dots = ax.scatter(x[fluid, a], x[fluid, b], c=speed, s=size, marker="s", linewidths=0, cmap="viridis", vmin=0, vmax=top)
    fig.colorbar(dots, ax=ax, label="speed, m/s", shrink=0.8)
    for g, name in names.items():
        here = slab & (group == g)
        if name.startswith("wall_"):
            ax.scatter(x[here, a], x[here, b], s=size, marker="s", color=WALL, linewidths=0)
        elif name not in h.get("beams", {}):
            ax.scatter(x[here, a], x[here, b], s=size, marker="s", color=BODY, linewidths=0)


def slice_axes(h):
    """Axes to draw (a, b), the axis across (c), and where along it to cut."""
    if h.attrs["dimension"] == 2 or "markers" not in h:
        a, b, c = (0, 1, 2) if h.attrs["dimension"] == 2 else (0, 2, 1)
        return a, b, c, 0.0
    x = h["markers/position"][:]
    c = int(np.argmin(np.ptp(x, axis=0)))
    c = c if c != 2 else 1
    a, b = [k for k in range(3) if k != c]
    beams = [g["line/position"][:][:, c].mean() for g in h.get("beams", {}).values()]
    level = beams[0] if beams else 0.5 * (x[:, c].min() + x[:, c].max())
    sites = np.unique(np.round(x[:, c], 9))
    return a, b, c, float(sites[np.argmin(np.abs(sites - level))]) if not beams else float(level)


def plot_view(run, out, time):
    path, frames = find_frame(run, time)
    fig, ax = plt.subplots(figsize=(8, 7))
    with h5py.File(path) as h:
        a, b, c, level = slice_axes(h)
        if "markers" in h:
            draw_markers(ax, fig, h, a, b, c, level)
        now = float(h.attrs["time"])
        if "bodies" in h and "markers" not in h:
            ax.plot(h["bodies/position"][:][:, a], h["bodies/position"][:][:, b], "o", color=BODY)
        title = "%s, t = %.3g s" % (h.attrs["scene"].decode() if isinstance(h.attrs["scene"], bytes) else h.attrs["scene"], now)
    before = [f for f in frames if f < path]
    for f in before[:: max(1, len(before) // 6)]:
        for line, d in beam_lines(f, a, b):
            draw_beam(ax, line, d, color=BEAM, alpha=0.16)
    for line, d in beam_lines(path, a, b):
        draw_beam(ax, line, d, color=BEAM, alpha=1, zorder=5)
    ax.set(title=title, xlabel="xyz"[a] + ", m", ylabel="xyz"[b] + ", m", aspect="equal")
    fig.tight_layout()
    path = os.path.join(out, "view.png")
    fig.savefig(path, dpi=130)
    plt.close(fig)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="folder of a run (output_dir)")
    parser.add_argument("--time", type=float, help="time of the view, s (default: the last frame)")
    parser.add_argument("--out", help="folder of the pictures (default: the run's)")
    args = parser.parse_args()
    if not os.path.exists(os.path.join(args.run, "history.csv")):
        sys.exit("plot_run: %s is not the folder of a run: no history.csv" % args.run)
    out = args.out or args.run
    for path in (plot_history(args.run, out), plot_view(args.run, out, args.time)):
        print("picture:", path)


if __name__ == "__main__":
    main()
