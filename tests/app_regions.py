"""Regions: lattices against numpy's and exact volumes, surfaces from files against the box, refusals, Poiseuille flow in a round pipe."""
import csv
import math
import sys

import apptest

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

frond = apptest.Frond(sys.argv[1], sys.argv[2])
check, near = apptest.check, apptest.near

BASE = """
domain_lo: [-0.5, -0.5, -0.5]
domain_hi: [0.5, 0.5, 0.5]
sph:
  dp: %g
  density: 1000
  viscosity: 1
  max_speed: 1
  backend_placeholder: 0
time_end: 1e-9
output_every: 1
history_every: 1
progress_every: 0
""".replace("  backend_placeholder: 0\n", "")


def scene(name, dp, text):
    return frond.write(name + ".yaml", BASE % dp + text)


def markers(name, *options):
    """Positions of the fluid and of the boundary markers, sorted, at the start."""
    frond.runs("run", name + ".yaml", "-output_dir", name, "-output_overwrite", *options)
    with h5py.File(frond.path(name, "frame_00000.h5")) as h:
        x, group = h["markers/position"][:], h["markers/group"][:]
    rows = lambda a: a[np.lexsort(a.T)]
    return rows(x[group == -1]), rows(x[group >= 0])


def lattice(dp, lo=-0.5, hi=0.5, layers=0):
    n = int(round((hi - lo) / dp))
    s = lo + (np.arange(-layers, n + layers) + 0.5) * dp
    return np.array(np.meshgrid(s, s, s, indexing="ij")).reshape(3, -1).T


def cylinder(x, start, end, R):
    """Signed distance; exact outside and inside of one cylinder."""
    start, end = np.array(start), np.array(end)
    L = np.linalg.norm(end - start)
    t = (end - start) / L
    s = (x - start) @ t
    q = np.array([np.abs(s - L / 2) - L / 2, np.linalg.norm(x - start - s[:, None] * t, axis=1) - R])
    return np.linalg.norm(np.maximum(q, 0), axis=0) + np.minimum(q.max(axis=0), 0)


def same(a, b, text):
    check(a.shape == b.shape and a.size > 0 and np.abs(a - b).max() < 1e-12, "%s: %s and %s markers" % (text, len(a), len(b)))


def test_shapes():
    """Fluid: lattice sites inside; walls: those outside within the support of 2.4 dp. Volumes: each part of the surface decides over
    sites no further than dp/2 from it on average, so |error| <= area dp/2."""
    dp = 0.05
    x, wide = lattice(dp), lattice(dp, layers=3)
    ends = ([-0.3, -0.25, -0.2], [0.25, 0.3, 0.1])
    L = np.linalg.norm(np.subtract(*ends))
    pipe = lambda x: np.minimum(np.minimum(cylinder(x, [-0.45, 0.02, 0], [-0.1, 0.02, 0], 0.37),
                                           cylinder(x, [-0.1, 0.02, 0], [0.2, 0.02, 0], 0.2)), cylinder(x, [0.2, 0.02, 0], [0.45, 0.02, 0], 0.37))
    R, r = 0.37, 0.2
    cases = [
        ("ball", "shape: sphere\n  position: [0.01, 0.02, 0.03]\n  radius: 0.4", lambda x: np.linalg.norm(x - [0.01, 0.02, 0.03], axis=1) - 0.4,
         4 / 3 * math.pi * 0.4**3, 4 * math.pi * 0.4**2),
        ("rod", "shape: cylinder\n  start: %s\n  end: %s\n  radius: 0.15" % ends, lambda x: cylinder(x, *ends, 0.15), math.pi * 0.15**2 * L,
         2 * math.pi * 0.15 * (L + 0.15)),
        ("pipe", "shape: pipe\n  start: [-0.45, 0.02, 0]\n  end: [0.45, 0.02, 0]\n  radius: 0.37\n  radius2: 0.2\n  step: 0.35\n  back: 0.65", pipe,
         math.pi * (0.6 * R**2 + 0.3 * r**2), 2 * math.pi * (0.6 * R + 0.3 * r + R**2 + R**2 - r**2)),
    ]
    for name, text, distance, volume, area in cases:
        scene(name, dp, "regions: it\nregion_it:\n  " + text + "\n")
        fluid, wall = markers(name)
        d = distance(x)
        dw = distance(wide)
        same(fluid, x[d < 0][np.lexsort(x[d < 0].T)], name + ", fluid")
        at = wide[(dw > 0) & (dw <= 2.4 * dp)]
        same(wall, at[np.lexsort(at.T)], name + ", walls")
        near(len(fluid) * dp**3, volume, area * dp / 2, name + ": volume")
        print("%s: volume %.5f, exact %.5f, bound %.5f m^3" % (name, len(fluid) * dp**3, volume, area * dp / 2))


