"""Beams from Gmsh meshes: the motion of the same beam from YAML; what is no beam is refused in one line."""
import glob
import math
import os
import subprocess
import sys

import apptest

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

check = apptest.check
frond = apptest.Frond(sys.argv[1], sys.argv[2])

SCENE = """
fluid: false
gravity: [0, -9.81, 0]
beams: rod
beam_rod:
  diameter: 0.04
  density: 7200
  young: 20e6
  end0: clamp
%s
time_end: 0.02
time_step: 1e-3
output_every: 0.01
"""


def msh(nodes, lines, names=("rod",)):
    """Format 2.2. nodes: places; lines: (first, last, physical tag), nodes from 0."""
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    text += ['1 %d "%s"' % (k + 1, name) for k, name in enumerate(names)] + ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    text += ["%d %.17g %.17g %.17g" % ((k + 1,) + tuple(x)) for k, x in enumerate(nodes)] + ["$EndNodes", "$Elements", str(len(lines))]
    text += ["%d 1 2 %d %d %d %d" % (k + 1, tag, tag, a + 1, b + 1) for k, (a, b, tag) in enumerate(lines)] + ["$EndElements", ""]
    return "\n".join(text)


def run(name, geometry):
    frond.write(name + ".yaml", SCENE % geometry)
    done = subprocess.run([os.path.abspath(sys.argv[1]), "run", name + ".yaml", "-output_dir", "out_" + name],
                          cwd=sys.argv[2], capture_output=True, text=True)
    check(done.returncode == 0, "%s runs: %s" % (name, done.stderr[-300:]))
    frames = {}
    for path in sorted(glob.glob(os.path.join(sys.argv[2], "out_" + name, "**", "*.h5"), recursive=True)):
        with h5py.File(path, "r") as h:
            h.visititems(lambda key, d: frames.__setitem__((os.path.basename(path), key), d[()])
                         if isinstance(d, h5py.Dataset) and key.startswith("beams/") else None)
    check(len(frames) > 0, name + ": there are frames of the beam")
    return frames


def same(a, b, tolerance, text):
    check(a.keys() == b.keys(), text + ": the same datasets")
    for key in a.keys() & b.keys():
        worst = float(np.max(np.abs(np.asarray(a[key], float) - np.asarray(b[key], float)), initial=0))
        size = float(np.max(np.abs(np.asarray(a[key], float)), initial=0))
        check(worst <= tolerance * max(size, 1), "%s: %s differs by %.2g" % (text, key, worst))


# Straight: the same numbers reach the solver, so the same bits leave it. Nodes and lines are out of order in the file.
yaml = "  start: [0, 0, 0]\n  end: [1, 0.5, 0.25]\n  elements: 4"
places = [(k / 4, k / 8, k / 16) for k in (2, 0, 4, 1, 3)]
chain = [(4, 2, 1), (1, 3, 1), (0, 4, 1), (3, 0, 1)]
frond.write("line.msh", msh(places, chain))
straight = run("yaml", yaml)
same(run("mesh", "  mesh: line.msh"), straight, 0, "straight")
frond.write("two.msh", msh(places + [(9, 9, 9), (8, 9, 9)], [(5, 6, 1)] + [(a, b, 2) for a, b, _ in chain], ("other", "my rod")))
same(run("group", "  mesh: two.msh\n  group: my rod"), straight, 0, "one of two groups")
back = run("back", "  mesh: back.msh") if frond.write("back.msh", msh(places, [(b, a, 1) for a, b, _ in chain])) or True else None
same(back, run("yamlback", "  start: [1, 0.5, 0.25]\n  end: [0, 0, 0]\n  elements: 4"), 0, "lines from the other end")

