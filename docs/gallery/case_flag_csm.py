"""Turek and Hron's flag without fluid: CSM1 and CSM3."""
import numpy as np

TITLE = "Flag under gravity: Turek and Hron's CSM1 and CSM3"
TEXT = """
The elastic flag, 0.35 m long and 0.02 m thick, as a beam clamped at x = 0.25 m, with E/(1 - nu²) for plane strain. CSM3 swings without
damping, CSM1 is the state of rest, reached here with damping. The reference is a solid that is held on a round cylinder and
shears: both make the beam of CSM1 a little too stiff.
"""


def middle_and_amplitude(v):
    return (v.max() + v.min()) / 2, (v.max() - v.min()) / 2


def run(g):
    r = g.run("flag_csm3", "-beam_flag_elements", "32" if g.fine else "16", label="csm3")
    t, y = np.array(r.history["time"]), 1e3 * np.array(r.history["flag_tip_y"])
    mean, amplitude = middle_and_amplitude(y[t > 5])
    up = [t[i] + (t[i + 1] - t[i]) * (mean - y[i]) / (y[i + 1] - y[i]) for i in range(len(t) - 1) if y[i] < mean <= y[i + 1]]
    source = "Turek & Hron 2006"
    g.number("CSM3: mean of u_y (mm)", mean, -63.607, 0.005, source)
    g.number("CSM3: amplitude of u_y (mm)", amplitude, 65.160, 0.005, source)
    g.number("CSM3: frequency (Hz)", (len(up) - 1) / (up[-1] - up[0]), 1.0995, 0.005, source)
    rest = g.run("flag_csm3", "-beam_flag_elements", "32" if g.fine else "16", "-ancf_damping", "10", label="csm1")
    # The cylinder's round face lies 1 mm before x = 0.25 m: 4 x 0.001/0.35 = 1.2 % of the deflection.
    g.number("CSM1: u_y (mm)", 1e3 * rest.history["flag_tip_y"][-1], -66.1029, 0.012, source)

    def plot(a):
        a.plot(t, y, lw=0.8, label="u_y of the tip, ours")
        for v in (-63.607 - 65.160, -63.607 + 65.160):
            a.axhline(v, color="k", ls="--", lw=0.8, label="extremes of CSM3" if v > 0 else None)
        a.plot(rest.history["time"], 1e3 * np.array(rest.history["flag_tip_y"]), label="with damping")
        a.axhline(-66.1029, color="k", ls=":", lw=0.8, label="CSM1")
        a.set_xlabel("t (s)")
        a.set_ylabel("u_y (mm)")

    g.draw(plot)
