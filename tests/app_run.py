"""A whole run of the frond command: files, units, history, overrides, interruption, a fault, a kill."""
import csv
import glob
import os
import re
import resource
import shutil
import signal
import sys
import time
import xml.etree.ElementTree as ET

import apptest

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

check, near = apptest.check, apptest.near
frond = apptest.Frond(sys.argv[1], sys.argv[2])
frond.write("small.yaml", apptest.SCENE)


def history(folder):
    with open(frond.path(folder, "history.csv"), newline="") as f:
        rows = list(csv.reader(f))
    check(all(len(r) == len(rows[0]) for r in rows), folder + ": every row of history.csv is whole")
    check(all(h.endswith("]") and "[" in h for h in rows[0]), folder + ": every column has a unit: %s" % rows[0])
    return {h.split("[")[0]: (h.split("[")[1][:-1], np.array([float(r[i]) for r in rows[1:]])) for i, h in enumerate(rows[0])}


def datasets(h5):
    found = []
    h5.visititems(lambda name, item: found.append((name, item)) if isinstance(item, h5py.Dataset) else None)
    return found


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def check_frame(path):
    """Units, descriptions, shapes and finite values of a frame."""
    with h5py.File(path, "r") as h:
        for name, d in datasets(h):
            for key in ("unit", "description"):
                check(text(d.attrs.get(key, "")) != "", "%s:%s has the attribute %s" % (os.path.basename(path), name, key))
            check(np.isfinite(d[:]).all(), "%s:%s is finite" % (os.path.basename(path), name))
        n = len(h["markers/position"])
        for name, unit, shape in (("position", "m", (n, 3)), ("velocity", "m/s", (n, 3)), ("density", "kg/m^3", (n,)),
                                  ("pressure", "Pa", (n,)), ("group", "1", (n,))):
            check(h["markers"][name].shape == shape, "markers/%s has shape %s" % (name, shape))
            check(text(h["markers"][name].attrs["unit"]) == unit, "markers/%s is in %s" % (name, unit))
        return float(h.attrs["time"]), int(h.attrs["step"])


def xdmf_times(folder):
    """Times of run.xdmf; every file, dataset and size that it names must be there."""
    root = ET.parse(frond.path(folder, "run.xdmf")).getroot()
    times = [float(t.get("Value")) for t in root.iter("Time")]
    for item in root.iter("DataItem"):
        name, dataset = item.text.strip().split(":")
        with h5py.File(frond.path(folder, name), "r") as h:
            size = tuple(int(n) for n in item.get("Dimensions").split())
            check(h[dataset].shape == size, "%s%s has the size %s of run.xdmf" % (name, dataset, size))
            check(h[dataset].dtype.itemsize == int(item.get("Precision")), "%s%s has the precision of run.xdmf" % (name, dataset))
    return times


def test_files():
    out = frond.runs("run", "small.yaml", "-output_dir", "a/deep/folder")
    for word in ("small: t = 0.01 s after", "beam rod", "body ball", "momentum balance", "transfer audit", "a/deep/folder/run.xdmf"):
        check(word in out, "the summary says '%s'" % word)
    folder = "a/deep/folder"
    frames = sorted(glob.glob(frond.path(folder, "frame_*.h5")))
    check(len(frames) == 6, "0.01 s with a frame each 0.002 s makes 6 frames, not %d" % len(frames))
    times = [check_frame(f)[0] for f in frames]
    for i, t in enumerate(times):
        near(t, 0.002 * i, 1e-12, "time of frame %d" % i)
    check(xdmf_times(folder) == times, "run.xdmf has the frames' times")
    with h5py.File(frames[-1], "r") as h:
        groups = {text(v) for k, v in h["markers"].attrs.items() if k.startswith("group_")}
        check(groups == {"wall_zmin", "wall_zmax", "rod", "ball"}, "names of the boundary groups: %s" % groups)
        line = h["beams/rod/line/position"][:]
        nodes = h["beams/rod/nodes/coordinates"][:]
        near(abs(line[0] - nodes[0, :3]).max(), 0, 1e-14, "the line begins at the first node")
        near(abs(line[-1] - nodes[-1, :3]).max(), 0, 1e-12, "the line ends at the last node")
    table = history(folder)
    check(len(table["time"][1]) >= 10, "a history row each 0.001 s: %d rows" % len(table["time"][1]))
    check(table["time"][1][-1] == 0.01 and (np.diff(table["time"][1]) > 0).all(), "history times rise to the end")
    near(table["rod_tip_z"][1][-1], line[-1, 2], 1e-12, "the history's tip is the frame's")
    with h5py.File(frond.path(folder, "history.h5"), "r") as h:
        check(set(h) == set(table), "history.h5 has the columns of history.csv")
        for name, (unit, values) in table.items():
            check(text(h[name].attrs["unit"]) == unit and text(h[name].attrs["description"]) != "", name + ": unit and description")
            check(np.allclose(h[name][:], values, rtol=1e-14, atol=0), name + ": the same numbers in both files")
    settings = open(frond.path(folder, "settings.txt")).read()
    check("-sph_viscosity 1" in settings and "-beam_rod_young 1e6" in settings, "settings.txt lists the options used")


