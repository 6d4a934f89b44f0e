"""A sphere that sinks along the axis of a closed tube: terminal speed against Haberman's wall correction, at two resolutions."""
import csv
import math
import sys

from apptest import Frond, check, near, report

frond = Frond(sys.argv[1], sys.argv[2])
a, R, load = 0.4, 1, 0.67


def correction(s):
    """Drag of a sphere on the axis of a tube over Stokes', s = a/R: Haberman, exact to 0.5 % up to s = 0.5."""
    return (1 - 0.75857 * s**5) / (1 - 2.105 * s + 2.0865 * s**3 - 1.7068 * s**5 + 0.72603 * s**6)


# Both surfaces are known to dp/4 (test_couple_array.c): the drag a K(a/R) to dp/4 times its derivatives by a and by R.
slope = a / R * (correction(a / R + 1e-4) - correction(a / R - 1e-4)) / 2e-4 / correction(a / R)
errors = []
for dp in (1 / 10, 1 / 15):
    folder = "dp%.3f" % dp
    frond.runs("run", sys.argv[3] + "/examples/settling_tube.yaml", "-output_dir", folder, "-sph_dp", "%.12g" % dp, timeout=3000)
    with open(frond.path(folder, "history.csv")) as f:
        rows = list(csv.DictReader(f))
    # sound goes through the tube and back in 2 x 4 m / 40 m/s = 0.2 s: one period of it
    late = [-float(r["ball_vz[m/s]"]) for r in rows if float(r["time[s]"]) > 0.2]
    speed = sum(late) / len(late)
    K, bound = load / (6 * math.pi * a * speed), dp / 4 * ((1 + slope) / a + slope / R)
    errors.append(K / correction(a / R) - 1)
    print("a/dp %.0f: terminal speed %.5f m/s, drag over Stokes' %.3f, Haberman %.3f: %+.1f %%, bound %.1f %%" %
          (a / dp, speed, K, correction(a / R), 100 * errors[-1], 100 * bound))
    near(errors[-1], 0, bound, "wall correction at a/dp = %.0f" % (a / dp))
    side = max(abs(float(rows[-1]["ball_v%s[m/s]" % k])) for k in "xy")
    check(side < 1e-3 * speed, "the sphere moves sideways at %g m/s" % side)  # the lattice has the symmetry of the tube: round-off in single precision, grown
# First order: 2/3 of the error. What is left of the sound is within 1 % of the speed, 0.1 of the coarse error.
check(abs(errors[1]) < (2 / 3 + 0.1) * abs(errors[0]), "errors %g and %g do not fall with the spacing" % tuple(errors))
report()
