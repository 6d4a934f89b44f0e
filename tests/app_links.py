"""Links of a scene: two beams of a rigid link move as one beam, and a run cut in two by a checkpoint ends as one that is not."""
import glob
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
apptest.report()