def test_transfer(folder="a/deep/folder"):
    """Force that leaves the markers arrives: round-off of sums of about 100 terms, in units of the largest force."""
    table = history(folder)
    for what in ("force", "moment"):
        scale = max(abs(table[s + "_f" + c][1]).max() for s in ("rod", "ball", "wall_zmin", "wall_zmax") for c in "xyz")
        lost = table["transfer_%s_lost" % what][1].max()
        check(lost <= 1e-11 * scale, "transfer_%s_lost %.3g against a largest force of %.3g" % (what, lost, scale))


def test_overrides():
    frond.runs("run", "small.yaml", "-output_dir", "b", "-time_end", "0.004", "-output_fields", "velocity,acceleration", "-sph_viscosity", "3")
    with h5py.File(sorted(glob.glob(frond.path("b", "frame_*.h5")))[-1], "r") as h:
        near(h.attrs["time"], 0.004, 1e-12, "-time_end of the command line wins over the file")
        check(set(h["markers"]) == {"index", "position", "velocity", "acceleration"}, "-output_fields: %s" % set(h["markers"]))
    xdmf_times("b")
    check("-sph_viscosity 3" in open(frond.path("b", "settings.txt")).read(), "-sph_viscosity of the command line wins")


def test_overwrite():
    frond.refuses(["run", "small.yaml", "-output_dir", "b"], ["output_dir", "earlier run", "output_overwrite"], 3)
    keep = frond.path("b", "notes.txt")
    open(keep, "w").write("mine\n")
    frond.runs("run", "small.yaml", "-output_dir", "b", "-output_overwrite", "-time_end", "0.002")
    check(len(glob.glob(frond.path("b", "frame_*.h5"))) == 2, "no frame of the earlier run is left")
    check(os.path.exists(keep), "other people's files stay")


def test_nested_and_flat():
    """The same scene with plain keys gives the same history, bit for bit."""
    flat = apptest.SCENE.split("sph:")[0] + "sph_dp: 0.04\nsph_density: 1000\nsph_viscosity: 1\nsph_max_speed: 1\n" + "time_end" + apptest.SCENE.split("time_end")[1]
    frond.write("flat.yaml", flat)
    frond.runs("run", "flat.yaml", "-output_dir", "flat")
    check(open(frond.path("flat", "history.csv")).read() == open(frond.path("a/deep/folder", "history.csv")).read(), "nested and flat keys are the same scene")


def test_check():
    before = sorted(os.listdir(frond.folder))
    out = frond.runs("check", "small.yaml")
    check(sorted(os.listdir(frond.folder)) == before, "frond check writes nothing")
    for word in ("fluid, ", "boundary", "rod", "ball", "wall_zmin", "memory", "time step", "cost", "sound speed 10 ", "h 0.048"):
        check(word in out, "frond check says '%s': %s" % (word, out))


