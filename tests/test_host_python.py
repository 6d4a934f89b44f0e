#!/usr/bin/python3
"""test_host_python.py EXAMPLES: the Python module against what is known of scenes, and the tutorial as it stands. 77: no numpy."""
import ctypes
import os
import re
import runpy
import sys

try:
    import numpy as np
except ImportError:
    print("SKIPPED: no numpy (Debian: python3-numpy)")
    sys.exit(77)
import frond

examples = sys.argv[1]
failed = 0


def check(ok, what):
    global failed
    if not ok:
        failed += 1
        print("FAILED: " + what)


def layout(header, name):
    """Members of a struct in a public header, in order: name and number of elements."""
    with open(os.path.join(examples, os.pardir, "src", header), encoding="utf-8") as f:
        text = re.sub(r"/\*.*?\*/", "", f.read(), flags=re.S)
    inner = re.search(r"typedef struct \{([^{}]*)\} %s;" % name, text).group(1)
    for declaration in inner.split(";")[:-1]:
        for member in declaration.strip().removeprefix("const ").split(None, 1)[1].split(","):
            word, size = re.fullmatch(r"\s*\**(\w+)(?:\[(\d+)\])?\s*", member).groups()
            yield word, int(size or 1)


# The structs of the module are those of the headers.
for header, name, mirror in (("ancf_petsc/ancf.h", "AncfBeamSpec", frond._BeamSpec), ("sph_cuda/sph.h", "SphFields", frond._Fields), ("couple/couple.h", "CoupleAudit", frond._Audit)):
    ours = [(n, getattr(kind, "_length_", 1)) for n, kind in mirror._fields_]
    check(ours == list(layout(header, name)), "%s: the module has %s, the header %s" % (name, ours, list(layout(header, name))))


def coarse():
    """The cantilever in fluid, in a few hundred markers: d / dp = 1 and a small tank."""
    return frond.Scene(os.path.join(examples, "cantilever_fluid.yaml"), sph_dp=0.04, domain_lo=[-0.08, -0.08, -0.2], domain_hi=[1.12, 0.08, 0.12], time_end=1)


a, b = coarse(), coarse()
check(a.surfaces[-1] == "rod" and len(a.beams) == 1 and not a.bodies, "surfaces %s" % a.surfaces)

# Views share memory; fields are what the views say.
x, v, f = a.markers("rod")
tip = a.beam("rod").positions[-1]
before = tip.copy()
for _ in range(10):
    a.step()
check(not np.array_equal(before, tip) and np.array_equal(tip, a.beam("rod").positions[-1]), "a view shows the present state")
check(a.beam("rod").positions.base is not None and not a.beam("rod").positions.flags.owndata, "positions are a view")
x, v, f = a.markers("rod")
fields = a.fields("x", "v", "group")
check(np.array_equal(fields["x"][fields["group"] == len(a.surfaces) - 1], x), "markers of the beam in the fluid's fields")
load = a.load("rod")
check(np.allclose(f.sum(0), load["force"], rtol=0, atol=1e-12 * np.abs(f).sum()), "load is the sum of the marker forces")
for k in ("force", "moment", "power"):
    check(np.abs(load[k + "_lost"]).max() <= 1e-12 * np.abs(f).sum(), "%s lost: %s" % (k, load[k + "_lost"]))

# Two scenes in one process do not know of each other; rolling back gives the same bits.
for _ in range(10):
    b.step()
check(np.array_equal(a.fields("x")["x"], b.fields("x")["x"]), "two scenes stepped alike are alike")
state = a.save()
for _ in range(5):
    a.step()
once, t = a.fields("x", "v", "rho"), a.t
a.restore(state)
check(a.steps == 10 and a.t < t, "back at step 10: %d" % a.steps)
for _ in range(5):
    a.step()
check(a.t == t and all(np.array_equal(once[k], n) for k, n in a.fields("x", "v", "rho").items()), "the same bits after going back")
a.close()
b.close()

# Errors: the library's one line; the options of one scene are not those of the next.
for options, word in (({"sph_dp": -1}, "sph_dp"), ({"no_such_option": 1}, "no_such_option"), ({"sph_viscosity": "thick"}, "thick")):
    try:
        frond.Scene(os.path.join(examples, "cantilever_fluid.yaml"), **options)
        check(False, "%s was taken" % options)
    except frond.Error as error:
        check(word in str(error) and "\n" not in str(error), "error '%s' should name %s in one line" % (error, word))
        print("refused: %s" % error)
try:
    frond.Scene("no_such_file.yaml")
    check(False, "a missing file was taken")
except frond.Error as error:
    check("no_such_file" in str(error), "error '%s' names the file" % error)

# Any function of the headers.
S = (frond.Real * 4)()
frond.library.AncfShape.restype = None
frond.library.AncfShape(frond.Real(0.25), frond.Real(2.0), S)
check(abs(S[0] + S[2] - 1) < 1e-15, "AncfShape %s" % list(S))
count = frond.Int()
with frond.Scene(os.path.join(examples, "beam_vacuum.yaml")) as scene:
    frond.call("AncfGetNumNodes", scene.beam("rod")._beams._h, ctypes.byref(count))
check(count.value == 33, "33 nodes, not %d" % count.value)

# A prestressed string of a tube keeps its tension; other names are refused.
string = frond.Beams()
string.add((0, 0, 0), (1, 0, 0), 4, 0.02, 1000, 1e9, end0="pin", end1="pin", inner=0.01, pretension=50)
string.setup()
string.advance(1e-3)
check(np.abs(string.coordinates[0][:, 1:3]).max() == 0, "a string without loads stays straight")
try:
    string.add((0, 0, 0), (1, 0, 0), 4, 0.02, 1000, 1e9, tension=50)
    check(False, "a wrong name is taken")
except TypeError as error:
    check("tension" in str(error), "the error names the argument: %s" % error)

try:
    import petsc4py  # noqa: F401

    print("with petsc4py")
except ImportError:
    print("without petsc4py (Debian: python3-petsc4py)")
print("== tutorial")
runpy.run_path(os.path.join(examples, "python_tutorial.py"))
print("%d failed" % failed)
sys.exit(1 if failed else 0)
