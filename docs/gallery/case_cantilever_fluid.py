"""Seed Fig. 5: a cantilever released horizontally in fluids of different viscosity."""
import math

import numpy as np

TITLE = "Cantilever in a viscous fluid (Pazouki, Serban and Negrut, Fig. 5)"
TEXT = """
A cantilever, L = 1 m, d = 0.04 m, 7200 kg/m³, E = 20 MPa, is released horizontally in fluids of 0.1 to 20 Pa s. It swings in the thin ones
and creeps down in the thick ones. The paper sees the change near 10 Pa s. It depends on the amplitude, so that we count a motion as
overdamped whose tip passes its place of rest by less than 1 % of the way. Small swings about the hanging state have a damping ratio of 0.628
at 10 Pa s and are critical (Q = 1/2) near 28 Pa s (Sader's added mass and drag). The place of rest is that of the elastica under
the beam's weight less buoyancy. The box around the beam is 1.6 x 0.16 x 1.6 m, periodic across, so that the fluid moves with a row of
beams 0.16 m apart: that is what the paper's small domain does too.
"""
EI, WEIGHT = 20e6 * math.pi * 0.04**4 / 64, (7200 - 1000) * math.pi * 0.02**2 * 9.81


def elastica_tip(n=2000):
    """Tip (x, z) of the unit clamped beam at rest: theta'' = lambda (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0, by shooting."""
    lam, h = WEIGHT / EI, 1.0 / n

    def shoot(k):
        th = x = z = 0.0
        for i in range(n):
            s = i * h
            km = k + 0.5 * h * lam * (1 - s) * math.cos(th)
            tm = th + 0.5 * h * k
            x, z, th = x + h * math.cos(tm), z + h * math.sin(tm), th + h * km
            k += h * lam * (1 - s - 0.5 * h) * math.cos(tm)
        return k, x, z

    lo, hi = -2 * lam, 0.0
    for _ in range(60):
        mid = 0.5 * (lo + hi)
        lo, hi = (lo, mid) if shoot(mid)[0] > 0 else (mid, hi)
    return shoot(0.5 * (lo + hi))[1:]


def run(g):
    rest, curves = elastica_tip(), []
    dp = "0.0266666666666666667" if g.fine else "0.04"
    for mu in (0.1, 1, 5, 10, 20) if g.fine else (1, 10, 20):
        # The tip falls at up to 2 m/s in the thin fluids, at a fraction of it in the thick ones.
        r = g.run("cantilever_fluid", "-sph_dp", dp, "-sph_viscosity", str(mu), "-sph_max_speed", "2" if mu < 10 else "1", "-time_end", "3" if g.fine else "2",
                  label="mu_%g" % mu)
        t, x, z = (np.array(r.history[k]) for k in ("time", "rod_tip_x", "rod_tip_z"))
        curves.append((mu, t, x - 1, z))
        over = max(0.0, (rest[0] - x.min()) / (1 - rest[0]))
        g.note("%g Pa s: passes its place of rest by %.1f %% of the way" % (mu, 100 * over))
        if mu >= 20:
            g.between("overshoot at %g Pa s (%%)" % mu, 100 * over, 0.0, 1.0, "overdamped: beyond the paper's 10 Pa s")
        elif mu <= 1:
            g.between("overshoot at %g Pa s (%%)" % mu, 100 * over, 1.0, 100.0, "it swings, as in the paper")

    def plot(a):
        for mu, t, x, z in curves:
            (line,) = a.plot(t, x, label="%g Pa s: x" % mu)
            a.plot(t, z, "--", color=line.get_color(), label="z")
        for v in (rest[0] - 1, rest[1]):
            a.axhline(v, color="k", ls=":", lw=0.8, label="at rest (elastica)" if v == rest[1] else None)
        a.set_xlabel("t (s)")
        a.set_ylabel("displacement of the tip (m)")
        a.legend(ncol=2)

    g.draw(plot, 4.4)
