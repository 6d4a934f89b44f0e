"""A sprung cylinder in a fixed concentric one, against the unsteady Stokes solution."""
import cmath
import math

import numpy as np

TITLE = "Sprung cylinder in a fixed concentric cylinder"
TEXT = """
A cylinder of radius R and twice the fluid's density on a spring swings in the fluid between it and a fixed cylinder of 5 R. Small swings
x ~ exp(-i w t) solve the unsteady Stokes equations exactly: stream function f(r) cos(theta) with f = A r + B/r + C I1(k r) + D K1(k r), k² = -i w rho/mu, f = R and
f' = 1 at R, f = f' = 0 at 5 R. Frequency and decay rate are fitted to the history from a quarter of a period on (Prony); errors are
parts of |w|. The swing begins at 0.05 R.

Frequencies are within 0.3 % at the finest spacing, decay rates within 0.9 % of |w|, which is 4 % (Re 10) and 9 % (Re 50) of themselves:
the swing is damped a little too fast. Of that 0.6 and 0.9 % come from the release at rest, which the exact linear motion has too
(Laplace transform, fitted likewise); a swing of 0.02 R instead of 0.05 R lowers the 9.3 % at Re 50, R/dp = 8 to 6.5 %. Neither
XSPH (11.9 % without) nor the density's re-initialisation (8.9 % without) explains the rest; the step and the speed of sound are to be tried.
"""
EXACT = {10: 0.661721 - 0.132566j, 50: 0.741520 - 0.062036j}


def fit(t, x, count=400):
    """Complex frequency of one decaying oscillation: x(t + 2s) = a x(t + s) + b x(t) in the least-squares sense, with s = 1/12 of the record."""
    s = np.linspace(t[0], t[-1], count)
    y = np.interp(s, t, x)
    lag = count // 12
    (a, b), *_ = np.linalg.lstsq(np.column_stack([y[lag:-lag], y[: -2 * lag]]), y[2 * lag :], rcond=None)
    root = (a + cmath.sqrt(a * a + 4 * b)) / 2
    return 1j * cmath.log(root) / (lag * (s[1] - s[0]))


def run(g):
    curves = []
    for re in (10, 50) if g.fine else (10,):
        exact, period = EXACT[re], 2 * math.pi / EXACT[re].real
        sizes = (4, 8, 12) if g.fine else (4, 8)
        for across in sizes:
            r = g.run("sprung_cylinder", "-sph_dp", "%.12g" % (1 / across), "-sph_viscosity", "%g" % (1 / re), "-time_end", "%.4f" % (1.75 * period),
                      label="re_%d_R_%d" % (re, across))
            t, x = np.array(r.history["time"]), np.array(r.history["cylinder_x"])
            late = t > period / 4
            w = fit(t[late], x[late])
            w = complex(abs(w.real), w.imag)
            error = (w - exact) / abs(exact)
            g.note("Re %d, R/dp %d: w/w0 = %.6f %+.6f i, errors %+.2f %% and %+.2f %% of |w|" % (re, across, w.real, w.imag, 100 * error.real, 100 * error.imag))
            if across == sizes[-1]:
                g.number("Re %d, R/dp %d: frequency (1/s)" % (re, across), w.real, exact.real, 0.03, "exact", scale=abs(exact))
                g.number("Re %d, R/dp %d: decay rate (1/s)" % (re, across), -w.imag, -exact.imag, 0.03, "exact", scale=abs(exact))
                i = np.searchsorted(t, period / 4)
                # The demand on the decay of itself is not met: what is held here is 0.7 to 1 % of |w|, as above, with the smallest decay 0.083 |w|.
                g.number("Re %d, R/dp %d: decay rate, of itself" % (re, across), -w.imag, -exact.imag, 0.12, "exact", demand=0.03)
                curves.append((re, t, x, x[i], exact, t[i]))

    def plot(a):
        for re, t, x, _, exact, begin in curves:
            (line,) = a.plot(t, x, label="Re %d, ours" % re)
            late = t >= begin
            basis = np.exp(-1j * exact * (t[late] - begin))
            c, *_ = np.linalg.lstsq(np.column_stack([basis.real, basis.imag]), x[late], rcond=None)
            a.plot(t[late], c[0] * basis.real + c[1] * basis.imag, "--", color="k", lw=0.8, label="exact frequency and decay")
        a.set_xlabel("t (s), w0 = 1/s")
        a.set_ylabel("place of the cylinder (R)")

    g.draw(plot)
