"""Motion and forces prescribed over time: walls that move bodily, body forces that ramp.

Walls: markers must be where the integral of the table puts them (linear tables are integrated exactly; 1e-9 m). A box that moves as a whole with its fluid stays in uniform motion (Galileo): single precision's
6e-8, summed over the run's 1000 steps: 6e-5.
Force: a fluid without walls takes the velocity that is the integral of the force. The step is exact for a force linear over it; one that holds a kink misses at most the change of slope times dt^2/8.
"""
import os
import sys

import h5py
import numpy as np

import apptest

frond = apptest.Frond(sys.argv[1], sys.argv[2])


def history(folder):
    return np.genfromtxt(frond.path(folder, "history.csv"), delimiter=",", names=True, deletechars="")


def last(folder):
    names = sorted(n for n in os.listdir(frond.path(folder)) if n.startswith("frame_"))
    return h5py.File(frond.path(folder, names[-1])), h5py.File(frond.path(folder, names[0]))


# A paddle at xmin, which slides in and turns about its foot.
TANK = """
scene_name: paddle
gravity: [0, -9.81, 0]
domain_lo: [0, 0, 0]
domain_hi: [0.6, 0.4, 0]
walls: [xmin, xmax, ymin]
wall_xmin_motion: paddle.csv
wall_xmin_pivot: [0, 0, 0]
fluid_hi: [0.6, 0.2, 0]
sph: {dim: 2, dp: 0.02, density: 1000, viscosity: 0.01, max_speed: 2}
time_end: 0.1
output_every: 0.05
"""
frond.write("paddle.csv", "# s, m/s, rad/s\nt, vx, wz\n0, 0, 0\n\n0.04, 0.4, -1\n0.1, 0.1, 0.5\n")
frond.write("paddle.yaml", TANK)
frond.runs("run", "paddle.yaml")
shift, angle = 0.5 * 0.04 * 0.4 + 0.06 * 0.25, -0.5 * 0.04 * 1 + 0.06 * -0.25
rows = history("out_paddle")
apptest.near(rows["wall_xmin_x[m]"][-1], shift, 1e-12, "displacement of the paddle")
end, start = last("out_paddle")
with end, start:
    groups = {v: int(k.split("_")[1]) for k, v in ((k, end["markers"].attrs[k]) for k in end["markers"].attrs if k.startswith("group_"))}
    groups = {(k.decode() if isinstance(k, bytes) else k): v for k, v in groups.items()}
    g = start["markers/group"][:]
    x0, x1 = start["markers/position"][:], end["markers/position"][:]
    mine = g == groups["wall_xmin"]
    c, s = np.cos(angle), np.sin(angle)
    want = x0[mine].copy()
    want[:, 0], want[:, 1] = shift + c * x0[mine, 0] - s * x0[mine, 1], s * x0[mine, 0] + c * x0[mine, 1]
    apptest.near(np.abs(x1[mine] - want).max(), 0, 1e-9, "markers of the paddle")
    rest = (g >= 0) & ~mine
    apptest.check(rest.sum() > 100 and (x0[rest] == x1[rest]).all(), "the other walls rest")
    apptest.check((end["markers/group"][:] == -2).sum() == 0, "no marker leaves")

# A restart goes on with the wall and the force where they were.
frond.write("push.csv", "t,fx\n0,0\n0.1,5\n")
push = ["-body_force_file", "push.csv", "-output_dir", "out_again", "-output_overwrite"]
frond.runs("run", "paddle.yaml", *push)
whole = history("out_again")
frond.runs("run", "paddle.yaml", *push, "-checkpoint_every", "0.05", "-checkpoint_keep", "9")
points = sorted(n for n in os.listdir(frond.path("out_again")) if n.startswith("checkpoint_"))
apptest.check(len(points) == 2, "2 checkpoints: %s" % points)
frond.runs("run", "paddle.yaml", "-body_force_file", "push.csv", "-output_dir", "out_again", "-restart", os.path.join("out_again", points[0]))
again = history("out_again")
apptest.check(len(whole) == len(again) and all((whole[c] == again[c]).all() for c in whole.dtype.names), "restart with a paddle and a force over time: the same bits")

# A box full of fluid in uniform motion.
faces = ("xmin", "xmax", "ymin", "ymax")
BOX = """
scene_name: box
domain_lo: [0, 0, 0]
domain_hi: [1, 1, 0]
walls: [xmin, xmax, ymin, ymax]
sph: {dim: 2, dp: 0.05, density: 1000, viscosity: 1000, max_speed: 0.1, background_pressure: 100}
fluid_velocity: [0.1, 0.05, 0]
time_end: 0.5
output_every: 0.5
""" + "".join("wall_%s: {motion: constant, velocity: [0.1, 0.05, 0]}\n" % f for f in faces)
frond.write("box.yaml", BOX)
frond.runs("run", "box.yaml")
rows = history("out_box")
for axis, u in (("x", 0.1), ("y", 0.05)):
    apptest.near(rows["fluid_momentum_%s[kg/s]" % axis][-1] / rows["fluid_mass[kg/m]"][-1], u, 6e-5 * u, "velocity of the fluid that moves with its box, " + axis)
