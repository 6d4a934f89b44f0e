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
audit: false
progress_every: 0
"""
frond.write("all.yaml", SCENE)
frond.write("dry.yaml", SCENE[: SCENE.index("fluid_velocity")].replace("domain_lo: [0, 0, 0]\ndomain_hi: [0.6, 0.36, 0.4]\ndomain_periodic: [x, y]\nwalls: [zmin, zmax]\n", "")
            + "fluid: false\ntime_step: 1e-4\noutput_every: 1000\nhistory_every: 0\nprogress_every: 0\n")


OPEN = """
scene_name: open
domain_lo: [0, 0, 0]
domain_hi: [0.6, 1, 0]
walls: [ymin, ymax]
openings: [in, out]
opening_in: {face: xmin, type: inflow, speed: 1, profile: parabolic}
opening_out: {face: xmax, type: outflow, pressure: 0}
fluid_velocity: [1, 0, 0]
sph: {dim: 2, dp: 0.1, density: 1, viscosity: 0.1, max_speed: 1.5}
output_fields: [velocity, density, pressure, group, acceleration]
output_every: 1000
history_every: 0
progress_every: 0
"""
frond.write("open.yaml", OPEN)


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


def columns():
    """A history with other columns is told from one of another run, and a new folder takes the run on."""
    args = ["run", "dry.yaml", "-time_end", "1e-3", "-output_dir"]
    frond.runs(*args, "columns", "-audit", "false", "-checkpoint_every", "5e-4", "-checkpoint_keep", "9")
    half = os.path.relpath(checkpoints("columns")[0], frond.folder)
    again = ["-restart", half, "-restart_changed", "-audit", "true"]
    code, out, err = frond(*args, "columns", *again)
    check(code != 0 and "has other columns" in err and "'beams_damped[J]' now" in err and len(err.strip().splitlines()) == 1, "other columns: %d: %s" % (code, err))
    frond.runs(*args, "columns_new", *again)


def cut(name, args, steps=200, threads="1", scene="all.yaml", dt=1e-4):
    """`steps` steps in one go without a checkpoint, against half of them, a checkpoint, and the rest."""
    args = [*args, "-time_end", repr(steps * dt), "-output_every", repr(steps * dt / 10)]
    if scene != "dry.yaml" and "variable" not in args:
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
    cut("plain", ["-audit", "true"], threads="2")
    cut("variable", ["variable"], steps=600)
    cut("verlet", ["-sph_integrator", "verlet", "-sph_reinit", "none"])
    cut("symplectic", ["-sph_integrator", "symplectic"], steps=100)
    cut("iterated", ["-couple_iterations", "4"], steps=60)
    cut("linear", ["-couple_loads", "linear"], steps=60)
    cut("linear_iterated", ["-couple_loads", "linear", "-couple_iterations", "4"], steps=40)
    cut("double", ["-audit", "true", "-sph_precision", "double", "-sph_wall", "bce", "-sph_kernel", "wendland"], steps=60)
    cut("substeps", ["-ancf_substeps", "3", "-rigid_substeps", "2"], steps=60)
    for kind in ("beuler", "cn", "euler", "basicsymplectic"):
        extra = ["-ancf_ts_basicsymplectic_type", "2"] if kind == "basicsymplectic" else []
        cut(kind, ["-ancf_ts_type", kind, *extra, "-ancf_substeps", "4"], steps=40)
    cut("open", ["-audit", "true"], steps=200, scene="open.yaml", dt=1.5e-3, threads="2") # 3 layers come in
    columns()
    cut("dry", ["-audit", "true"], scene="dry.yaml", threads="2")
    # Newton's method fails with 2 iterations: steps are halved
    cut("dry_halved", ["-ancf_snes_max_it", "2", "-beam_rod_end0", "pin", "-beam_young", "2e7", "-time_step", "5e-3"], steps=40, scene="dry.yaml", dt=5e-3)


def others():
    """Integrators with a memory that PETSc keeps begin anew at a checkpoint: the same bits with the same checkpoints."""
    types = [(kind, ["-ancf_ts_type", kind]) for kind in ("rk", "bdf", "theta", "alpha", "rosw", "arkimex", "ssp", "glee")]
    for kind, args in (*types, ("adaptive", ["-ancf_ts_adapt_type", "basic"]), ("multipliers", ["-ancf_constraints", "multipliers"])):
        common = [*args, "-sph_dt", "1e-4", "-time_end", "4e-3", "-output_every", "1e-3", "-checkpoint_every", "2e-3", "-ancf_substeps", "4"]
        frond.runs("run", "all.yaml", *common, "-output_dir", kind)
        shutil.copytree(frond.path(kind), frond.path(kind + "_again"))
        frond.runs("run", "all.yaml", *common, "-output_dir", kind + "_again", "-restart", os.path.relpath(checkpoints(kind + "_again")[0], frond.folder))
        same_run(kind, kind + "_again", kind)


def run_of_four():
    frond.runs("run", "all.yaml", "-sph_dt", "1e-4", "-time_end", "4e-3", "-output_every", "1e-3", "-checkpoint_every", "1e-3", "-output_dir", "four",
               "-checkpoint_keep", "3")
    check([number(f) for f in checkpoints("four")] == [20, 30, 40], "the last 3 checkpoints are kept: %s" % checkpoints("four"))
    check(not glob.glob(frond.path("four", "*.part")), "no unfinished file is left")


def at_the_end():
    """A run that was killed after its last checkpoint, before its last files: the restart makes them without a step."""
    args = ["run", "all.yaml", "-sph_dt", "1e-4", "-time_end", "4e-3", "-output_every", "1e-3", "-checkpoint_every", "1e-3", "-output_dir"]
    shutil.copytree(frond.path("four"), frond.path("ended"))
    os.remove(frond.path("ended", "history.h5"))
    os.remove(frond.path("ended", "run.xdmf"))
    out = frond.runs(*args, "ended", "-restart", "ended")
    check("step 40" in out and "after 40 steps" in out, "a restart at time_end: " + out)
    same_run("four", "ended", "restart at time_end")
    with open(frond.path("four", "run.xdmf")) as f, open(frond.path("ended", "run.xdmf")) as g:
        check(f.read() == g.read(), "restart at time_end: run.xdmf")
    # a number of the history that is none
    rows = open(frond.path("ended", "history.csv")).read().splitlines()
    for bad in ("nan", "-inf", "1e999"):
        cells = rows[5].split(",")
        cells[3] = bad
        with open(frond.path("ended", "history.csv"), "w") as f:
            f.write("\n".join([*rows[:5], ",".join(cells), *rows[6:]]) + "\n")
        frond.refuses([*args, "ended", "-restart", "ended"], ["history.csv", "not that of the checkpoint"], code=3)
    # into a new folder there is nothing to write
    out = frond.runs(*args, "ended_new", "-restart", "four")
    check("after 40 steps" in out and not frames("ended_new"), "a restart at time_end into a new folder: " + out)


GO_ON = ["run", "all.yaml", "-sph_dt", "1e-4", "-output_every", "1e-3", "-time_end", "5e-3", "-output_dir", "never", "-restart"]


def damaged():
    """Every way in which a file can be wrong is found before anything is read from it; the good one beside it is named."""
    last = frond.path("four", "checkpoint_000000040.h5")
    good = open(last, "rb").read()

    def refused(data, words, what):
        with open(last, "wb") as f:
            f.write(data)
        for target in ("four", "four/checkpoint_000000040.h5"):
            frond.refuses([*GO_ON, target], ["checkpoint_000000040.h5", *words, "last good.*checkpoint_000000030.h5"], code=3)
        check(not os.path.exists(frond.path("never")), what + ": nothing is made")

    for n in (0, 100, 512, 513, len(good) // 2, len(good) - 1):
        refused(good[:n], ["damaged" if n >= 20 else "no checkpoint"], "cut to %d bytes" % n)
    refused(good + b"x", ["damaged"], "one byte more")
    rng = np.random.default_rng(7)
    bits = [*rng.integers(0, 8 * len(good), 10), 8 * 30 + 1, 8 * 511, 8 * 512, 8 * len(good) - 1]
    for bit in bits:
        bad = bytearray(good)
        bad[bit // 8] ^= 1 << (bit % 8)
        refused(bytes(bad), ["damaged|no checkpoint|newer|older"], "bit %d" % bit)
    refused(good.replace(b"frond-checkpoint 3", b"frond-checkpoint 4", 1), ["format 4", "newer", "reads format 3"], "newer")
    refused(good.replace(b"frond-checkpoint 3", b"frond-checkpoint 2", 1), ["format 2", "older", "reads format 3"], "older")
    refused(open(frond.path("four", "frame_00000.h5"), "rb").read(), ["no checkpoint"], "a frame")
    refused(b"%PDF-1.4 something else" * 100, ["no checkpoint"], "another program's file")
    with open(last, "wb") as f:
        f.write(good)
    frond.refuses([*GO_ON, "absent.h5"], ["absent.h5", "No such file"], code=3)
    os.makedirs(frond.path("empty"), exist_ok=True)
    frond.refuses([*GO_ON, "empty"], ["no checkpoint in 'empty'"], code=3)
    print("%d damaged files refused" % (2 * (len(bits) + 10)), flush=True)


def other_scene():
    """A restart with other options is refused with the differences, and done when asked for; what may differ may."""
    for args, words in ((["-sph_viscosity", "2"], ["was sph_viscosity 1, is sph_viscosity 2", "restart_changed"]),
                        (["-beam_rod_damping", "3"], ["unknown option"]),
                        (["-sph_xsph", "0.2"], ["sph_xsph 0.2 is new"]),
                        (["-sph_dp", "0.02"], ["was sph_dp 0.04"])):
        frond.refuses([*GO_ON, "four", *args], words)
    frond.refuses([*GO_ON, "four", "-sph_dp", "0.02", "-restart_changed"], ["of another scene|saved fluid has"], code=None)
    frond.refuses([*GO_ON[:7], "3.9e-3", *GO_ON[8:], "four"], ["0.004 s is after time_end = 0.0039"])
    for args, words in ((["-checkpoint_every", "-2"], ["checkpoint_every = -2", ">= 0"]), (["-checkpoint_keep", "0"], ["checkpoint_keep = 0", "at least 1"])):
        frond.refuses(["run", "all.yaml", "-time_end", "1e-3", *args], words)
    out = frond.runs(*GO_ON[:8], "-output_dir", "more", "-restart", "four", "-sph_viscosity", "2", "-restart_changed")
    check("sph_viscosity" in out and "begins here" in out, "changed options and the missing history are said: " + out)
    rows = open(frond.path("more", "history.csv")).read().splitlines()
    check(rows[1].split(",")[1] == "41" and rows[-1].split(",")[1] == "50", "the new folder's history goes from step 41 to 50")
    check([os.path.basename(f) for f in frames("more")] == ["frame_00005.h5"], "the frames go on in number: %s" % frames("more"))
    with open(frond.path("more", "history.csv"), "w") as f:
        f.write(rows[0] + "\n" + rows[1] + "\n")
    frond.refuses([*GO_ON[:8], "-output_dir", "more", "-restart", "four"], ["history.csv", "not that of the checkpoint"], code=3)


if __name__ == "__main__":
    variants()
    others()
    run_of_four()
    at_the_end()
    damaged()
    other_scene()
    apptest.report()
