"""app_loads.py FROND FOLDER SOURCE - permanent loads of beams in a scene, against beam theory and the elastica; what is refused."""
import math
import re
import sys

import apptest
import h5py
import numpy as np

check, near = apptest.check, apptest.near
frond = apptest.Frond(sys.argv[1], sys.argv[2])

L, EI, RHOA, NEL = 1.0, 1.0, 1.0, 8
EA = 1e6 * EI / L**2
W1 = 3.516 * math.sqrt(EI / RHOA) / L**2  # first frequency of the cantilever, rad/s

HEAD = """
fluid: false
beam_elements: %d
beam_diameter: 0.01
beam_EA: %g
beam_EI: %g
beam_rhoA: %g
beam_start: [0, 0, 0]
beam_end: [%g, 0, 0]
ancf_strain: engineering
history_every: 0
output_every: 100
progress_every: 0
""" % (NEL, EA, EI, RHOA, L)


def history(folder):
    """Column name -> values."""
    with open(frond.path(folder, "history.csv")) as f:
        names = [n.split("[")[0] for n in f.readline().strip().split(",")]
        rows = [[float(x) for x in line.split(",")] for line in f]
    return {n: [row[i] for row in rows] for i, n in enumerate(names)}


# Small loads, all in one scene, each along another axis. Nodes of cubic elements are exact; geometry changes deflections by a
# share of the order of the slope squared, and motion at critical damping is (1 + wt) exp(-wt) = 2e-8 of them after wt = 21.
F, Q, M = 1e-3 * EI / L**2, 2e-3 * EI / L**3, 1e-3 * EI / L
frond.write("small.yaml", HEAD + """
beams: [tip, mid, line, end, both]
beam_end0: clamp
beam_tip: {point_load: [0, 0, %g]}
beam_mid: {point_load: [0, %g, 0], point_load_at: 0.4}
beam_line: {line_load: [0, 0, %g]}
beam_end: {moment1: [0, 0, %g]}
beam_both: {end0: pin, end1: pin, moment0: [0, %g, 0], moment1: [0, %g, 0]}
ancf_damping: %g
time_step: 0.02
time_end: 6
""" % (F, F, Q, M, M, -M, 2 * W1))
frond.runs("run", "small.yaml")
h = history("out_small")
a, tol = 0.4 * L, 1e-6 + (F * L**2 / EI)**2
last = {n: v[-1] for n, v in h.items()}
near(last["tip_tip_z"] / (F * L**3 / (3 * EI)), 1, tol, "force at the tip, F L^3/(3 EI)")
near(last["mid_tip_y"] / (F * a * a * (3 * L - a) / (6 * EI)), 1, tol, "force at 0.4 L, F a^2 (3L - a)/(6 EI)")
near(last["line_tip_z"] / (Q * L**4 / (8 * EI)), 1, tol, "line load, q L^4/(8 EI)")
near(last["end_tip_y"] / (M * L**2 / (2 * EI)), 1, tol, "moment, M L^2/(2 EI)")

# Large ones: the elastica of Bisshopp and Drucker (1945) for F L^2/EI = 1, 0.5 % at 8 elements as issue and docs have it; a
# moment 2 pi EI/L makes a circle, whose gap docs/beams.md has as 1.4e-3 L.
frond.write("large.yaml", HEAD + """
beams: [bent, ring]
beam_end0: clamp
beam_bent: {point_load: [0, %g, 0]}
beam_ring: {moment1: [0, 0, %g]}
beam_load_ramp: 10
ancf_damping: %g
time_step: 0.05
time_end: 20
""" % (EI / L**2, 2 * math.pi * EI / L, W1))
frond.runs("run", "large.yaml", "-output_every", "20")
last = {n: v[-1] for n, v in history("out_large").items()}
near(last["bent_tip_y"] / 0.3017, 1, 5e-3, "elastica, deflection")
near((L - last["bent_tip_x"]) / 0.0564, 1, 5e-3, "elastica, shortening")
gap = math.hypot(last["ring_tip_x"], last["ring_tip_y"])
print("roll-up: gap %.3g L" % (gap / L))
check(gap < 3e-3 * L, "roll-up: ends are %g L apart" % (gap / L))
check(gap > 1e-5 * L, "roll-up: the gap has the size of the element's error")
with h5py.File(frond.path("out_large", "frame_00001.h5"), "r") as f:
    x = f["beams/ring/line/position"][:]
    off = np.abs(np.hypot(x[:, 0], x[:, 1] - L / (2 * math.pi)) - L / (2 * math.pi)).max()
    check(off < 3e-3 * L, "roll-up: off the circle by %g m" % off)