# Numbers of physical points and of physical lines are counted apart.
points = msh(places, chain).replace('$PhysicalNames\n1\n', '$PhysicalNames\n2\n0 1 "foot"\n').replace("$Elements\n4\n", "$Elements\n5\n9 15 2 1 1 2\n")
frond.write("points.msh", points)
same(run("points", "  mesh: points.msh"), straight, 0, "with a physical point")
NEW = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
0 1 "foot"
1 1 "rod"
$EndPhysicalNames
$Entities
2 1 0 0
1 0 0 0 1 1
2 1 0.5 0.25 0
1 0 0 0 1 0.5 0.25 1 1 2 1 -2
$EndEntities
$Nodes
3 5 1 5
0 1 0 1
1
0 0 0
0 2 0 1
2
1 0.5 0.25
1 1 0 3
3
4
5
0.25 0.125 0.0625
0.5 0.25 0.125
0.75 0.375 0.1875
$EndNodes
$Elements
2 5 1 5
0 1 15 1
1 1
1 1 1 4
2 1 3
3 3 4
4 4 5
5 5 2
$EndElements
"""
frond.write("new.msh", NEW)
same(run("new", "  mesh: new.msh"), straight, 0, "format 4.1")

# An arc: curvature and normal are those of a circle through three nodes, to a few rounding errors (1e-15); the motion of 20 steps
# is bounded by the same perturbation of the rest shape times EA/EI L^2 = 16/d^2 = 1e4 of the stiffest response.
arc = [(math.cos(k * math.pi / 12), math.sin(k * math.pi / 12), 0) for k in range(7)]
frond.write("arc.msh", msh(arc, [(k, k + 1, 1) for k in range(6)]))
same(run("arcmesh", "  mesh: arc.msh"),
     run("arcyaml", "  start: [1, 0, 0]\n  end: [0, 1, 0]\n  elements: 6\n  curvature: 1\n  normal: [0, 0, 1]"), 1e-10, "arc")



def line_of(folder, beam, frame):
    with h5py.File(frond.path("out_" + folder, "frame_%05d.h5" % frame), "r") as f:
        return f["beams/%s/line/position" % beam][:]


# Circles however their points are spaced: tangents and lengths are exact, Hermite's cubic is off by angle^4/384 of the radius, with
# angles up to 0.2 rad: 4e-6; the falls, of some 1e-3 m, differ in proportion to the rest shape, 1e-4 of them, below that.
uneven = np.cumsum([0, 0.2, 0.1, 0.15, 0.2, 0.1, 0.18, 0.2, 0.12, 0.15, 0.170796326794897])
frond.write("uneven.msh", msh([(math.cos(a), math.sin(a), 0) for a in uneven], [(k, k + 1, 1) for k in range(10)]))
run("uneven", "  mesh: uneven.msh")
arcyaml = SCENE % "  start: [1, 0, 0]\n  end: [%.17g, %.17g, 0]\n  elements: 10\n  curvature: 1\n  normal: [0, 0, 1]" % (math.cos(uneven[-1]), math.sin(uneven[-1]))
frond.write("arc10.yaml", arcyaml)
frond.runs("run", "arc10.yaml", "-output_dir", "out_arc10")
off = np.abs(line_of("uneven", "rod", 2) - line_of("arc10", "rod", 2)).max()
fall = np.abs(line_of("arc10", "rod", 2) - line_of("arc10", "rod", 0)).max()
print("uneven points of an arc: off by %.2g m of a fall of %.2g m" % (off, fall))
check(off < 4e-6 and fall > 5e-4, "uneven points of an arc: off by %g m" % off)

# A sine, three quarters of a circle, and a straight line that goes over into an arc are free of stress: they stay, to round-off
# EA eps/(rho A l) t^2/2 of the rest shape's arithmetic, 1e-12 m. Their points lie on the curve; where the curvature changes,
# tangents are off by h^2 kappa'/6, at the ends by h^2 kappa'/3, and the cubic by 4 h/27 times these.
t = np.linspace(0, 2 * math.pi, 25)
shapes = {"sine": [(x, 0.5 * math.sin(x), 0) for x in t],
          "hook": [(math.cos(a), 0, math.sin(a)) for a in np.linspace(0, 1.5 * math.pi, 19)],
          "cane": [(0, -k / 4, k / 4) for k in range(4, 0, -1)] + [(1 - math.cos(a), math.sin(a) / 2**0.5, -math.sin(a) / 2**0.5) for a in np.linspace(0, 2, 9)]}
for name, at in shapes.items():
    frond.write(name + ".msh", msh(at, [(k, k + 1, 1) for k in range(len(at) - 1)]))
    frond.write(name + ".yaml", SCENE % ("  mesh: %s.msh" % name) )
    frond.runs("run", name + ".yaml", "-gravity", "0,0,0", "-output_dir", "out_" + name)
    first, last = line_of(name, "rod", 0), line_of(name, "rod", 2)
    check(np.abs(last - first).max() < 1e-12, "%s: moves by %g m at rest" % (name, np.abs(last - first).max()))
    if name == "sine":
        h = (2 * math.pi / 24) * 1.12  # slope up to 0.5
        away = np.abs(first[:, 1] - 0.5 * np.sin(first[:, 0])).max()
        check(away < 4 / 27 * h * h * h * 0.5 * (1 / 3 + 1 / 6) + 0.5 * h**4 / 384, "sine: line is off by %g m" % away)
        with h5py.File(frond.path("out_sine", "frame_00000.h5"), "r") as f:
            x = np.linspace(0, 2 * math.pi, 100001)
            length = np.sqrt(1 + (0.5 * np.cos(x))**2)[1:].mean() * 2 * math.pi
            near = f["beams/rod/line/coordinate"][-1]
            check(abs(near - length) < 1e-4 * length, "sine: length %g m, exact %g m" % (near, length))
            check(np.abs(f["beams/rod/line/moment"][:]).max() < 1e-9 * 20e6 * math.pi * 0.04**4 / 64, "sine: no moment at rest")
    if name == "hook":
        check(np.abs(np.hypot(first[:, 0], first[:, 2]) - 1).max() < (math.pi / 12)**4 / 384, "hook: off the circle")


def both(name, mesh, yaml, beams, text, tolerance=0):
    """A mesh against beams and links of a scene. beams: names in the mesh's scene and in the other."""
    frond.write(name + ".yaml", SCENE % ("  mesh: %s.msh" % name))
    frond.write(name + ".msh", mesh)
    frond.runs("run", name + ".yaml", "-output_dir", "out_" + name)
    frond.write(name + "_yaml.yaml", yaml)
    frond.runs("run", name + "_yaml.yaml", "-output_dir", "out_%s_yaml" % name)
    for a, b in beams:
        off = np.abs(line_of(name, a, 2) - line_of(name + "_yaml", b, 2)).max()
        check(off <= tolerance, "%s: %s and %s differ by %g m" % (text, a, b, off))
        check(np.abs(line_of(name, a, 2) - line_of(name, a, 0)).max() > 1e-6, text + ": it moves")


