"""Checkpoints of the frond command: a run that is cut in two ends in the bits of one that is not; damaged files are refused."""
import glob
import os
import shutil
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
frond.env["OMP_NUM_THREADS"] = "1"

# Fluid with a clamped ANCF beam, a beam of rigid trunks, two bodies joined by a hinge, one free and one that moves as prescribed.
SCENE = """
scene_name: all
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.6, 0.36, 0.4]
domain_periodic: [x, y]
walls: [zmin, zmax]
beams: [rod, chain]
beam_elements: 2
beam_diameter: 0.06
beam_density: 2000
beam_young: 1e5
beam_rod: {start: [0.05, 0.1, 0.2], end: [0.2, 0.1, 0.2], end0: clamp}
beam_chain: {type: lumped, start: [0.05, 0.28, 0.2], end: [0.2, 0.28, 0.2], end0: pin}
bodies: [ball, cube, mover]
body_shape: sphere
body_size: [0.05, 0, 0]
body_density: 3000
body_motion: free
body_ball_position: [0.31, 0.1, 0.2]
body_cube: {shape: box, size: [0.08, 0.08, 0.08], position: [0.31, 0.1, 0.3], omega: [0, 1, 0]}
body_mover: {position: [0.45, 0.25, 0.2], motion: prescribed, velocity: [0, 0.2, 0.1]}
joints: pin
joint_pin: {type: hinge, a: ball, b: cube, point: [0.31, 0.1, 0.25], axis: [1, 0, 0], stiffness: 0.1}
fluid_velocity: [0.2, 0.05, 0]
sph:
  dp: 0.04
  density: 1000
  viscosity: 1
  max_speed: 1
output_fields: [velocity, density, pressure, group, acceleration]
output_every: 1000
history_every: 0
progress_every: 0
"""
frond.write("all.yaml", SCENE)


def arrays(path):
    """Every dataset of an HDF5 file as numbers."""
    found = {}
    with h5py.File(path, "r") as f:
        f.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
        found["time"], found["step"] = f.attrs.get("time"), f.attrs.get("step")
    return found


def same_h5(a, b, what):
    """Both files hold the same numbers, bit for bit but for the sign of zero."""
    one, two = arrays(a), arrays(b)
    check(one.keys() == two.keys() and len(one) > 2, what + ": the same datasets")
    bad = [k for k in one if k in two and not np.array_equal(one[k], two[k])]
    return check(not bad, "%s: these differ: %s" % (what, ", ".join(bad[:6])))


def same_csv(a, b, what):
    with open(a) as f, open(b) as g:
        one, two = f.read().splitlines(), g.read().splitlines()
    ok = check(len(one) == len(two) > 2, "%s: %d and %d lines of history" % (what, len(one), len(two)))
    for i, (x, y) in enumerate(zip(one, two)):
        if x == y:
            continue
        if i == 0 or any(float(p) != float(q) for p, q in zip(x.split(","), y.split(","))):
            columns = [c for c, p, q in zip(one[0].split(","), x.split(","), y.split(",")) if p != q]
            return check(False, "%s: row %d differs in %s" % (what, i, ", ".join(columns[:6])))
    return ok


def frames(folder):
    return sorted(glob.glob(frond.path(folder, "frame_*.h5")))


def checkpoints(folder):
    return sorted(glob.glob(frond.path(folder, "checkpoint_*.h5")))


def same_run(a, b, what):
    """Two folders hold the same run: frames, history, and the last checkpoints, which are all of the state."""
    fa, fb = frames(a), frames(b)
    check([os.path.basename(f) for f in fa] == [os.path.basename(f) for f in fb] and fa, what + ": the same frames")
    for f in fa:
        same_h5(f, os.path.join(frond.path(b), os.path.basename(f)), what + ": " + os.path.basename(f))
    same_csv(frond.path(a, "history.csv"), frond.path(b, "history.csv"), what)
    same_h5(frond.path(a, "history.h5"), frond.path(b, "history.h5"), what + ": history.h5")
    if checkpoints(a) and checkpoints(b):
        check(os.path.basename(checkpoints(a)[-1]) == os.path.basename(checkpoints(b)[-1]), what + ": the same last checkpoint")
        same_h5(checkpoints(a)[-1], checkpoints(b)[-1], what + ": state at the end")
    return len(fa)


def number(path):
    return int(os.path.basename(path)[11:20])


def cut(name, args, steps=200, threads="1", scene="all.yaml"):
    """`steps` steps in one go without a checkpoint, against half of them, a checkpoint, and the rest."""
    dt = 1e-4
    args = [*args, "-time_end", repr(steps * dt), "-output_every", repr(steps * dt / 10)]
    if "false" not in args and "variable" not in args:
        args += ["-sph_dt", repr(dt)]
    args = [a for a in args if a != "variable"]
    frond.runs("run", scene, *args, "-output_dir", name + "_whole")
    frond.runs("run", scene, *args, "-output_dir", name, "-checkpoint_every", repr(steps * dt / 2), "-checkpoint_keep", "9")
    # the checkpoints themselves change nothing
    same_csv(frond.path(name + "_whole", "history.csv"), frond.path(name, "history.csv"), name + ": with and without checkpoints")
    files = checkpoints(name)
    check(len(files) == 2, "%s: 2 checkpoints, not %d" % (name, len(files)))
    half = os.path.relpath(files[0], frond.folder)
    # into another folder that holds the first half, with more rows and frames than the checkpoint knows of
    shutil.copytree(frond.path(name), frond.path(name + "_again"))
    frond.env["OMP_NUM_THREADS"] = threads
    out = frond.runs("run", scene, *args, "-output_dir", name + "_again", "-restart", half.replace(name, name + "_again", 1))
    frond.env["OMP_NUM_THREADS"] = "1"
    check("step %d" % number(half) in out, name + ": the restart says from where")
    n = same_run(name + "_whole", name + "_again", name)
    check(n >= 10, "%s: %d frames" % (name, n))
    print("%-22s %d steps in one go, %d + restart + %d: the same bits in %d frames and %d rows" %
          (name, number(files[-1]), number(half), number(files[-1]) - number(half), n,
           len(open(frond.path(name, "history.csv")).readlines()) - 1), flush=True)
    for folder in (name + "_whole", name + "_again"):
        shutil.rmtree(frond.path(folder))


def variants():
    cut("plain", [], threads="2")
    cut("variable", ["variable"], steps=600)
    cut("verlet", ["-sph_integrator", "verlet", "-sph_reinit", "none"])
    cut("symplectic", ["-sph_integrator", "symplectic"], steps=100)
    cut("iterated", ["-couple_iterations", "4"], steps=60)
    cut("double", ["-sph_precision", "double", "-sph_wall", "bce", "-sph_kernel", "wendland"], steps=60)
    cut("substeps", ["-ancf_substeps", "3", "-rigid_substeps", "2"], steps=60)
    for kind in ("beuler", "cn", "euler", "basicsymplectic"):
        extra = ["-ancf_ts_basicsymplectic_type", "2"] if kind == "basicsymplectic" else []
        cut(kind, ["-ancf_ts_type", kind, *extra, "-ancf_substeps", "4"], steps=40)


if __name__ == "__main__":
    variants()
    apptest.report()
