"""Seed Fig. 4: a stiff beam and the equivalent rigid cylinder float in accelerating channel flow."""
import importlib.util
import os

import numpy as np

TITLE = "Floating stiff beam and rigid cylinder (Pazouki, Serban and Negrut, Fig. 4)"
TEXT = """
A straight beam, L = 0.2 m, d = 0.04 m, 7200 kg/m³, E = 20 MPa, and a rigid cylinder of the same density and shape are carried by a flow
between plane walls that starts from rest. Both begin across the flow, turned in the yz plane. They should move alike. Fine: the paper's
channel of 1 m with f = 12 mu V/(rho w²) for V = 0.2 m/s, its first 6 s. Coarse: a narrower channel, 1000 kg/m³, a stronger
force, so that the rod turns by half a radian in 1.2 s.
"""
SMALL = ["-domain_hi", "0.28,0.2,0.32", "-sph_viscosity", "5", "-sph_body_force", "0.7,0,0", "-sph_max_speed", "0.6", "-time_end", "1.2", "-output_every", "0.1"]


def run(g):
    from gallery import ROOT

    spec = importlib.util.spec_from_file_location("plot_floating", os.path.join(ROOT, "examples", "plot_floating.py"))
    floating = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(floating)
    beam, body = [], []
    if not g.fine:
        beam = ["-beam_density", "1000", "-beam_rod_start", "0.14,0.05,0.0434", "-beam_rod_end", "0.14,0.15,0.2166", "-beam_young", "1e8", *SMALL]
        body = ["-body_density", "1000", "-body_rod_position", "0.14,0.1,0.13", *SMALL]
    t, a, v = floating.motion(g.run("floating_beam", *beam, label="beam").folder)
    s, b, w = floating.motion(g.run("floating_cylinder", *body, label="cylinder").folder)
    angle, other = np.arccos(a), np.arccos(b)
    turn, speed = np.abs(angle - angle[0]).max(), v[:, 0].max()
    # Both surfaces are known to dp/4 of the radius; a beam carries no torque about its axis: (d/L)^2. As in tests/app_floating.py.
    bound = 0.02 / (4 * 0.02) + (0.04 / 0.2) ** 2
    g.number("largest difference of angles over the turn", 1 + np.abs(angle - other).max() / turn, 1.0, bound, "rigid cylinder")
    g.number("largest difference of speeds over the speed", 1 + np.abs(v[:, 0] - w[:, 0]).max() / speed, 1.0, bound, "rigid cylinder")
    g.note("turned by %.3g rad, speed at the end %.4g m/s" % (turn, v[-1, 0]))

    def plot(axes):
        for k, name in enumerate("xyz"):
            (line,) = axes.plot(t, np.degrees(angle[:, k]), label="angle to %s, beam" % name)
            axes.plot(s, np.degrees(other[:, k]), "o", ms=3, color=line.get_color(), label="cylinder")
        right = axes.twinx()
        right.plot(t, v[:, 0], "k-", lw=1)
        right.plot(s, w[:, 0], "k.", ms=4)
        right.set_ylabel("velocity of the centre along x, black (m/s)")
        axes.set_xlabel("t (s)")
        axes.set_ylabel("angle of the axis (degrees)")

    g.draw(plot, 4.4)