FRAME = SCENE.replace("beams: rod", "beams: [a, b%s]").replace("beam_rod:\n", "beam:\n").replace("  end0: clamp\n%s", """
beam_a: {start: [0, 0, 0], end: [0, 0, 1], elements: 4, end0: clamp}
%s
links: j
link_j: {type: rigid, nodes: [%s]}
""")
mast = [(0, 0, k / 4) for k in range(5)]
arm = [(k / 3, 0, 1) for k in range(1, 4)]
# An L: the same beams and joint as in a scene, hence the same bits.
both("ell", msh(mast + arm, [(0, 1, 1), (1, 2, 1), (2, 3, 1), (3, 4, 1), (4, 5, 1), (5, 6, 1), (6, 7, 1)]),
     FRAME % ("", "beam_b: {start: [0, 0, 1], end: [1, 0, 1], elements: 3}", "a.end, b.start"), [("rod_p0", "a"), ("rod_p1", "b")], "corner")
# A fork whose branches are written before its trunk.
fork = mast + arm + [(0, k / 2, 1) for k in (1, 2)]
both("fork", msh(fork, [(4, 5, 1), (5, 6, 1), (6, 7, 1), (0, 1, 1), (1, 2, 1), (2, 3, 1), (3, 4, 1), (4, 8, 1), (8, 9, 1)]),
     FRAME % (", c", "beam_b: {start: [0, 0, 1], end: [1, 0, 1], elements: 3}\nbeam_c: {start: [0, 0, 1], end: [0, 1, 1], elements: 2}",
              "b.start, a.end, c.start"), [("rod_p0", "b"), ("rod_p1", "a"), ("rod_p2", "c")], "branches", 1e-9)

