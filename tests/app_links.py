"""Links of a scene: two beams of a rigid link move as one beam; a body on a beam swings, dry and in a fluid; runs cut in two by a
checkpoint end as those that are not."""
import glob
import math
import sys

import apptest

near = apptest.near
frond = apptest.Frond(sys.argv[1], sys.argv[2])
frond.env["OMP_NUM_THREADS"] = "1"

HEAD = """
gravity: [0, 0, -9.81]
fluid: false
time_step: 1e-3
time_end: 0.05
history_every: 0
output_every: 1
progress_every: 0
beam_diameter: 0.04
beam_density: 7200
beam_young: 20e6
"""
frond.write("whole.yaml", HEAD + """
beams: mast
beam_mast: {start: [0, 0, 0], end: [1, 0, 0], elements: 4, end0: pin}
""")
frond.write("linked.yaml", HEAD + """
beams: [mast, boom]
beam_elements: 2
beam_mast: {start: [0, 0, 0], end: [0.5, 0, 0], end0: pin}
beam_boom: {start: [0.5, 0, 0], end: [1, 0, 0]}
links: [middle]
link_middle:
  type: rigid
  nodes: [mast.end, boom.0]
""")


def history(folder):
    """Column name -> values."""
    with open(frond.path(folder, "history.csv")) as f:
        names = [n.split("[")[0] for n in f.readline().strip().split(",")]
        rows = [[float(x) for x in line.split(",")] for line in f]
    return {n: [row[i] for row in rows] for i, n in enumerate(names)}


frond.runs("run", "whole.yaml")
frond.runs("run", "linked.yaml", "-checkpoint_every", "0.02")
one, two = history("out_whole"), history("out_linked")
apptest.check(len(one["time"]) == len(two["time"]) == 51, "rows of the history")
# The same equations in another order: Newton's tolerance, 1e-9 of each of 50 steps' first residual.
for c in "xyz":
    near(two["boom_tip_" + c][-1], one["mast_tip_" + c][-1], 1e-8, "tip of linked beams, " + c)
apptest.check(abs(one["mast_tip_z"][-1]) > 5e-3, "the beam falls")

point = sorted(glob.glob(frond.path("out_linked", "checkpoint_*20.h5")))
if apptest.check(point, "a checkpoint was written"):
    frond.runs("run", "linked.yaml", "-restart", point[0], "-output_dir", "out_again")
    again = history("out_again")
    for c in "xyz":
        apptest.check(again["boom_tip_" + c][-1] == two["boom_tip_" + c][-1], "bits of the restarted run, " + c)

# A body hung on a steel rod: a rigid pendulum of rod (m, l) and sphere (M, r, its centre at l + r), from rest at 90 degrees.
frond.write("pendulum.yaml", HEAD + """
beams: rod
beam_rod: {start: [0, 0, 0], end: [0.5, 0, 0], elements: 4, end0: pin, young: 2e11}
bodies: ball
body_ball: {shape: sphere, size: [0.06, 0, 0], position: [0.56, 0, 0], density: 3000, motion: free}
links: hook
link_hook: {type: rigid, nodes: rod.end, body: ball}
""")
frond.runs("run", "pendulum.yaml", "-time_end", "0.2", "-checkpoint_every", "0.1")
swing = history("out_pendulum")
# Repulsion and lubrication leave a beam and the body that it is attached to alone: the same motion to the bit
# (but for the last step, which is cut to the end of the run).
frond.runs("run", "pendulum.yaml", "-time_end", "0.05", "-rigid_contact_modulus", "1e7", "-rigid_lubrication_viscosity", "1",
           "-rigid_lubrication_cutoff", "0.01", "-rigid_roughness", "1e-3", "-output_dir", "out_short")
short = history("out_short")
apptest.check(all(short["rod_tip_" + c][:-1] == swing["rod_tip_" + c][:len(short["time"]) - 1] for c in "xyz"), "no short-range force at the attachment")
m, l, g, r = 7200 * math.pi / 4 * 0.04 ** 2 * 0.5, 0.5, 9.81, 0.06
M = 3000 * 4 / 3 * math.pi * r ** 3
inertia, lever = m * l * l / 3 + M * (l + r) ** 2 + 0.4 * M * r * r, m * l / 2 + M * (l + r)
angle, rate, h = 0.0, 0.0, 1e-5
for _ in range(20000):  # leapfrog, error (h g/l)^2
    rate += h / 2 * g * lever / inertia * math.cos(angle)
    angle += h * rate
    rate += h / 2 * g * lever / inertia * math.cos(angle)
# The integrators' dt^2 w^3 T/12 of the path, with w = 5 rad/s: 2e-6 m; the rod's own bending and stretching, (M g) l^3/(3 EI).
near(swing["ball_z"][-1], -(l + r) * math.sin(angle), 1e-5, "height of a body that swings on a rod")
near(swing["ball_x"][-1], (l + r) * math.cos(angle), 1e-5, "place of a body that swings on a rod")
point = frond.path("out_pendulum", "checkpoint_000000100.h5")
frond.runs("run", "pendulum.yaml", "-time_end", "0.2", "-checkpoint_every", "0.1", "-restart", point, "-output_dir", "out_pendulum2")
again = history("out_pendulum2")
for name in ("ball_x", "ball_z", "ball_wy", "hook_fx", "rod_tip_vz"):
    apptest.check(again[name][-1] == swing[name][-1], "bits of the restarted pendulum, " + name)

# In a fluid, free to fly: the momentum of fluid, beam and body together, staggered and iterated, and from a checkpoint.
frond.write("wet.yaml", apptest.SCENE.replace("end: [0.2, 0.2, 0.2]", "end: [0.19, 0.2, 0.2]").replace("  end0: clamp\n", "")
            .replace("motion: fixed", "motion: free").replace("position: [0.31, 0.2, 0.2]", "position: [0.25, 0.2, 0.2]")
            .replace("density: 1000\n  position", "density: 2500\n  position").replace("scene_name: small", "scene_name: wet")
            + "links: hook\nlink_hook: {type: rigid, nodes: rod.end, body: ball}\nhistory_every: 0\nprogress_every: 0\n")
for how in ([], ["-couple_iterations", "6"], ["-couple_loads", "linear", "-couple_iterations", "6"]):
    folder = "out_wet%d" % len(how)
    frond.runs("run", "wet.yaml", *how, "-output_dir", folder, "-checkpoint_every", "0.005")
    wet = history(folder)
    # The force between beam and body cancels to the attachment's tolerance, 1e-8; what remains is the pair sums' single precision,
    # 6e-8 of forces that are sums over some 100 neighbours of either sign: 6e-6.
    for c in "xyz":
        near(wet["momentum_residual_" + c][-1], 0, 1e-5 * wet["momentum_scale"][-1], "momentum in a fluid, %s %s" % (c, how))
    apptest.check(abs(wet["hook_fz"][-1]) > 1e-3, "the link carries a force")
    point = sorted(glob.glob(frond.path(folder, "checkpoint_*.h5")))[0]
    frond.runs("run", "wet.yaml", *how, "-checkpoint_every", "0.005", "-restart", point, "-output_dir", folder + "again")
    again = history(folder + "again")
    for name in ("ball_x", "ball_z", "hook_fz", "rod_tip_z"):
        apptest.check(again[name][-1] == wet[name][-1], "bits of the restarted run in a fluid, %s %s" % (name, how))
apptest.report()