def test_fault(field):
    """A NaN spreads to the neighbours within the step: the line names one of those, in whatever field it shows first."""
    folder = "fault_" + field
    rc, out, err = frond("run", "small.yaml", "-output_dir", folder, "-fault_nan", field + ",30,5", "-sph_check_every", "1", "-output_every", "0", "-time_end", "0.1")
    check(rc == 2, "fault in %s: exit code %d, expected 2" % (field, rc))
    check(len(err.splitlines()) == 1 and err.startswith("frond: error: "), "fault in %s: one error line: %r" % (field, err))
    for word in ("position|velocity|density", r"marker \d+", "step 6", r"time 0\.0"):
        check(re.search(word, err), "fault in %s: the line says '%s': %s" % (field, word, err))
    check("last good frame" in out, "fault in %s: says which frame is good: %s" % (field, out))
    frames = sorted(glob.glob(frond.path(folder, "frame_*.h5")))
    check(len(frames) == 6, "fault in %s before step 6: 6 frames, not %d" % (field, len(frames)))
    for f in frames:
        check_frame(f)
    check(len(xdmf_times(folder)) == len(frames), "fault in %s: run.xdmf is whole" % field)
    check(all(np.isfinite(v).all() for _, v in history(folder).values()), "fault in %s: no NaN in the history" % field)


def wait_for_frames(folder, n, process):
    for _ in range(600):
        if len(glob.glob(frond.path(folder, "frame_*.h5"))) >= n or process.poll() is not None:
            return
        time.sleep(0.05)


def test_signals():
    for number in (signal.SIGINT, signal.SIGTERM):
        folder = "signal_%d" % number
        p = frond.start("run", "small.yaml", "-output_dir", folder, "-time_end", "1000", "-output_every", "0.002")
        wait_for_frames(folder, 3, p)
        p.send_signal(number)
        out, err = p.communicate(timeout=60)
        check(p.returncode == 128 + number, "signal %d: exit code %d" % (number, p.returncode))
        check("interrupted by signal %d" % number in out and not err, "signal %d is reported: %s %s" % (number, out[-300:], err))
        times = xdmf_times(folder)
        near(history(folder)["time"][1][-1], times[-1], 1e-12, "signal %d: history and frames end together" % number)
        check(os.path.exists(frond.path(folder, "history.h5")), "signal %d: history.h5 is written" % number)


def test_kill():
    p = frond.start("run", "small.yaml", "-output_dir", "kill", "-time_end", "1000", "-output_every", "0.001")
    wait_for_frames("kill", 5, p)
    p.kill()
    p.communicate()
    times = xdmf_times("kill")
    check(len(times) >= 4, "a killed run keeps its frames: %d" % len(times))
    for i in range(len(times)):
        check_frame(frond.path("kill", "frame_%05d.h5" % i))
    history("kill")


def test_full_disk():
    """Files may not grow past 40 kB from some frame on: the run ends with one line, and what was there stays whole."""
    p = frond.start("run", "small.yaml", "-output_dir", "full", "-time_end", "1000", "-output_every", "0.001")
    wait_for_frames("full", 3, p)
    resource.prlimit(p.pid, resource.RLIMIT_FSIZE, (40000, 40000))
    out, err = p.communicate(timeout=60)
    check(p.returncode == 3, "full disk: exit code %d, expected 3" % p.returncode)
    check(len(err.splitlines()) == 1 and err.startswith("frond: error: cannot write"), "full disk: one line: %r" % err)
    times = xdmf_times("full")
    check(len(times) >= 3, "full disk: %d frames stay" % len(times))
    for i in range(len(times)):
        check_frame(frond.path("full", "frame_%05d.h5" % i))


LID = """
domain_lo: [0, 0, 0]
domain_hi: [1, 1, 0]
walls: [xmin, xmax, ymin, ymax]
wall_ymax_velocity: [1, 0, 0]
sph: {dim: 2, dp: 0.1, viscosity: 100, max_speed: 1}
time_end: 0.1
"""


def test_lid():
    """A lid slides along itself in a closed box: its markers keep their places, and the fluid below follows it."""
    frond.write("lid.yaml", LID)
    frond.runs("run", "lid.yaml")
    frames = sorted(glob.glob(frond.path("out_lid", "frame_*.h5")))
    with h5py.File(frames[0], "r") as a, h5py.File(frames[-1], "r") as b:
        number = [int(k[6:]) for k, v in b["markers"].attrs.items() if text(v) == "wall_ymax"][0]
        lid, fluid = b["markers/group"][:] == number, b["markers/group"][:] == -1
        check(lid.any() and np.array_equal(a["markers/position"][:][lid], b["markers/position"][:][lid]), "the lid's markers stay")
        check((b["markers/velocity"][:][lid, 0] == 1).all(), "the lid's markers have its velocity")
        top = fluid & (b["markers/position"][:][:, 1] > 0.9)
        check(b["markers/velocity"][:][top, 0].mean() > 0.1, "the fluid below the lid follows")
    check(history("out_lid")["wall_ymax_fx"][1][-1] < 0, "the fluid holds the lid back")


