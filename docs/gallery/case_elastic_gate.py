"""Antoci's elastic gate against the experiment."""
import numpy as np

TITLE = "Elastic gate (Antoci, Gallati and Sibilla 2007)"
TEXT = """
Water 0.14 m deep and 0.1 m wide stands behind a rubber gate, 0.079 m high and 5 mm thick, clamped above and free below. Released
at once, the gate bends and lets the water out. The experiment's tip positions were read from the paper's figures by others.

The peak is 16 % too low and comes 0.05 s too early, at both resolutions alike (they differ by 1 %), whatever the viscosity:
published SPH results with this modulus are 8 to 20 % off. What is limited is the linear law of the rubber and the plane model, not the spacing:
with E = 12 MPa the tip of a linear cantilever under the full hydrostatic load stands 45 mm out, so that a gate past which the
water already runs cannot hold 46 mm for long, as the rubber does. A law of the rubber that softens would be the next thing to try.
"""
EXPERIMENT = np.array([[0.04, 12.5, 1.1], [0.08, 34.0, 10.0], [0.12, 44.0, 15.1], [0.16, 46.4, 17.1], [0.20, 44.2, 16.0], [0.28, 41.2, 12.8],
                       [0.36, 37.4, 10.9]])


def run(g):
    r = g.run("elastic_gate", "-sph_dp", "0.00125" if g.fine else "0.0025", "-time_end", "0.4" if g.fine else "0.2")
    t = np.array(r.history["time"])
    x, y = 1e3 * (np.array(r.history["gate_tip_x"]) - 0.1025), 1e3 * np.array(r.history["gate_tip_y"])
    # Published codes are 8 to 20 % off; 8 % is the demand.
    g.number("largest displacement x of the tip (mm)", x.max(), 46.4, 0.20, "experiment", demand=0.08)
    g.number("displacement x at 0.08 s (mm)", np.interp(0.08, t, x), 34.0, 0.08, "experiment")
    g.note("largest displacement at %.3f s (experiment: near 0.16 s)" % t[x.argmax()])

    def plot(a):
        a.plot(t, x, label="x, ours")
        a.plot(t, y, label="y, ours")
        a.plot(EXPERIMENT[:, 0], EXPERIMENT[:, 1], "ko", label="x, experiment")
        a.plot(EXPERIMENT[:, 0], EXPERIMENT[:, 2], "ks", mfc="none", label="y, experiment")
        a.set_xlabel("t (s)")
        a.set_ylabel("displacement of the gate's tip (mm)")

    g.draw(plot)