# A closed ring of radius 1 pulled apart by two opposite forces P: it lengthens by (pi/4 - 2/pi) P R^3/EI (Timoshenko). Within 2.3e-3,
# what docs/beams.md has for eight elements to a quarter circle; here twelve, and the same EA l^2/EI of a quarter's length l. Critical damping of the lowest
# mode, 2.683 sqrt(EI/rho A R^4), leaves (1 + wt) exp(-wt) = 1e-8.
N, P = 48, 1e-3
ring = [(math.cos(2 * math.pi * k / N), math.sin(2 * math.pi * k / N), 0) for k in range(N)]
frond.write("ring.msh", msh(ring, [(k, (k + 1) % N, 1) for k in range(N)]))
frond.write("ring.yaml", """
fluid: false
beams: ring
beam_ring: {mesh: ring.msh, group: rod, diameter: 0.01, EA: 4.05e5, EI: 1, rhoA: 1}
beam_ring_p0_point_load: [%g, 0, 0]
beam_ring_p0_point_load_at: 0
beam_ring_p1_point_load: [-%g, 0, 0]
beam_ring_p1_point_load_at: 0.5
ancf_damping: %g
time_end: 8
time_step: 0.02
output_every: 4
""" % (P, P, 2 * 2.683))
frond.runs("run", "ring.yaml", "-output_dir", "out_ring")
wide = [line_of("ring", "ring_p0", k)[0, 0] - np.interp(0.5, np.linspace(0, 1, len(line_of("ring", "ring_p1", k))), line_of("ring", "ring_p1", k)[:, 0]) for k in (0, 2)]
share = (wide[1] - wide[0]) / ((math.pi / 4 - 2 / math.pi) * P)
print("ring: %.5f of (pi/4 - 2/pi) P R^3/EI" % share)
check(abs(share - 1) < 2.3e-3, "ring: %g of the exact widening" % share)

