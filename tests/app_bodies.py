"""Bodies in the fluid through the frond command: periodic and open sides, own loads, drag, a floating and a neutral body.

With a fourth argument the fine versions, else coarse ones.
"""
import csv
import math
import sys
from apptest import Frond, check, near, report

frond = Frond(sys.argv[1], sys.argv[2])
fine = len(sys.argv) > 4


def history(folder):
    with open(frond.path(folder, "history.csv")) as f:
        rows = list(csv.reader(f))
    return {name.split("[")[0]: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


SIDES = """
domain_lo: [0, 0, -0.5]
domain_hi: [0.4, 0.4, 0.5]
domain_periodic: [x, y]
bodies: disc
body_disc:
  shape: cylinder
  size: [0.06, 0.02, 0]
  density: 2000
  position: [0.21, 0.2, 0]
  velocity: [1, 0, 0]
  motion: free
sph:
  dim: 2
  dp: 0.02
  viscosity: 5
  max_speed: 1
  precision: double
time_end: 0.2
output_every: 0.2
"""


def sides():
    # Seven spacings further along x everything is the same but for the period in between; sums in another order: round-off,
    # which viscous flow does not amplify.
    frond.write("sides.yaml", SIDES)
    runs = []
    for x in (0.21, 0.35):
        frond.runs("run", "sides.yaml", "-output_dir", "x%g" % x, "-body_disc_position", "%g,0.2,0" % x)
        runs.append(history("x%g" % x))
    a, b = runs
    off = max(abs(v - w) for v, w in zip(a["disc_vx"], b["disc_vx"]))
    print("through a periodic side: centre at %.4f m of 0.4 m, speed %.6f m/s, another place %.6f m/s, off by %.1e" %
          (b["disc_x"][-1], b["disc_vx"][-1], a["disc_vx"][-1], off))
    check(b["disc_x"][-1] > 0.4 and off < 1e-10, "a body through a periodic side: speed off by %g m/s" % off)
    near(b["disc_x"][-1] - a["disc_x"][-1], 0.14, 1e-10, "a body through a periodic side: place")
    # an open side: outside it feels no fluid and keeps its velocity
    frond.runs("run", "sides.yaml", "-output_dir", "open", "-body_disc_position", "0.3,0.2,0", "-domain_periodic", "y", "-time_end", "0.5")
    h = history("open")
    v = [w for x, w in zip(h["disc_x"], h["disc_vx"]) if x > 0.4 + 0.06 + 2 * 1.2 * 0.02]  # radius and kernel
    check(len(v) > 10 and max(v) == min(v) and 0 < v[0] < 1, "a body through an open side: %d rows, %g to %g m/s" % (len(v), min(v), max(v)))


ARRAY = """
domain_lo: [0, 0, -0.5]
domain_hi: [1, 1, 0.5]
domain_periodic: [x, y]
bodies: disc
body_disc:
  shape: cylinder
  size: [0.126157, 1, 0]
  density: 2
  position: [0.5, 0.5, 0]
  motion: free
  load: [1, 0, 0]
sph:
  dim: 2
  dp: 0.05
  density: 1
  viscosity: 1
  max_speed: 1
  kernel: wendland
  h_over_dp: 1.5
  reinit: none
  body_force: [-1.0526315789, 0, 0]
time_end: 0.2
output_every: 0.2
"""


def array():
    # A free disk pulled through a periodic fluid by its own load, the fluid by as much the other way: terminal velocity against
    # Sangani and Acrivos, Int. J. Multiphase Flow 8 (1982): a fixed cylinder at c = 0.05 takes F = 15.558 mu U, U the mean velocity
    # over the cell, F with the mean pressure gradient G on its own area. Here that is a body force of the fluid alone, load =
    # (1 - c) F, U = (1 - c) (V - u). Bound: 0.6 dp/R, the surface being known to dp/4 (test_couple_array.c); Re = 0.02.
    dp = 0.025 if fine else 0.05
    frond.write("array.yaml", ARRAY)
    frond.runs("run", "array.yaml", "-sph_dp", str(dp), "-output_dir", "array")
    h = history("array")
    c = 0.05
    u = h["fluid_momentum_x"][-1] / h["fluid_mass"][-1]
    K = 1 / (1 - c) / ((1 - c) * (h["disc_vx"][-1] - u))
    print("a disk under a load in a periodic cell, %.1f dp in radius: K = %.3f, Sangani and Acrivos 15.558" % (0.126157 / dp, K))
    near(K / 15.558, 1, 0.6 * dp / 0.126157, "terminal velocity of a disk")


TANK = """
gravity: [0, -9.81, 0]
domain_lo: [0, 0, -0.5]
domain_hi: [0.3, 0.3, 0.5]
fluid_hi: [0.3, 0.15, 0.5]
walls: [xmin, xmax, ymin]
bodies: box
body_box:
  shape: box
  size: [0.1, 0.08, 0]
  density: 500
  position: [0.15, 0.14, 0]
  motion: free
sph:
  dim: 2
  dp: 0.01
  viscosity: 5
  kernel: wendland
  max_speed: 1.2
time_end: 0.7
output_every: 0.7
"""


def floating():
    # Archimedes: draft = (500/1000) 0.08 m; level H from the area of the fluid at the start, 0.3 H = A + 0.1 draft; a free surface of markers is
    # known to dp/2. The box starts 6.7 mm too low and its swing is damped within the time.
    dp = 0.005 if fine else 0.01
    frond.write("tank.yaml", TANK)
    frond.runs("run", "tank.yaml", "-sph_dp", str(dp), "-output_dir", "float")
    h = history("float")
    draft = 0.5 * 0.08
    level = (0.3 * 0.15 - 0.1 * 0.05 + 0.1 * draft) / 0.3
    print("a floating box: centre at %.5f m, Archimedes %.5f m, speed %.1e m/s, tilt rate %.1e rad/s" %
          (h["box_y"][-1], level + 0.04 - draft, h["box_vy"][-1], h["box_wz"][-1]))
    near(h["box_y"][-1], level + 0.04 - draft, dp / 2, "draft of a floating box")
    check(abs(h["box_y"][-1] - h["box_y"][0]) > dp / 2, "the box did not move")
    # A neutral disk of radius R in the middle stays. The surface is known to dp/4, so its buoyancy to dp/2R; the drag is 4 pi mu U
    # by at least 1/(ln(1/0.2) - 0.9157) between walls 10 R apart (Faxen 1946, leading terms).
    R = 0.03
    frond.runs("run", "tank.yaml", "-sph_dp", str(dp), "-output_dir", "neutral", "-body_box_shape", "cylinder", "-body_box_size", "%g,1,0" % R,
               "-body_box_density", "1000", "-body_box_position", "0.15,0.075,0", "-time_end", "0.3")
    h = history("neutral")
    drag = 4 * math.pi * 5 / (math.log(5) - 0.9157)
    weight = 1000 * 9.81 * math.pi * R**2
    most = dp / (2 * R) * weight / drag
    print("a neutral disk: %.1e m/s, at most %.1e m/s: its buoyancy is off by %.1f %%" %
          (h["box_vy"][-1], most, 100 * abs(h["box_vy"][-1]) * drag / weight))
    check(max(abs(v) for v in h["box_vy"]) < most, "a neutral disk moves at %g m/s" % h["box_vy"][-1])


POOL = """
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.2, 0.2, 0.25]
domain_periodic: [x, y]
fluid_hi: [0.2, 0.2, 0.125]
walls: zmin
body: {shape: sphere, motion: free, size: [0.05, 0, 0], density: 300}
bodies: ball
body_ball:
  position: [0.1, 0.1, 0.1275]
sph:
  dp: 0.0125
  viscosity: 5
  kernel: wendland
  max_speed: 1.2
time_end: 0.8
output_every: 0.8
"""


def cap(R, d):
    """Volume of a sphere of radius R to the depth d."""
    return math.pi * d**2 * (R - d / 3)


def floating_sphere():
    # Archimedes: the cap below the level has 0.3 of the volume. The level from the volume of fluid at the start: the sphere's bottom lies 0.0475 m below
    # it then, 0.0112 m more than in the end. Bound as for the box, dp/2: a free surface is known to that. Drag 6 pi mu R/2 damps the swing at 5/s.
    R, area, start = 0.05, 0.2**2, 0.125 - (0.1275 - 0.05)
    dp = 0.00625 if fine else 0.0125
    frond.write("pool.yaml", POOL)
    frond.runs("run", "pool.yaml", "-sph_dp", str(dp), "-output_dir", "ball", timeout=3000)
    h = history("ball")
    draft = 0.0
    for bit in range(40):
        more = draft + R / 2**bit
        draft = more if cap(R, more) < 0.3 * cap(R, 2 * R) else draft
    level = (area * 0.125 - cap(R, start) + cap(R, draft)) / area
    print("a floating sphere: draft %.5f m, centre at %.5f m, Archimedes %.5f m, off by %+.2f dp, speed %.1e m/s; it started %.2f dp off" %
          (draft, h["ball_z"][-1], level + R - draft, (h["ball_z"][-1] - level - R + draft) / dp, h["ball_vz"][-1], (0.1275 - level - R + draft) / dp))
    near(h["ball_z"][-1], level + R - draft, dp / 2, "draft of a floating sphere")
    check(abs(0.1275 - level - R + draft) > 0.6 * dp, "a floating sphere: the start is the end")
    check(abs(h["ball_vz"][-1]) * 0.2 < dp / 10, "a floating sphere still moves at %g m/s" % h["ball_vz"][-1])


def refusals():
    for args, words in ((["-body_box_load", "1,nan,0"], ["load"]), (["-body_box_gravity", "1,2"], ["body_box_gravity"]),
                        (["-body_box_torque", "a,0,0"], ["body_box_torque"])):
        frond.refuses(["run", "tank.yaml", *args], words)


sides()
array()
floating()
floating_sphere()
refusals()
report()
