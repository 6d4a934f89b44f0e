"""Bodies and joints that cannot be: one line that names the body or joint, the value and the rule, and an exit code that is not 0."""
import math
import re
import sys

from apptest import SCENE, Frond, check, near, report

frond = Frond(sys.argv[1], sys.argv[2])

PENDULUM = """
fluid: false
gravity: [0, 0, -9.81]
bodies: [ball, car]
body:
  shape: sphere
  size: [0.1, 0, 0]
  density: 1000
body_ball:
  motion: free
  position: [0, 0, -1]
body_car:
  motion: prescribed
  position: [1, 0, -1]
joints: pin
joint_pin:
  type: ball
  a: ball
  point: [0, 0, 0]
time_step: 0.001
time_end: 0.2
history_every: 0
"""
frond.write("pendulum.yaml", PENDULUM)
frond.write("small.yaml", SCENE)
CORNER, FACETS = ((0, 0, 0), (0.08, 0, 0), (0, 0.08, 0), (0, 0, 0.08)), ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


def mesh(name, facets):
    text = "".join("facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %g %g %g\n" % CORNER[k] for k in f) for f in facets)
    frond.write(name, "solid t\n%sendsolid t\n" % text)


def bad(scene, options, *words, code=1):
    frond.refuses(["run", scene + ".yaml", "-output_overwrite", "true", *options.split()], words, code)


# The scenes themselves are right.
frond.runs("run", "pendulum.yaml", "-output_dir", "right")
frond.runs("check", "small.yaml")

# Mass and moments of inertia.
for value in ("0", "-1", "nan"):
    bad("pendulum", "-body_ball_mass " + value, "body_ball_mass", value, "positive|finite")
    bad("pendulum", "-body_ball_density " + value, "ball", "density", value, "> 0|finite|positive")
for value in ("0,1,1", "1,-1,1", "1,1,0"):
    bad("pendulum", "-body_ball_inertia " + value, "body_ball_inertia", "positive")
bad("pendulum", "-body_ball_inertia 1,1,2.1", "body 'ball'", "inertia", r"2\.1", "sum of the other two")  # no mass is laid out so

# Surfaces that enclose nothing.
BALL = "-body_ball_shape mesh -body_ball_position 0.26,0.15,0.15 -body_ball_file "
mesh("whole.stl", FACETS)
frond.runs("check", "small.yaml", *(BALL + "whole.stl").split())
mesh("open.stl", FACETS[:3])
bad("small", BALL + "open.stl", "body 'ball'", r"open\.stl", "not closed", "edge")
mesh("turned.stl", FACETS[:3] + ((0, 2, 3),))
bad("small", BALL + "turned.stl", "body 'ball'", r"turned\.stl", "not oriented", "edge")
mesh("flat.stl", ((0, 2, 1), (0, 1, 2)))
bad("small", BALL + "flat.stl", "body 'ball'", r"flat\.stl", "no volume")

# Too small to be marked: below the spacing across. At the spacing it goes.
frond.runs("check", "small.yaml", "-body_ball_size", "0.02,0,0")
bad("small", "-body_ball_size 0.019,0,0", "body 'ball'", r"0\.038 m", r"dp = 0\.04", "cannot be marked")
bad("small", "-body_ball_shape box -body_ball_size 0.1,0.1,0.03", "body 'ball'", r"0\.03 m", "cannot be marked")
bad("small", "-body_ball_shape capsule -body_ball_size 0.015,0.1,0", "body 'ball'", r"0\.03 m", "cannot be marked")

# In one another's place; both are named. Spheres of 0.06 m, 0.08 m apart: an overlap of 0.04 m.
TWIN = "-bodies ball,twin -body_twin_shape sphere -body_twin_size 0.06,0,0 -body_twin_density 1000 -body_twin_position 0.31,0.28,0.2 -body_twin_motion "
bad("small", TWIN + "free", "'ball' and 'twin'", r"overlap by 0\.04 m")
bad("small", TWIN + "free -body_twin_position 0.01,0.2,0.2 -body_ball_position 0.35,0.2,0.2", "'ball' and 'twin'", r"overlap by 0\.06 m")  # through a periodic side
bad("small", TWIN + "fixed", "'ball' and 'twin'", "on top of one another")  # two that are fixed may make one solid, but not of the same markers
bad("small", "-body_ball_motion free -body_ball_position 0.31,0.2,0.03", "body 'ball'", "overlaps the wall", r"0\.03 m")

# Joints.
bad("pendulum", "-joint_pin_b ball", "joint 'pin'", "'ball' with itself")
bad("pendulum", "-joint_pin_a ground", "joint 'pin'", "'ground' with itself")
bad("pendulum", "-joint_pin_a cat", "joint 'pin'", "'cat' is neither")
bad("pendulum", "-joint_pin_type spring -joint_pin_pointb 0,0,0", "joint 'pin'", "length 0")
# A prescribed body leaves its joint to the ground: refused as soon as it does, at the first step.
bad("pendulum", "-joint_pin_a car -body_car_velocity 1,0,0", "joint 'pin'", "not assembled", r"t = 0\.001 s", r"apart by 0\.001")
# Two links, sqrt(1.25) m and 0.5 m long, between the ground and a car at 1 m/s: their end (1 + t, 0, -1) m is out of reach when (1 + t)^2 + 1 >
# (sqrt(1.25) + 0.5)^2, at 0.272 s. The run stops in the step in which that happens, with what it has written whole, and says which joint and when.
LINKS = """-bodies ball,arm,car -body_arm_motion free -body_arm_position 0.75,0,-1 -body_car_position 1.5,0,-1 -body_car_velocity 1,0,0 -joints pin,knee,tow
 -joint_type ball -joint_knee_a ball -joint_knee_b arm -joint_knee_point 0.5,0,-1 -joint_tow_a arm -joint_tow_b car -joint_tow_point 1,0,-1""".split()
frond.runs("run", "pendulum.yaml", *LINKS, "-output_dir", "near", "-time_end", "0.25")
rc, out, err = frond("run", "pendulum.yaml", *LINKS, "-output_dir", "torn", "-time_end", "0.5")
line = err.splitlines()[-1]
print(line)
stop = re.search(r"at t = ([0-9.]+) s", line)
check(rc in (1, 2) and re.search("joint '(pin|knee|tow)'", line), "out of reach: exit code %d, %s" % (rc, err[:300]))
check("cannot be kept" in line and "contradict" in line, "out of reach: " + line)
near(float(stop.group(1)) if stop else -1, math.sqrt((math.sqrt(1.25) + 0.5) ** 2 - 1) - 1, 0.001, "out of reach: time")  # of one step
report()
