"""Openings of the fluid: a uniform stream stays one, what comes in is counted, the balances know of it, bad ones are refused."""
import csv
import glob
import os
import sys

import apptest

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

frond = apptest.Frond(sys.argv[1], sys.argv[2])
frond.env["OMP_NUM_THREADS"] = "1"
check, near = apptest.check, apptest.near

STREAM = """
scene_name: stream
domain_lo: [0, 0, 0]
domain_hi: [0.6, 0.4, 0.3]
domain_periodic: [y, z]
fluid_velocity: [1, 0, 0]
openings: [in, out]
opening_in: {face: xmin, type: inflow, speed: 1}
opening_out: {face: xmax, type: outflow, pressure: 0}
sph: {dp: 0.05, density: 1000, viscosity: 1, max_speed: 1}
time_end: 0.16
output_every: 0.16
history_every: 0.01
progress_every: 0
"""
CHANNEL = """
scene_name: channel
domain_lo: [0, 0, 0]
domain_hi: [0.6, 1, 0]
walls: [ymin, ymax]
openings: [in, out]
opening_in: {face: xmin, type: inflow, speed: 1, profile: parabolic}
opening_out: {face: xmax, type: outflow, pressure: 0}
fluid_velocity: [1, 0, 0]
sph: {dim: 2, dp: 0.1, density: 1, viscosity: 0.1, max_speed: 1.5}
time_end: 0.6
output_every: 0.6
history_every: 0.02
progress_every: 0
"""
frond.write("stream.yaml", STREAM)
frond.write("channel.yaml", CHANNEL)


def history(folder):
    with open(frond.path(folder, "history.csv"), newline="") as f:
        rows = list(csv.reader(f))
    return {h.split("[")[0]: np.array([float(r[i]) for r in rows[1:]]) for i, h in enumerate(rows[0])}


def last(folder):
    with h5py.File(sorted(glob.glob(frond.path(folder, "frame_*.h5")))[-1]) as f:
        return {k: f["markers/" + k][:] for k in ("position", "velocity", "pressure", "group")}


def counted(folder):
    """Markers: those at first, plus those that came in, less those that went out, are those there are: exactly. Masses: to the
    round-off of sums of some thousand terms, 1e-12."""
    h, now = history(folder), last(folder)
    with h5py.File(sorted(glob.glob(frond.path(folder, "frame_*.h5")))[0]) as f:
        first = np.sum(f["markers/group"][:] == -1)
    net = sum(h[n + "_markers_in"][-1] - h[n + "_markers_out"][-1] for n in ("in", "out"))
    check(np.sum(now["group"] == -1) == first + net, "%s: %d markers, %d + %d came in" % (folder, np.sum(now["group"] == -1), first, net))
    mass = sum(h[n + "_mass_in"] - h[n + "_mass_out"] for n in ("in", "out"))
    error = np.max(np.abs(h["fluid_mass"] - h["fluid_mass"][0] - mass)) / h["fluid_mass"][0]
    check(error < 1e-12, "%s: masses differ by %.2g" % (folder, error))
    check(np.max(np.abs(h["mass_residual"])) < 1e-12 * h["fluid_mass"][0], folder + ": the audit's mass")
    return h


def stream():
    """A uniform stream is a solution of the discrete equations too: all velocity differences and pressures are 0, so velocities
    keep every bit. 0.16 s at 1 m/s are 3.2 spacings: 3 layers of 8 x 6 markers come in, and as many go out (the first crosses
    at 0.025 s, the fourth at 0.175 s)."""
    for name, args, layer in (("stream", [], 48), ("stream2d", ["-sph_dim", "2", "-domain_periodic", "y"], 8),
                              ("streamz", ["-domain_lo", "0,0,0", "-domain_hi", "0.3,0.4,0.6", "-domain_periodic", "x,y", "-fluid_velocity", "0,0,-1",
                                           "-opening_in_face", "zmax", "-opening_out_face", "zmin"], 48)):
        frond.runs("run", "stream.yaml", *args, "-output_dir", name)
        h, now = counted(name), last(name)
        fluid = now["group"] == -1
        want = np.array([0, 0, -1.0] if name == "streamz" else [1.0, 0, 0])
        check(np.all(now["velocity"][fluid] == want), "%s: velocities are off by %.2g" % (name, np.max(np.abs(now["velocity"][fluid] - want))))
        check(h["fluid_compression_max"].max() == 0, name + ": compression %.2g" % h["fluid_compression_max"].max())
        check(h["in_markers_in"][-1] == 3 * layer and h["out_markers_out"][-1] == 3 * layer, "%s: %d in, %d out" % (name, h["in_markers_in"][-1], h["out_markers_out"][-1]))


def channel():
    """Momentum: what comes and goes with markers, and the forces of the zones, close the balance to the round-off of the pair
    sums: 1e-12 of the largest term in double, some 1e-6 in single precision. Threads change no bit."""
    for precision, bound in (("single", 1e-5), ("double", 1e-11)):
        frond.runs("run", "channel.yaml", "-output_dir", precision, "-sph_precision", precision)
        h = counted(precision)
        residual = np.max(np.abs(h["momentum_residual_x"])) / h["momentum_scale"][-1]
        check(h["in_mass_in"][-1] > 0.4, "%s: the fluid came in" % precision)
        check(residual < bound, "%s: momentum residual %.2g" % (precision, residual))
        check(h["momentum_scale"][-1] > 0.3, "momentum passed")
        print("channel, %s: momentum closes to %.1e" % (precision, residual))
    frond.env["OMP_NUM_THREADS"] = "2"
    frond.runs("run", "channel.yaml", "-output_dir", "two")
    frond.env["OMP_NUM_THREADS"] = "1"
    with open(frond.path("single", "history.csv")) as f, open(frond.path("two", "history.csv")) as g:
        check(f.read() == g.read(), "1 and 2 threads give the same history")


