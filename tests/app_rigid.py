"""Lumped beams, joints, overlaps and masses of rigid bodies in scenes of the frond command."""
import csv
import math
import os
import sys
from apptest import SCENE, Frond, check, near, report

frond = Frond(sys.argv[1], sys.argv[2])
examples = sys.argv[3] + "/examples/"


def history(folder):
    with open(frond.path(folder, "history.csv")) as f:
        rows = list(csv.reader(f))
    return {name.split("[")[0]: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def tips(scene, *args):
    """The histories of the scene with ANCF elements and with trunks."""
    out = []
    for kind in ("ancf", "lumped"):
        frond.runs("run", scene, "-beam_type", kind, "-output_dir", kind + scene, "-output_overwrite", *args)
        out.append(history(kind + scene))
    return out


DRY = """
fluid: false
gravity: [0, 0, -0.01]
beams: rod
beam_rod:
  start: [0, 0, 0]
  end: [1, 0, 0]
  elements: 8
  trunks: 16
  diameter: 0.04
  density: 7200
  young: 20e6
  end0: clamp
time_step: 0.005
time_end: 1.695
history_every: 0
"""


def dry():
    # Gravity set on at once, w(t) = sum_n D s_n (1 - cos w_n t), D = q L^4/8EI, s_n = 32 sigma_n/k_n^5: 1.0135, -0.0143, 0.0011.
    # Trunks: D off by 1/N^2, w_1 by -0.47/N^2 and w_n by that times (k_n/k_1)^2, up to t = T_1/2. The geometry adds (D/L)^2 and
    # the steps (w_2 dt)^2/12 w_2 t s_2, both below 1e-4.
    frond.write("dry.yaml", DRY)
    ancf, lumped = tips("dry.yaml")
    q, EI, N = 7200 * math.pi / 4 * 0.04**2 * 0.01, 20e6 * math.pi / 64 * 0.04**4, 16
    D, k = q / (8 * EI), (1.8751, 4.6941)
    bound = 2 / N**2 + 1.0135 * math.pi * 0.47 / N**2
    bound += 0.0143 * math.pi * (k[1] / k[0]) ** 2 * 0.47 / N**2 * (k[1] / k[0]) ** 2 + 2 * 0.0011 + 2e-4
    worst = max(abs(a - b) for a, b in zip(ancf["rod_tip_z"], lumped["rod_tip_z"])) / D
    print("no fluid: tips of both models differ by at most %.5f D, bound %.5f; at the end %.5f and %.5f D"
          % (worst, bound, -ancf["rod_tip_z"][-1] / D, -lumped["rod_tip_z"][-1] / D))
    check(worst < bound, "no fluid: tips differ by %g D, at most %g" % (worst, bound))
    # half a period after the start: 2 s_1 D and at most 2 (|s_2| + s_3) D more
    near(-lumped["rod_tip_z"][-1] / D, 2 * 1.0135, 2 * 0.0154 + bound, "no fluid: tip after half a period")
    # The velocity adds up to the way: trapezoids, dt^2/12 (z''(T) - z''(0)), |z''| <= D sum_n s_n w_n^2 = 4 g sum_n 1/k_n over the
    # N modes of the trunks; without the 1/12 for those that the step does not resolve.
    time, v = lumped["time"], lumped["rod_tip_vz"]
    way = sum((v[i] + v[i + 1]) / 2 * (time[i + 1] - time[i]) for i in range(len(v) - 1))
    most = 4 * 0.01 * sum(1 / (math.pi * (n + 0.5)) for n in range(N)) * 1.2  # k_1 is 1.19 (pi/2), the others nearer
    near(way, lumped["rod_tip_z"][-1], 2 * 0.005**2 * most, "no fluid: tip velocity adds up to the way")


def wet():
    # Both beams hold the same sites of the lattice; their markers are laid out differently, by at most a layer of dp/2 on
    # the radius: that much of the fluid force, which is less than the weight. The tip's fall is below g t^2/2.
    frond.write("wet.yaml", SCENE)
    ancf, lumped = tips("wet.yaml")
    fall = 9.81 * 0.01**2 / 2
    a, b = (h["rod_tip_z"][0] - h["rod_tip_z"][-1] for h in (ancf, lumped))
    print("in fluid: the tips fall by %.4g and %.4g m, free fall %.4g m" % (a, b, fall))
    check(0 < a < fall and 0 < b < fall, "in fluid: the tips fall by %g, %g m, less than %g m" % (a, b, fall))
    check(abs(a - b) < 0.02 / 0.03 * max(a, b), "in fluid: the tips fall by %g and %g m" % (a, b))
    check("rod_0_fz" in lumped and "rod_1_fz" in lumped and "rod_2_fz" not in lumped, "as many trunks as elements")


PENDULUM = """
fluid: false
gravity: [0, 0, -9.81]
bodies: ball
body_ball:
  shape: sphere
  motion: free
  size: [0.1, 0, 0]
  position: [0.1, 0, -1]
joints: pin
joint_pin:
  type: hinge
  a: ball
  point: [0, 0, 0]
  axis: [0, 1, 0]
time_step: 0.001
time_end: 1
history_every: 0
"""


def joint():
    frond.write("pendulum.yaml", PENDULUM)
    frond.runs("run", "pendulum.yaml", "-output_dir", "pendulum")
    h = history("pendulum")
    L = math.hypot(0.1, 1)
    off = max(abs(math.hypot(x, z) - L) for x, z in zip(h["ball_x"], h["ball_z"]))
    check(off < 1e-10, "pendulum: off its circle by %g m" % off)  # constraints to round-off; 17 digits in the table
    # The joints meet their constraints to round-off of coordinates of 1 m and speeds of 1 m/s, at every step: no drift, and it is reported.
    drift = [max(h["joints_constraint_" + k]) for k in ("position", "velocity")]
    print("pendulum: off its joint by at most %.1e m and %.1e m/s in %d steps" % (*drift, len(h["time"]) - 1))
    check(drift[0] < 1e-10 and drift[1] < 1e-10, "pendulum: the joint drifts by %g m, %g m/s" % tuple(drift))
    # RATTLE keeps the energy to (w dt)^2 of its range, w^2 = g/L
    gain = 9.81 * (h["ball_z"][0] - min(h["ball_z"]))
    I = 1 + 0.4 * 0.01 / L**2
    E = [0.5 * I * (u * u + w * w) + 9.81 * z for u, w, z in zip(h["ball_vx"], h["ball_vz"], h["ball_z"])]
    check(max(E) - min(E) < 9.81 / L * 1e-6 * gain + 1e-10, "pendulum: energy changes by %g of %g J/kg" % (max(E) - min(E), gain))
    # amplitude 0.1 rad: quarter period of the compound pendulum, (1 + 0.1^2/16) T0/4
    quarter = math.pi / 2 * math.sqrt(I * L / 9.81) * (1 + math.atan(0.1) ** 2 / 16)
    i = next(i for i, x in enumerate(h["ball_x"]) if x < 0)
    near(i * 0.001, quarter, 0.001 + 1e-4, "pendulum: time of the first passage")


    # PETSc solves the joints' equations: its options reach them, and another factorisation gives the same motion to round-off.
    told = frond.runs("run", "pendulum.yaml", "-output_dir", "cholesky", "-rigid_joint_pc_type", "cholesky", "-rigid_joint_snes_monitor")
    check(told.count("0 SNES Function norm") >= 1000, "pendulum: SNES tells of %d solves" % told.count("0 SNES Function norm"))
    off = max(abs(a - b) for k in "xz" for a, b in zip(h["ball_" + k], history("cholesky")["ball_" + k]))
    check(off < 1e-10, "pendulum: LU and Cholesky part by %g m" % off)


def refusals():
    scene = frond.path("pendulum.yaml")
    for args, words in (
        (["-joint_pin_a", "cat"], ["joint 'pin'", "'cat' is neither"]),
        (["-joint_pin_b", "ball"], ["joint 'pin'", "itself"]),
        (["-joint_pin_axis", "0,0,0"], ["joint 'pin'", "axis"]),
        (["-joint_pin_stiffness", "-2"], ["joint 'pin'", "stiffness"]),
        (["-joint_pin_type", "glue"], ["joint_pin_type", "glue", "slider"]),
        (["-joints", "pin,two"], ["joint 'two'", "joint_two_a"]),
        (["-body_ball_mass", "-1"], ["body_ball_mass", "positive"]),
        (["-body_ball_inertia", "1,-1,1"], ["body_ball_inertia", "positive"]),
        (["-bodies", "ball,other", "-body_other_size", "0.1,0,0", "-body_other_position", "0.2,0,-1", "-body_other_motion", "free"],
         ["'ball' and 'other'", "overlap"]),
    ):
        frond.refuses(["run", scene, *args], words)
    frond.write("noaxis.yaml", PENDULUM.replace("  axis: [0, 1, 0]\n", ""))
    frond.refuses(["run", "noaxis.yaml"], ["joint 'pin'", "joint_pin_axis"])
    for args, words in ((["-beam_type", "chain"], ["beam_type", "chain", "lumped"]), (["-beam_rod_trunks", "-3"], ["beam_rod_trunks", "-3"]),
                        (["-beam_rod_EA", "5"], ["beam_rod_EA", "axial"]), (["-beam_rod_damper", "-1"], ["beam 'rod'", "damping"])):
        frond.refuses(["run", "dry.yaml", "-beam_type", "lumped", *args], words)


def paper():
    frond.runs("run", examples + "lumped_beam.yaml", "-output_dir", "paper")
    tip = -history("paper")["rod_tip_z"][-1]
    # 1 + 1/N^2 times q L^4/(8 EI); the geometry takes (tip/L)^2, about 1e-3
    print("Table 1: tip %.6g m" % tip)
    near(tip / 2.101552e-3, 1.01, 1.5e-3, "Table 1: tip over Eq. 22")


CROSS = """
fluid: false
gravity: [0, 0, -9.81]
beams: [low, high]
beam:
  elements: 6
  diameter: 0.04
  density: 1000
  young: 1e9
beam_low:
  start: [-0.5, 0, 0]
  end: [0.5, 0, 0]
  end0: pin
  end1: pin
beam_high:
  start: [0, -0.3, 0.06]
  end: [0, 0.3, 0.06]
rigid_lubrication_viscosity: 1
rigid_lubrication_cutoff: 0.01
rigid_roughness: 0.001
rigid_contact_modulus: 1e8
rigid_contact_restitution: 0.3
time_step: 1e-4
time_end: 0.2
history_every: 0
"""


def crossing():
    """A beam falls across another one: it stays above it, while without the forces it falls through."""
    frond.write("cross.yaml", CROSS)
    for args, above in (((), True), (("-rigid_contact_modulus", "0", "-rigid_lubrication_viscosity", "0"), False)):
        frond.runs("run", "cross.yaml", "-output_dir", "cross", "-output_overwrite", *args)
        tip = history("cross")["high_tip_z"][-1]
        # free fall 0.196 m; on the other one the stiff short beam stays where it met it but for its sag, far below its radius
        print("a beam across another one: its tip is at %.4f m" % tip)
        check((tip > 0) == above, "a beam across another one: tip at %g m" % tip)
    with open(frond.path("cross", "settings.txt")) as f:
        check("Short-range forces of beams" in f.read(), "settings.txt tells the short-range forces of beams")
    frond.refuses(["run", "cross.yaml", "-beam_high_start", "0,-0.3,0.03", "-beam_high_end", "0,0.3,0.03"], ["'low' and 'high'", "overlap"])
    frond.refuses(["run", "cross.yaml", "-couple_shortrange_samples", "1"], ["couple_shortrange_samples", "1"])
    frond.refuses(["run", "cross.yaml", "-rigid_roughness", "0"], ["rigid_roughness"])


def wet_short():
    """A free beam and a free ball 4 mm apart, a beam near a wall: the forces are there and the momenta are closed to round-off."""
    free = ["-beam_rod_end0", "free", "-beam_rod_start", "0.05,0.2,0.05", "-beam_rod_end", "0.24,0.2,0.05", "-body_ball_motion", "free",
            "-body_ball_position", "0.25,0.2,0.144", "-body_ball_velocity", "0,0,-0.3", "-sph_precision", "double", "-ancf_ts_alpha_radius", "1"]
    forces = ["-rigid_lubrication_viscosity", "20", "-rigid_lubrication_cutoff", "0.03", "-rigid_roughness", "0.001"]
    vz = []
    for args in ([], forces):
        frond.runs("run", "wet.yaml", "-output_dir", "short", "-output_overwrite", *free, *args)
        h = history("short")
        off = max(abs(h["momentum_residual_" + c][-1]) for c in "xyz") / h["momentum_scale"][-1]
        vz.append(h["ball_vz"][-1])
        print("ball over a beam over a wall%s: ball at %.4f m/s, momentum off by %.1e of the largest term" % (", lubricated" if args else "", vz[-1], off))
        # pair sums are in double: round-off of some 1e3 markers over the steps; radius 1 takes a held load as its impulse
        check(off < 1e-11, "momentum off by %g" % off)
    # a restart in the middle has the same bits: the forces carry nothing from step to step
    both = [*free, *forces, "-checkpoint_every", "0.005", "-checkpoint_keep", "9"]
    frond.runs("run", "wet.yaml", "-output_dir", "whole", *both)
    first = sorted(name for name in os.listdir(frond.path("whole")) if name.startswith("checkpoint"))[0]
    frond.runs("run", "wet.yaml", "-output_dir", "again", "-restart", frond.path("whole", first), *both)
    with open(frond.path("whole", "history.csv")) as f, open(frond.path("again", "history.csv")) as g:
        check(f.read().splitlines()[-1] == g.read().splitlines()[-1], "a restart with short-range forces of beams gives other bits")
    check(vz[1] > vz[0] + 1e-3, "lubrication does not slow the ball: %g, %g m/s" % tuple(vz))


dry()
wet()
crossing()
wet_short()
joint()
refusals()
paper()
report()