def cube_stl(a):
    """A cube of edge a about the origin: 12 facets, counter-clockwise from outside."""
    lines = ["solid cube"]
    for axis in range(3):
        for side in (-1, 1):
            u, v = [(1, 2), (2, 0), (0, 1)][axis]
            corner = []
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                p = [0, 0, 0]
                p[axis], p[u], p[v] = side * a / 2, s * a / 2, t * a / 2
                corner.append("vertex %g %g %g" % tuple(p))
            if side < 0:
                corner.reverse()
            for i, j, k in ((0, 1, 2), (0, 2, 3)):
                lines += ["facet normal 0 0 0", "outer loop", corner[i], corner[j], corner[k], "endloop", "endfacet"]
    return "\n".join(lines + ["endsolid cube"]) + "\n"


def test_mesh():
    """A cube from an STL file takes the same lattice sites from the fluid as a box."""
    frond.write("cube.stl", cube_stl(130.0))
    options = ("-body_ball_position", "0.3,0.2,0.2", "-time_end", "0.001")
    frond.runs("run", "small.yaml", "-output_dir", "mesh", "-body_ball_shape", "mesh", "-body_ball_file", "cube.stl", "-body_ball_scale", "1e-3", *options)
    frond.runs("run", "small.yaml", "-output_dir", "box", "-body_ball_shape", "box", "-body_ball_size", "0.13,0.13,0.13", *options)
    with h5py.File(frond.path("mesh", "frame_00000.h5")) as a, h5py.File(frond.path("box", "frame_00000.h5")) as b:
        sites = [h["markers/position"][:][h["markers/group"][:] == -1] for h in (a, b)]
        check(np.array_equal(*sites), "fluid sites around the mesh and the box: %d, %d" % (len(sites[0]), len(sites[1])))


def test_carve():
    """Fluid sites against brute force: a turned box across two periodic faces, and the rod."""
    edge, centre, axis, angle = np.array([0.11, 0.17, 0.12]), np.array([0.39, 0.39, 0.1]), np.array([1, 1, 0]) / np.sqrt(2), 0.5
    frond.runs("run", "small.yaml", "-output_dir", "carve", "-time_end", "0.001", "-body_ball_shape", "box", "-body_ball_size", "0.11,0.17,0.12",
               "-body_ball_position", "0.39,0.39,0.1", "-body_ball_axisangle", "1,1,0,0.5")
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    R = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K  # Rodrigues
    sites = (np.stack(np.meshgrid(*[np.arange(10)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 0.5) * 0.04
    inside = np.zeros(len(sites), bool)
    for shift in np.ndindex(3, 3):
        x = sites - 0.4 * (np.array([*shift, 1]) - 1)
        inside |= (np.abs((x - centre) @ R) < edge / 2).all(axis=1)
        inside |= (x[:, 0] > 0.05) & (x[:, 0] < 0.2) & (np.hypot(x[:, 1] - 0.2, x[:, 2] - 0.2) < 0.03)
    with h5py.File(frond.path("carve", "frame_00000.h5")) as h:
        got = h["markers/position"][:][h["markers/group"][:] == -1]
    order = lambda a: a[np.lexsort(np.round(a / 0.02).T)]
    check(len(got) == (~inside).sum() and np.allclose(order(got), order(sites[~inside]), atol=1e-6), "fluid sites: %d, by brute force %d" % (len(got), (~inside).sum()))
    check(inside.sum() > 20, "the structures hold %d sites" % inside.sum())


def test_ranks():
    """One rank for now: two are refused in one line."""
    if not shutil.which("mpirun"):
        return
    rc, out, err = frond("check", "small.yaml", wrapper=("mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"))
    lines = [line for line in err.splitlines() if line.startswith("frond: error:")]
    check(rc == 1 and len(lines) == 1 and "1 MPI rank, not 2" in lines[0], "2 ranks: exit code %d, %s" % (rc, err[:300]))


test_files()
test_transfer()
test_overrides()
test_overwrite()
test_nested_and_flat()
test_check()
test_fault("rho")
test_fault("v")
test_fault("x")
test_signals()
test_kill()
test_full_disk()
test_lid()
test_mesh()
test_carve()
test_ranks()
apptest.report()