# Lines of second order: the middle nodes bend the axis. Elements of 15 degrees as arcs: off by angle^4/384 with half of that angle.
text = msh([(math.cos(k * math.pi / 24), math.sin(k * math.pi / 24), 0) for k in range(13)], [])
text = text.replace("$Elements\n0", "$Elements\n6\n" + "\n".join("%d 8 2 1 1 %d %d %d" % (k + 1, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(6)))
frond.write("second.msh", text)
same(run("second", "  mesh: second.msh"), run("arcyaml2", "  start: [1, 0, 0]\n  end: [0, 1, 0]\n  elements: 6\n  curvature: 1\n  normal: [0, 0, 1]"),
     1e-10, "lines of second order")

# In a fluid an axis of any shape keeps the fluid out: the same arc by uneven points, off by 4e-6 of its radius at most, leaves the same
# sites of the lattice.
FLUID = """
domain_lo: [0, 0, 0.3]
domain_hi: [1.2, 1.2, 0.7]
domain_periodic: [x, y, z]
beams: rod
beam_rod: {diameter: 0.1, density: 1000, young: 1e7, end0: clamp, %s}
sph: {dp: 0.05, density: 1000, viscosity: 1, max_speed: 1}
time_end: 1e-4
output_every: 1e-4
"""
counts = []
frond.write("wet.msh", msh([(math.cos(a), math.sin(a), 0.5) for a in uneven], [(k, k + 1, 1) for k in range(10)]))
for name, rod in (("wet", "mesh: wet.msh"), ("wetarc", "start: [1, 0, 0.5], end: [%.17g, %.17g, 0.5], elements: 10, curvature: 1, normal: [0, 0, 1]" %
                                         (math.cos(uneven[-1]), math.sin(uneven[-1])))):
    frond.write(name + ".yaml", FLUID % rod)
    frond.runs("run", name + ".yaml", "-output_dir", "out_" + name)
    with h5py.File(frond.path("out_" + name, "frame_00000.h5"), "r") as f:
        counts.append((f["markers/group"][:] == -1).sum())
check(counts[0] == counts[1] < 24 * 24 * 8, "fluid beside the curve and the arc: %s markers" % counts)


def bad(name, text, *words, code=(1, 3), geometry=None):
    if text is not None:
        frond.write(name + ".msh", text)
    frond.write("bad.yaml", SCENE % (geometry or "  mesh: %s.msh" % name))
    for command in ("run",) if text else ("run", "check"):
        done = subprocess.run([os.path.abspath(sys.argv[1]), command, "bad.yaml"], cwd=sys.argv[2], capture_output=True, text=True, timeout=60)
        lines = [s for s in done.stderr.splitlines() if s.strip()]
        check(done.returncode in code, "%s: exit code %d" % (name, done.returncode))
        check(len(lines) == 1, "%s: one line, not %d: %s" % (name, len(lines), lines[:3]))
        for word in words + ("rod",):
            check(any(word in s for s in lines), "%s: '%s' in %s" % (name, word, lines[:2]))


good = msh(places, chain)
bad("nosuch", None, "nosuch.msh", "cannot open")
bad("text", "hello\n", "no Gmsh mesh", "$MeshFormat")
bad("empty", "", "no Gmsh mesh")
bad("cut", good[:len(good) - 40], "not whole", "$EndElements")
bad("damaged", good.replace("$Nodes\n5", "$Nodes\nfive"), "damaged.msh", "cannot read")
bad("fewer", good.replace("$Elements\n4", "$Elements\n9"), "fewer.msh", "cannot read")
bad("unnamed", msh(places, chain, ("bar",)), "no physical group 'rod'", "bar")
bad("gap", msh(places, [chain[0], chain[1]]), "disconnected")
bad("twice", msh(places + [places[0]], [(4, 2, 1), (1, 3, 1), (5, 4, 1), (3, 0, 1)]), "duplicate nodes", "(0.5, 0.25, 0.125)")
bad("fold", msh(places, chain + [(2, 1, 1)]), "lie upon one another")
bad("double", msh(places, chain + [(2, 4, 1)]), "line element twice")
bad("island", msh(places + [(5, 0, 0), (6, 0, 0), (5, 1, 0)], chain + [(5, 6, 1), (6, 7, 1), (7, 5, 1)]), "disconnected")
bad("zero", msh(places + [places[2]], chain + [(2, 5, 1)]), "zero length", "0.5, 0.25) m")
bad("spiral", msh([(math.cos(k / 3), math.sin(k / 3), k / 9) for k in range(9)], [(k, k + 1, 1) for k in range(8)]), "off a plane", "without twist")
bad("pieceload", msh(fork, [(0, 1, 1), (1, 5, 1), (1, 8, 1)]), "3 beams", "beam_rod_p0_point_load", geometry="  mesh: pieceload.msh\n  point_load: [1, 0, 0]")
plane = msh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 1)]).replace("$Elements\n1", "$Elements\n2")
plane = plane.replace("$EndElements", "2 2 2 7 7 1 2 3\n$EndElements")
bad("plane", plane, "dimension 2", "lines alone")
bad("both", good, "start", "comes from its mesh", geometry="  mesh: both.msh\n  start: [0, 0, 0]")
bad("groupalone", good, "needs a mesh", geometry="  group: rod\n  start: [0, 0, 0]\n  end: [1, 0, 0]")
apptest.report()
