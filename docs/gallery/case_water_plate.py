"""A column of water on a clamped elastic plate."""
import h5py
import numpy as np

TITLE = "Column of water on an elastic plate"
TEXT = """
Water 2 m deep stands on a plate of aluminium, 1 m long and 0.05 m thick, clamped at both ends; in 2D the plate is a beam with
E/(1 - nu²). The water's weight acts at once, plate and water ring, the artificial viscosity damps them. The mean over the second
half of the run is compared with the thin plate under the hydrostatic pressure and its own weight. Published SPH codes are 4 to 15 % off.
"""
EXACT = -(1000 * 9.81 * 2 + 2700 * 9.81 * 0.05) / (384 * 67.5e9 / (1 - 0.34**2) * 0.05**3 / 12)


def run(g):
    r = g.run("water_plate", "-sph_dp", "0.0166666666666667" if g.fine else "0.025")
    t, y = [], []
    for path in r.frames():
        with h5py.File(path) as h:
            nodes = h["beams/plate/nodes/coordinates"][:]
            t.append(float(h.attrs["time"]))
            y.append(nodes[len(nodes) // 2, 1] + 0.025)
    t, y = np.array(t), np.array(y)
    late = t > 0.5
    g.number("middle of the plate at rest (m)", y[late].mean(), EXACT, 0.03, "thin plate")
    g.note("standard deviation over the second half: %.2g m" % y[late].std())

    def plot(a):
        a.plot(t, 1e6 * y, label="ours")
        a.axhline(1e6 * EXACT, color="k", ls="--", label="thin plate at rest")
        a.set_xlabel("t (s)")
        a.set_ylabel("middle of the plate (µm)")

    g.draw(plot)