# The audit knows the work of the moments: without damping, what they do becomes energy. A sudden moment drives all modes, the
# n-th with about 1/n^2 of the work and ((n - 1/2) pi)^2 rad/s; trapezoids and alpha2 are off by (w dt)^2/12 of it, which the eighth,
# the last that 8 elements represent, makes 2e-3/64 and the lower ones less, up to 16 unresolved ones 3e-2/256: below 1e-3 in all.
frond.write("work.yaml", HEAD + """
beams: arm
beam_arm: {end0: clamp, moment1: [0, 0, 0.5]}
ancf_ts_alpha_radius: 1
time_step: 2.5e-4
time_end: 0.5
""")
frond.runs("run", "work.yaml")
h = history("out_work")
residual = h["beams_energy_residual"]
energy = max(abs(x) for x in h["beams_kinetic"]) if "beams_kinetic" in h else 0
print("work of a moment: residual %.3g of %.3g J" % (max(abs(x) for x in residual), energy))
check(energy > 1e-2 and max(abs(x) for x in residual) < 1e-3 * energy, "energy balance with a moment")

# In a fluid, a free beam: the balance of momentum knows the impulse of the load. The fixed ball's share of the residual, of second
# order in the step, is that of the same run without the load, whose motion differs by 1e-2 at most: (2 N/m x 0.15 m)/(0.8 kg) x
# 0.01 s is 4e-3 m/s beside 0.1 m/s of falling, so that the residuals agree to a hundredth of the impulse.
frond.write("fluid.yaml", apptest.SCENE)
frond.runs("run", "fluid.yaml", "-beam_rod_end0", "free", "-output_dir", "out_still")
frond.runs("run", "fluid.yaml", "-beam_rod_end0", "free", "-beam_rod_line_load", "0,0,2", "-output_dir", "out_fluid")
still, h = history("out_still"), history("out_fluid")
impulse = 2 * 0.15 * 0.01
off = max(abs(h["momentum_residual_" + a][-1] - still["momentum_residual_" + a][-1]) for a in "xyz")
print("momentum in a fluid: residual off by %.3g of %.3g N s" % (off, impulse))
check(off < 1e-2 * impulse, "momentum with a line load: residual off by %g kg m/s" % off)

# A load that one iteration of Newton's method cannot follow: smaller steps come first, then one line that names beam, element, node and time,
# with the last checkpoint to go on from.
frond.write("steep.yaml", HEAD + """
beams: [calm, steep]
beam_end0: clamp
beam_calm: {point_load: [0, %g, 0]}
beam_steep: {point_load: [0, 1e15, 0], load_ramp: 10}
time_step: 0.01
time_end: 1
""" % (EI / L**2))
rc, out, err = frond("run", "steep.yaml", "-ancf_snes_max_it", "1", "-checkpoint_every", "0.02")
check(rc == 2 and re.fullmatch(r"frond: error: Newton failed \(\w+\) at t = \S+ s even with the step halved down to \S+ s: largest residual \S+ N at beam 1, "
                               r"element \d+ of \d+, node \d+; use a smaller step .*", err.strip()), "Newton's failure: exit code %d, %s" % (rc, err.strip()[:400]))
saved = re.search(r"checkpoint of step \d+, t = \S+ s: go on with -restart (\S+)", out)
if check(saved, "Newton's failure: no checkpoint offered: " + out[-400:]):
    frond.runs("run", "steep.yaml", "-restart", saved.group(1), "-restart_changed", "-beam_steep_point_load", "0,1,0", "-time_end", "0.05")

BAD = HEAD + "beams: rod\nbeam_rod: {end0: clamp, %s}\ntime_step: 0.01\ntime_end: 0.01\n"
for text, words in (
        ("moment0: [0, 0, 1]", ("beam_rod_moment0", "clamped")),
        ("moment1: [1, 0, 0]", ("beam_rod_moment1", "along the beam", "twist")),
        ("point_load: [1, 0, 0], point_load_at: 1.5", ("beam_rod_point_load_at = 1.5", r"\[0, 1\]")),
        ("point_load: [1, 0]", ("beam_rod_point_load", "2 numbers")),
        ("load_ramp: -1", ("beam_rod_load_ramp = -1", "0 .at once. or more")),
        ("line_load: [1, nan, 0]", ("beam_rod_line_load", "finite"))):
    frond.write("bad.yaml", BAD % text)
    frond.refuses(["run", "bad.yaml"], words)
apptest.report()