def pressures():
    """Flow between two given pressures: dp H^2/(12 mu L) (1 - 96/pi^4 exp(-pi^2 nu t/H^2)) after the ramp, counted from its middle.
    The place of an opening is uncertain by less than half a spacing, 0.025 of 0.5 m at each end, so the flow by 10 %."""
    text = CHANNEL.replace("speed: 1, profile: parabolic", "given: pressure, pressure: 1.2, ramp: 0.3").replace("fluid_velocity: [1, 0, 0]\n", "")
    frond.write("pressures.yaml", text + "probes: q\nprobe_q: {type: plane, position: [0.25, 0, 0], edge1: [0, 1, 0]}\n")
    frond.runs("run", "pressures.yaml", "-sph_dp", "0.05", "-domain_hi", "0.5,1,0", "-sph_viscosity", "0.2", "-time_end", "2.5", "-output_every", "2.5", "-output_dir", "pressures")
    h = counted("pressures")
    exact = 1 - 96 / np.pi**4 * np.exp(-(np.pi**2) * 0.2 * (2.5 - 0.15))
    flow = np.mean(h["q_flow"][h["time"] > 2.4])
    print("channel between two pressures: flow %.4f, exact %.4f" % (flow, exact))
    near(flow, exact, 0.1, "flow between two pressures")


def warnings():
    """An outlet whose pressure is above the inlet's sends fluid back: said, once each. A reserve that is too small ends the run."""
    frond.write("back.yaml", CHANNEL.replace("speed: 1, profile: parabolic", "pressure: 0, given: pressure").replace("outflow, pressure: 0", "outflow, pressure: 1"))
    code, out, err = frond("run", "back.yaml", "-fluid_velocity", "-1,0,0", "-output_dir", "back")
    check(code == 0 and err.count("back flow through opening 'in' (inflow)") == 1 and err.count("opening 'out' (outflow)") == 1, "back flow: %d %s" % (code, err))
    counted("back")
    frond.refuses(["run", "channel.yaml", "-openings_reserve", "2", "-output_dir", "small"], ["opening 'in'", "no marker is left", "openings_reserve"], code=None)


def refused():
    frond.write("gap.csv", "t,speed\n0,1\n")
    frond.write("wrong.csv", "t,pressure\n0,1\n9,1\n")
    base = ["run", "channel.yaml", "-output_dir", "bad"]
    for args, words in (
            (["-opening_in_speed", "-1"], ["opening 'in'", "speed.*-1", "0 or more"]),
            (["-opening_in_pressure", "3"], ["opening 'in' prescribes the velocity", "pressure is given"]),
            (["-opening_in_file", "gap.csv"], ["speed and opening_in_file"]),
            (["-opening_in_given", "pressure"], ["opening 'in' prescribes the pressure", "speed is given"]),
            (["-opening_out_profile", "parabolic"], ["opening 'out'", "parabolic has no meaning"]),
            (["-opening_in_ramp", "-1"], ["opening 'in'", "ramp.*-1"]),
            (["-opening_in_face", "xmiddle"], ["opening_in_face", "xmiddle", "xmin"]),
            (["-opening_in_face", "zmin"], ["opening 'in'", "zmin", "no meaning in a 2D"]),
            (["-opening_in_face", "none"], ["opening 'in' needs", "position"]),
            (["-opening_in_lo", "0,0.2,0", "-opening_in_hi", "0,0.45,0"], ["opening 'in'", "not a whole number"]),
            (["-opening_in_lo", "0,0.2,0", "-opening_in_hi", "0,1.2,0"], ["opening 'in'", "must lie in the domain"]),
            (["-opening_out_face", "xmin"], ["openings 'out' and 'in' overlap"]),
            (["-openings", "in,out,in"], ["in"]),
            (["-domain_periodic", "x"], ["opening 'in'", "periodic"]),
            (["-sph_integrator", "verlet"], ["opening 'in'", "verlet"]),
            (["-sph_shifting", "sun", "-sph_gradient_correction", "bonet"], ["opening 'in'|sph_gradient_correction"]),
            (["-openings_reserve", "-3"], ["openings_reserve = -3"]),
            (["-walls", "xmin,ymin,ymax", "-wall_xmin_motion", "constant", "-wall_xmin_velocity", "0.1,0,0"], ["opening 'in'", "xmin moves"]),
            (["-bodies", "ball", "-body_ball_size", "0.2,0,0", "-body_ball_position", "0.1,0.5,0", "-body_ball_motion", "fixed"], ["opening 'in'", "lies in its zone"]),
            (["-fluid", "false", "-time_step", "1e-3"], ["openings: 'in'|nothing to simulate"])):
        frond.refuses([*base, *args], words)
    file = CHANNEL.replace("speed: 1,", "file: gap.csv,")
    frond.write("file.yaml", file)
    frond.refuses(["run", "file.yaml", "-output_dir", "bad"], ["gap.csv", "do not cover the run"], code=3)
    frond.refuses(["run", "file.yaml", "-output_dir", "bad", "-opening_in_file", "wrong.csv"], ["wrong.csv", "pressure.*none of t, speed"], code=3)
    check(not os.path.exists(frond.path("bad")), "nothing is made by what is refused")


stream()
channel()
pressures()
warnings()
refused()
apptest.report()
