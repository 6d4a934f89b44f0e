#!/usr/bin/python3
"""A first hour with Frond from Python. Run it where it lies:

    FROND_LIBRARY=build/src/app/libfrond.so PYTHONPATH=python /usr/bin/python3 examples/python_tutorial.py

It needs Debian's python3-numpy; python3-petsc4py is used when it is there.
"""
import os

import numpy as np

import frond

here = os.path.dirname(os.path.abspath(__file__))

# 1. A scene is the YAML file that the frond command runs. Options of the command are keywords here. This one is water, at rest, whose
#    upper wall begins to slide; 20 markers across instead of 40 make it a matter of seconds.
couette = frond.Scene(os.path.join(here, "couette.yaml"), sph_dp=5e-5)
print("couette: %d markers, ends at t = %g s" % (len(couette.fields("rho")["rho"]), couette.end))

# 2. The loop is yours. A step is as long as stability allows, and ends at the time given at the latest.
couette.advance(0.2)
v, p = couette.sample([[2.5e-4, 5e-4, 0]])
u0 = v[0, 0] / 1.25e-5
print("t = %.3f s after %d steps: velocity half way up %.4f of the wall's, exact 0.4116" % (couette.t, couette.steps, u0))
assert abs(u0 - 0.411566) < 0.01

# 3. Forces on the walls of the last step; what the transfer lost is in there too.
for name in couette.surfaces:
    print("%-10s force along x %+.3e N" % (name, couette.load(name)["force"][0]))

# 4. Going back: an outer iteration repeats a step until it likes it. The run then goes on with the same bits.
start = couette.save()
couette.step()
once = couette.fields("v")["v"].copy()
couette.restore(start)
couette.step()
assert np.array_equal(once, couette.fields("v")["v"])
couette.close()

# 5. Structures: the tip of the beam of Fig. 3 in vacuum. Arrays of the beam are views: no copy is made, they show the present.
with frond.Scene(os.path.join(here, "beam_vacuum.yaml"), time_end=0.2) as scene:
    rod = scene.beam("rod")
    tip = rod.positions[-1]
    while scene.t < scene.end:
        scene.step()
    assert np.hypot(tip[0] - 0.96387, tip[2] + 0.20358) < 1e-3
    print("beam in vacuum: tip at t = 0.2 s (%.5f, %.5f) m, reference (0.96387, -0.20358) m" % (tip[0], tip[2]))

# 6. A sweep: the same, for three stiffnesses.
files = os.path.join(here, "beam_vacuum.yaml")
for young, z in zip((5e6, 20e6, 80e6), frond.sweep(files, "beam_rod_young", (5e6, 20e6, 80e6), lambda s: s.beam("rod").positions[-1, 2], t=0.1, time_end=0.1)):
    print("E = %4.0f MPa: tip at z = %.5f m after 0.1 s" % (young / 1e6, z))

# 7. Structures without a scene, by calls; loads are written in place. A cantilever under a tip load F: F L^3/(3 E I) for small ones.
beams = frond.Beams()
beams.add(start=(0, 0, 0), end=(1, 0, 0), elements=8, diameter=0.04, density=7200, young=2e7, end0="clamp")
beams.setup()
F, EI = 0.01, 2e7 * np.pi * 0.04**4 / 64
try:  # the same memory as a PETSc vector
    from petsc4py import PETSc

    loads = PETSc.Vec().createWithArray(beams.loads.reshape(-1), comm=PETSc.COMM_SELF)
    loads.set(0.0)
    loads.setValue(6 * 8 + 2, -F)
    loads.assemble()
    print("loads set through petsc4py")
except ImportError:
    beams.loads[:] = 0
    beams.loads[8, 2] = -F
mean, n = 0.0, 200
period = 2 * np.pi / (3.516015 * np.sqrt(EI / (7200 * np.pi * 0.02**2)))
for k in range(1, n + 1):  # released at once it swings about the static deflection: the mean over a period
    beams.advance(period * k / n)
    mean += beams.coordinates[0][8, 2] / n
assert abs(-mean / (F / (3 * EI)) - 1) < 0.02
print("mean deflection of the tip %.4e m, F L^3/(3 E I) = %.4e m" % (-mean, F / (3 * EI)))
beams.close()

# 8. Errors are exceptions with the one line that the command prints.
try:
    frond.Scene(files, beam_rod_young=-1)
except frond.Error as error:
    print("refused: %s" % error)