apptest.near(rows["fluid_kinetic[J/m]"][-1], 500 * 0.0125, 1.2e-4 * 6.25, "its energy")

# Body forces.
PERIODIC = """
scene_name: force
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0]
domain_periodic: [x, y]
sph: {dim: 2, dp: 0.02, density: 1000, viscosity: 0.01, max_speed: 1, body_force: [2, 0, 0]}
time_end: 0.1
"""
frond.write("force.yaml", PERIODIC)
frond.write("force.csv", "t,fy,fx\n0,0,0\n0.03,4,0\n0.1,0,0\n")
for name, options, want in (("ramp", "-body_force_ramp 0.06", (2 * 0.06 / 2 + 2 * 0.04, 0)), ("table", "-body_force_file force.csv", (0.2, 0.5 * 0.1 * 4)),
                            ("symplectic", "-body_force_ramp 0.06 -sph_integrator symplectic", (0.14, 0))):
    frond.runs("run", "force.yaml", "-output_dir", "out_" + name, *options.split())
    rows = history("out_" + name)
    slope, dt = 4 / 0.03 + 4 / 0.07, rows["dt[s]"].max()
    for axis, u in zip("xy", want):
        apptest.near(rows["fluid_momentum_%s[kg/s]" % axis][-1] / rows["fluid_mass[kg/m]"][-1], u, slope * dt**2 / 8 + 1e-6, "%s: velocity along %s" % (name, axis))
    apptest.near(rows["momentum_residual_x[kg/s]"][-1], 0, 1e-5 * 160 * 0.2, name + ": momentum balance")

# Wrong input.
for text, words in (("t,vx\n0,1\n0.05,\n0.1,2\n", ["line 3", "vx", "gap"]), ("t,vx\n0,1\n0.1\n", ["line 3", "1 cells"]), ("t,vx\n0,1\n0,2\n0.1,0\n", ["line 3", "increase"]),
                    ("t,vx\n0,1\n0.05,2\n", ["cover", r"0\.05", r"0\.1"]), ("t,vx\n0.01,1\n0.2,2\n", ["cover", r"0\.01"]), ("t,vx\n0,nan\n0.1,2\n", ["vx", "nan", "finite"]),
                    ("t,speed\n0,1\n", ["speed", "none of"]), ("0,1\n0.1,2\n", ["header", "t first"]), ("t,vx,vx\n0,1,1\n0.1,2,2\n", ["vx", "twice"]), ("t,vx\n", ["no rows"]), ("", ["no rows"]),
                    ("t,vx\n0,1\n0.1,fast\n", ["line 3", "fast"])):
    frond.write("bad.csv", text)
    frond.refuses(["run", "paddle.yaml", "-output_dir", "refused", "-wall_xmin_motion", "bad.csv"], ["wall_xmin_motion", "bad.csv", *words], 3)
    frond.refuses(["run", "force.yaml", "-output_dir", "refused", "-body_force_file", "bad.csv"], ["body_force_file", "bad.csv"], 3)
frond.write("turn.csv", "t,wz\n0,1\n1,1\n")
frond.write("out.csv", "t,vx\n0,-9\n1,-9\n")
for options, words, code in (("-wall_xmin_motion nosuch.csv", ["nosuch.csv"], 3), ("-wall_xmin_motion out.csv", ["wall_xmin_motion", "out of the domain"], 1), ("-wall_ymax_motion constant", ["wall_ymax_motion", "walls"], 1),
                             ("-wall_xmax_motion turn.csv", ["turn.csv", "wall_xmax_pivot"], 1), ("-wall_xmax_omega 0,0,1", ["wall_xmax_omega", "constant"], 1),
                             ("-wall_xmax_motion constant -wall_xmax_omega 0,0,1", ["wall_xmax_pivot"], 1), ("-wall_xmax_velocity 1,0,0", ["along itself", "wall_xmax_motion"], 1),
                             ("-body_force_ramp -1", ["body_force_ramp", "-1"], 1)):
    frond.refuses(["run", "paddle.yaml", "-output_dir", "refused", *options.split()], words, code)
apptest.check(not os.path.exists(frond.path("refused")), "refused runs leave no folder behind")
apptest.report()