CORNERS = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
QUADS = [[1, 2, 4, 3], [5, 7, 8, 6], [1, 5, 6, 2], [3, 4, 8, 7], [1, 3, 7, 5], [2, 6, 8, 4]]


def triangles(quads=QUADS):
    return [[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)]


def stl(name, facets):
    lines = ["solid cube"]
    for f in facets:
        lines += ["facet normal 0 0 0", "outer loop"] + ["vertex %g %g %g" % tuple(CORNERS[v - 1]) for v in f] + ["endloop", "endfacet"]
    return frond.write(name, "\n".join(lines + ["endsolid"]) + "\n")


def test_files():
    """A cube of 0.4 m in STL and in OBJ, as a region box and as the domain with its own walls, which fill the corners too."""
    dp = 0.05
    stl("cube.stl", triangles())
    frond.write("cube.obj", "# cube\n" + "".join("v %g %g %g\n" % tuple(c) for c in CORNERS) + "vn 0 0 1\n" +
                "".join("f " + " ".join("%d//1" % v for v in q) + "\n" for q in QUADS))
    found = {}
    for name, text in (("stl", "shape: surface\n  file: cube.stl\n  scale: 0.2"), ("obj", "shape: surface\n  file: cube.obj\n  scale: 0.2"),
                       ("box", "shape: box\n  lo: [-0.2, -0.2, -0.2]\n  hi: [0.2, 0.2, 0.2]")):
        scene(name, dp, "regions: it\nregion_it:\n  " + text + "\n")
        found[name] = markers(name)
        for k in (0, 1):
            check(np.array_equal(found[name][k], found["stl"][k]), "%s: not the markers of the STL file, bit for bit" % name)
    scene("domain", dp, "")
    fluid, wall = markers("domain", "-domain_lo", "-0.2,-0.2,-0.2", "-domain_hi", "0.2,0.2,0.2", "-walls", "xmin,xmax,ymin,ymax,zmin,zmax")
    same(found["stl"][0], fluid, "fluid of the cube and of the domain")
    depth = np.linalg.norm(np.maximum(np.abs(wall) - 0.2, 0), axis=1)
    same(found["stl"][1], wall[depth <= 2.4 * dp * (1 + 1e-9)], "walls of the cube and of the domain within the support")
    # moved by a whole number of spacings, with a fluid box that fills it to a quarter, and walls all around
    fluid, wall = markers("stl", "-region_it_position", "0.1,0,0", "-fluid_hi", "9e-1,0.5,-0.1".replace("9e-1", "0.5"))
    moved = found["stl"][0] + [0.1, 0, 0]
    same(fluid, moved[moved[:, 2] < -0.1], "the cube filled to a quarter")
    same(wall, found["stl"][1] + [0.1, 0, 0], "its walls")


def test_carve():
    """A ball in a box: no fluid inside of it, the rest as without; regions without walls; a periodic pipe has no ends."""
    dp = 0.05
    body = "bodies: ball\nbody_ball:\n  shape: sphere\n  motion: fixed\n  size: [0.1, 0, 0]\n  position: [0.2, 0, 0]\n"
    scene("carve", dp, "regions: it\nregion_it:\n  lo: [-0.2, -0.2, -0.2]\n  hi: [0.2, 0.2, 0.2]\n" + body)
    fluid, wall = markers("carve")
    x = lattice(dp, -0.2, 0.2)
    x = x[np.linalg.norm(x - [0.2, 0, 0], axis=1) >= 0.1]
    same(fluid, x[np.lexsort(x.T)], "fluid around the ball")
    outside = wall[np.linalg.norm(np.maximum(np.abs(wall) - 0.2, 0), axis=1) > 0]
    inball = outside[np.linalg.norm(outside - [0.2, 0, 0], axis=1) < 0.1]
    sites = inball / dp - 0.5  # none of the lattice: these are the ball's own
    check(len(sites) > 10 and np.abs(sites - np.round(sites)).max(axis=1).min() > 1e-3, "walls in a fixed body give way to it")
    scene("open", dp, "regions: a, b\nregion_a:\n  shape: cylinder\n  start: [0, 0, -0.5]\n  end: [0, 0, 0.5]\n  radius: 0.2\n"
          "region_b:\n  shape: sphere\n  position: [0.3, 0, 0]\n  radius: 0.15\n  wall: false\n")
    fluid, wall = markers("open", "-domain_periodic", "z")
    x = lattice(dp)
    a, b = np.linalg.norm(x[:, :2], axis=1) - 0.2, np.linalg.norm(x - [0.3, 0, 0], axis=1) - 0.15
    at = x[np.minimum(a, b) < 0]
    same(fluid, at[np.lexsort(at.T)], "a pipe and a ball")
    at = x[(a <= 2.4 * dp) & (np.minimum(a, b) > 0)]
    same(wall, at[np.lexsort(at.T)], "walls around the pipe only")


