#!/usr/bin/env python3
"""Orientation and centre velocity of a floating beam and of the rigid cylinder in its place, Fig. 4 of the paper.

plot_floating.py BEAM_RUN CYLINDER_RUN [PICTURE]
"""
import glob
import os
import sys

import h5py
import numpy as np


def motion(folder):
    """Times (n), unit vectors of the axis (n x 3) and velocities of the centre (n x 3) of the first beam, or else body."""
    t, axis, velocity = [], [], []
    for path in sorted(glob.glob(os.path.join(folder, "frame_*.h5"))):
        with h5py.File(path, "r") as f:
            t.append(float(f.attrs["time"]))
            if "beams" in f:
                beam = next(iter(f["beams"].values()))
                r = beam["line/position"][:]
                axis.append(r[-1] - r[0])
                v = beam["line/velocity"][:]
                velocity.append(v[len(v) // 2])
            else:
                w, x, y, z = f["bodies/orientation"][0]
                axis.append([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
                velocity.append(f["bodies/velocity"][0])
    axis = np.array(axis)
    return np.array(t), axis / np.linalg.norm(axis, axis=1)[:, None], np.array(velocity)


def main():
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    picture = sys.argv[3] if len(sys.argv) > 3 else "floating.png"
    fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    for folder, name, style in ((sys.argv[1], "beam", "-"), (sys.argv[2], "cylinder", "--")):
        t, axis, velocity = motion(folder)
        for k in range(3):
            left.plot(t, np.degrees(np.arccos(np.clip(axis[:, k], -1, 1))), style, color="C%d" % k, label="%s, to %s" % (name, "xyz"[k]))
        right.plot(t, velocity[:, 0], style, color="k", label=name)
    left.set(xlabel="t, s", ylabel="angle of the axis, degrees")
    right.set(xlabel="t, s", ylabel="velocity of the centre along x, m/s")
    left.legend()
    right.legend()
    fig.tight_layout()
    fig.savefig(picture, dpi=120)
    print(picture)


if __name__ == "__main__":
    main()
