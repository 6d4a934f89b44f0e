"""app_sections.py FROND FOLDER SOURCE - axial force, curvature and moment along beams in the frames, under their weight."""
import math
import sys

import h5py
import numpy as np
from apptest import Frond, check, report

L, D, RHO, E, G, NEL = 1.0, 0.04, 1000.0, 1e10, 9.81, 4
EI, Q = E * math.pi * D**4 / 64, RHO * math.pi * D**2 / 4 * G
OMEGA = 3.516 * math.sqrt(EI * G / Q) / L**2  # first frequency of the cantilever, rad/s

SCENE = """
scene_name: sections
fluid: false
gravity: [0, 0, -%g]
beams: arm, cord
beam_diameter: %g
beam_density: %g
beam_young: %g
beam_elements: %d
beam_end0: clamp
beam_arm:
  start: [0, 0, 0]
  end: [%g, 0, 0]
beam_cord:
  start: [0, 1, 0]
  end: [0, 1, -%g]
  end0: pin
ancf_damping: %g
ancf_snes_rtol: 1e-12
time_end: 0.32
time_step: 0.002
output_every: 0.32
""" % (G, D, RHO, E, NEL, L, L, 2 * OMEGA)

frond = Frond(sys.argv[1], sys.argv[2])
frond.write("s.yaml", SCENE)
frond.runs("run", "s.yaml", "-output_dir", "out")
with h5py.File(frond.path("out", "frame_00001.h5"), "r") as f:
    arm, cord = f["beams/arm/line"], f["beams/cord/line"]
    s = arm["coordinate"][:]
    # Critical damping: the rest of the motion is (1 + wt) exp(-wt) with wt = 35, 3e-14 of the deflection. What remains is the
    # element: cubics are exact at nodes, so their curvature is the best linear one to the exact parabola, off by at most
    # q l^2/12 in the moment, and the geometry, of the order of the square of the slope q L^3/(6 EI).
    slope = Q * L**3 / (6 * EI)
    tol = Q * (L / NEL)**2 / 12 * (1 + 1e-3) + slope**2 * Q * L**2
    exact = Q * (L - s)**2 / 2
    check(np.abs(arm["moment"][:, 1] - exact).max() <= tol, "moment of the arm: off by %g, may be %g N m" %
          (np.abs(arm["moment"][:, 1] - exact).max(), tol))
    check(np.abs(arm["moment"][:, 1] - exact).max() >= tol / 4, "the tolerance of the moment has the size of the element's error")
    check(np.abs(arm["moment"][:][:, (0, 2)]).max() <= 1e-9 * Q * L**2, "no moment but about y")
    check(np.abs(arm["curvature"][:] * EI - arm["moment"][:]).max() <= 1e-12 * Q * L**2, "moment = EI curvature")
    # The cord hangs from a pin: a clamp holds the gradient too, hence no strain there. A quadratic r' gives the linear force;
    # with the paper's strain EA eps |r'| = q (L - s), off by a few times the strain. Newton stops at 1e-8 of the arm's forces.
    N = cord["axial_force"][:]
    exact = Q * (L - s)
    print("arm: moment at the clamp %.6f N m, qL^2/2 %.6f; cord: force at the clamp %.6f N, qL %.6f" %
          (arm["moment"][0, 1], Q * L**2 / 2, N[0], Q * L))
    check(np.abs(N - exact).max() <= 10 * Q * L / (E * math.pi * D**2 / 4) * Q * L + 1e-9 * Q * L, "force of the cord: off by %g N" %
          np.abs(N - exact).max())
    check(np.abs(cord["moment"][:]).max() <= 1e-9 * Q * L**2, "no moment in the cord")
    check(arm["axial_force"].attrs["unit"] in (b"N", "N") and arm["moment"].attrs["unit"] in (b"N m", "N m"), "units")

# An arc in a fluid at rest: no fluid inside, by distances to 2000 points of the circle, all sites outside kept, and it stays.
ARC = """
scene_name: arc
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0.4]
domain_periodic: [x, y, z]
beams: hoop
beam_hoop:
  start: [0.1, 0.2, 0.2]
  end: [0.3, 0.2, 0.2]
  curvature: -8
  normal: [0, 1, 0]
  elements: 4
  diameter: 0.06
  density: 1000
  young: 1e7
  end0: clamp
sph:
  dp: 0.02
  density: 1000
  viscosity: 1
  max_speed: 1
time_end: 0.002
output_every: 0.002
"""
frond.write("arc.yaml", ARC)
frond.runs("run", "arc.yaml", "-output_dir", "arc")
with h5py.File(frond.path("arc", "frame_00001.h5"), "r") as f, h5py.File(frond.path("arc", "frame_00000.h5"), "r") as f0:
    # n x t = -z for n = y, t = x: with curvature -8/m the middle lies at negative z
    half = math.asin(0.8)
    angle = np.linspace(-half, half, 2000)
    circle = np.stack((0.2 + np.sin(angle) / 8, np.full(2000, 0.2), 0.2 - (np.cos(angle) - math.cos(half)) / 8), 1)
    line = f0["beams/hoop/line/position"][:]
    away = np.sqrt(((line[:, None] - circle[None])**2).sum(2)).min(1).max()
    # the cubics through 5 nodes of an arc: error h^4 kappa^3/384 with h = L/4, and half the distance of the circle's points
    arc = 2 * half / 8
    check(away <= (arc / 4)**4 * 8**3 / 384 + arc / 4000, "line of the arc off the circle by %g m" % away)
    x, group = f0["markers/position"][:], f0["markers/group"][:]
    fluid = x[group == -1]
    inside = np.sqrt(((fluid[:, None] - circle[None])**2).sum(2))
    inside = inside.min(1)[~np.isin(inside.argmin(1), (0, 1999))]  # but beyond the ends, which are flat
    check(inside.min() > 0.03 - arc / 2000, "fluid at %g m from the axis of the arc" % inside.min())
    site = (np.arange(20) + 0.5) * 0.02
    grid = np.stack(np.meshgrid(site, site, site, indexing="ij"), 3).reshape(-1, 3)
    near = np.sqrt(((grid[:, None] - circle[None])**2).sum(2)).argmin(1)
    d = np.sqrt(((grid - circle[near])**2).sum(1))
    free = ((d >= 0.03) | (near == 0) | (near == 1999)).sum(), (d >= 0.03).sum()
    check(free[1] <= len(fluid) <= free[0], "%d fluid markers, between %d and %d sites are outside of the arc" % (len(fluid), free[1], free[0]))
    moved = np.abs(f["beams/hoop/line/position"][:] - line).max()
    # the density is one on the initial lattice, so that no pressure acts: round-off of c^2 rho = 1e5 Pa over a few steps
    check(moved < 1e-14, "the arc in a fluid at rest moves by %g m" % moved)
text = open(frond.path("out", "run.xdmf")).read()
check(all(w in text for w in ("axial_force", "curvature", "moment")), "fields in the XDMF index")
report()
