"""Paper 004: the static cantilever of Table 1 with lumped trunks and with ANCF elements."""
import h5py
import numpy as np

TITLE = "Static cantilever of rigid trunks and of ANCF elements (Capasso et al. 2021)"
TEXT = """
The cantilever of Table 1, L = 79 mm, EI = 6.25e-4 N m², q = 0.269775 N/m, with 5, 10 and 20 trunks, after its swing has been damped
out, and with 4 and 16 ANCF elements. Eq. 22, v = q x² (6 L² - 4 L x + x²)/24 EI, is the linear beam. With the spring at the clamp
doubled the trunks' error at the tip is exactly 1/N²; a beam that does
not stay straight ends a little short of the linear Eq. 22.
"""
L, EI, Q = 0.079, 6.25e-4, 0.0275 * 9.81


def eq22(x):
    return Q * x**2 * (6 * L**2 - 4 * L * x + x**2) / (24 * EI)


def ancf_shape(r):
    """Positions along the axis and deflections of the nodes in the last frame."""
    with h5py.File(r.frames()[-1]) as h:
        nodes = h["beams/rod/nodes/coordinates"][:]
    return nodes[:, 0], -nodes[:, 2]


def lumped_shape(r, N):
    """The same of the trunks' ends, from their centres: each trunk begins where the one before ends."""
    ends = [np.zeros(2)]
    for i in range(N):
        centre = np.array([r.history["rod_%d_%s" % (i, k)][-1] for k in "xz"])
        ends.append(2 * centre - ends[-1])
    ends = np.array(ends)
    return ends[:, 0], -ends[:, 1]


def run(g):
    curves = []
    for N in (5, 10, 20):
        r = g.run("lumped_beam", "-beam_rod_elements", str(N), "-time_end", "2" if g.fine else "1", label="lumped_%d" % N)
        x, v = lumped_shape(r, N)
        curves.append(("%d trunks" % N, x, v))
        # Beyond 1/N^2 of Eq. 22: (v/L)^2 = 7e-4 since the beam does not stay straight, 1e-3 what the damper leaves.
        g.number("tip, %d trunks (mm)" % N, 1e3 * v[-1], 1e3 * eq22(L) * (1 + 1 / N**2), 2e-3, "Eq. 22 (1 + 1/N²)")
    for elements in (4, 16):
        r = g.run("lumped_beam", "-beam_type", "ancf", "-beam_rod_elements", str(elements), "-beam_rod_damper", "0", "-ancf_damping", "60",
                  label="ancf_%d" % elements)
        x, v = ancf_shape(r)
        curves.append(("%d ANCF elements" % elements, x, v))
        g.number("tip, %d ANCF elements (mm)" % elements, 1e3 * v[-1], 1e3 * eq22(L), 2e-3, "Eq. 22")

    def plot(a):
        s = np.linspace(0, L, 200)
        a.plot(1e3 * s, 1e3 * eq22(s), "k-", lw=1, label="Eq. 22")
        for (label, x, v), style in zip(curves, ("o", "s", ".", "x", "+")):
            a.plot(1e3 * x, 1e3 * v, style, ms=5, label=label)
        a.set_xlabel("x (mm)")
        a.set_ylabel("deflection (mm)")

    g.draw(plot)