def test_refused():
    dp = 0.05
    stl("open.stl", triangles()[:-1])
    turned = triangles()
    turned[3] = turned[3][::-1]
    stl("turned.stl", turned)
    stl("inside.stl", [f[::-1] for f in triangles()])
    frond.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")
    scene("bad", dp, "regions: it\nregion_it:\n  shape: surface\n  scale: 0.2\n")
    bad = lambda options, *words, code=1: frond.refuses(["check", "bad.yaml", *options.split()], words, code)
    bad("", "it", "region_it_file")
    bad("-region_it_file open.stl", "region 'it'", "open.stl", "not closed: edge", "must be 2")
    bad("-region_it_file turned.stl", "region 'it'", "turned.stl", "not oriented", "edge")
    bad("-region_it_file inside.stl", "inside.stl", "volume", "counter-clockwise")
    bad("-region_it_file bad.obj", "bad.obj", "line 4", "vertex", "1 ... 3", code=3)
    bad("-region_it_file none.obj", "none.obj", "cannot be opened", code=3)
    stl("cube.stl", triangles())
    bad("-region_it_file cube.stl -region_it_scale 0.7", "region 'it'", "inside the domain")
    bad("-region_it_file cube.stl -sph_dim 2", "region_it_shape surface", "3D")
    bad("-region_it_file cube.stl -fluid false -time_step 1", "regions", "fluid")
    bad("-region_it_file cube.stl -fluid_lo 0.3,-0.5,-0.5", "nothing in common", "no fluid")
    bad("-region_it_file cube.stl -sph_dp 1e-5", "sph_dp", "markers")
    bad("-region_it_file cube.stl -bodies a -body_a_motion free -body_a_size 0.1,0,0 -body_a_position 0.15,0,0 -body_a_density 1", "body 'a'", "overlaps the wall")
    bad("-region_it_shape sphere", "region 'it'", "sphere", "position")
    bad("-region_it_shape sphere -region_it_position 0,0,0 -region_it_radius -1", "region_it_radius", "-1", "> 0")
    bad("-region_it_shape cone", "cone", "none of")
    pipe = "-region_it_shape pipe -region_it_start 0,0,-0.3 -region_it_end 0,0,0.3 -region_it_radius 0.2 -region_it_radius2 0.1 "
    bad(pipe, "pipe", "region_it_step")
    bad(pipe + "-region_it_step 0.7", "region_it_step", "0.7", "0.6")
    bad(pipe + "-region_it_step 0.3 -region_it_back 0.2", "region_it_back", "0.2", "0.3")
    bad(pipe + "-region_it_step 0.3 -region_it_end 0,0,-0.3", "region_it_start", "same point")


def test_poiseuille():
    """u = f (R^2 - r^2)/4 nu in a round pipe. Its wall is a staircase: the place where the velocity vanishes is known to dp/2 at most,
    which changes the velocities by f R dp/4 nu, dp/R of the largest; on average over the places that steps take it is less
    by far: half of it is allowed. Steady to exp(-5.78 * 1.2) = 1e-3."""
    R, nu, f, errors = 1.0, 1.0, 1.0, []
    for n in (5, 10):
        dp = R / n
        frond.write("round.yaml", """
domain_lo: [-1.2, -1.2, 0]
domain_hi: [1.2, 1.2, %.12g]
domain_periodic: z
regions: pipe
region_pipe: {shape: cylinder, start: [0, 0, 0], end: [0, 0, %.12g], radius: %g}
sph: {dp: %.12g, density: 1, viscosity: %g, max_speed: 0.25, body_force: [0, 0, %g], reinit: none}
time_end: 1.2
output_every: 1.2
history_every: 0.6
progress_every: 0
""" % (6 * dp, 6 * dp, R, dp, nu, f))
        frond.runs("run", "round.yaml", "-output_dir", "round%d" % n)
        with h5py.File(frond.path("round%d" % n, "frame_00001.h5")) as h:
            fluid = h["markers/group"][:] == -1
            x, u = h["markers/position"][:][fluid], h["markers/velocity"][:][fluid, 2].astype(float)
        r2 = np.minimum((x[:, :2] ** 2).sum(axis=1), R**2)
        exact = f * (R**2 - r2) / (4 * nu)
        error = math.sqrt(((u - exact) ** 2).mean() / (exact**2).mean())
        errors.append(error)
        print("round pipe, R/dp = %d: relative L2 error %.4f, mean velocity %.5f of %.5f" % (n, error, u.mean(), f * R**2 / (8 * nu)))
        check(error < dp / R / 2, "round pipe, R/dp = %d: relative L2 error %.4f" % (n, error))
    return errors


test_shapes()
test_files()
test_carve()
test_refused()
test_poiseuille()
apptest.report()
