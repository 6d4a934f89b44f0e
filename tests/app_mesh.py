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
bad("loop", msh(places, chain + [(2, 1, 1)]), "closed loop")
bad("island", msh(places + [(5, 0, 0), (6, 0, 0), (5, 1, 0)], chain + [(5, 6, 1), (6, 7, 1), (7, 5, 1)]), "disconnected")
bad("branch", msh(places + [(5, 0, 0)], chain + [(0, 5, 1)]), "branches at (0.5, 0.25, 0.125)", "links")
bad("zero", msh(places + [places[2]], chain + [(2, 5, 1)]), "zero length", "0.5, 0.25) m")
bad("uneven", msh([(0, 0, 0), (1, 0, 0), (3, 0, 0)], [(0, 1, 1), (1, 2, 1)]), "evenly spaced", "node 1")
bad("spiral", msh([(k * math.cos(k), k * math.sin(k), k) for k in range(5)], [(k, k + 1, 1) for k in range(4)]), "arc", "straight line")
bad("most", msh([(math.cos(k), math.sin(k), 0) for k in range(5)], [(k, k + 1, 1) for k in range(4)]), "half a circle")
plane = msh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 1)]).replace("$Elements\n1", "$Elements\n2")
plane = plane.replace("$EndElements", "2 2 2 7 7 1 2 3\n$EndElements")
bad("plane", plane, "dimension 2", "lines alone")
bad("both", good, "start", "comes from its mesh", geometry="  mesh: both.msh\n  start: [0, 0, 0]")
bad("groupalone", good, "needs a mesh", geometry="  group: rod\n  start: [0, 0, 0]\n  end: [1, 0, 0]")
apptest.report()
