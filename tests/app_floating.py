"""Fig. 4 of the paper in a small channel: a stiff floating beam moves like the rigid cylinder in its place."""
import importlib.util
import sys

import apptest

try:
    import numpy as np

    spec = importlib.util.spec_from_file_location("plot_floating", sys.argv[3] + "/examples/plot_floating.py")
    floating = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(floating)
except ImportError as missing:
    print("SKIPPED: %s" % missing)
    sys.exit(77)

frond, check = apptest.Frond(sys.argv[1], sys.argv[2]), apptest.check
dp = float(sys.argv[4]) if len(sys.argv) > 4 else 0.02
small = ["-domain_hi", "0.28,0.2,0.32", "-sph_viscosity", "5", "-sph_body_force", "0.7,0,0", "-sph_max_speed", "0.6", "-sph_dp", str(dp),
         "-time_end", "1.2", "-output_every", "0.1"]
frond.runs("run", sys.argv[3] + "/examples/floating_beam.yaml", "-output_dir", "beam", "-beam_density", "1000", "-beam_rod_start",
           "0.14,0.05,0.0434", "-beam_rod_end", "0.14,0.15,0.2166", "-beam_young", "1e8", *small)
frond.runs("run", sys.argv[3] + "/examples/floating_cylinder.yaml", "-output_dir", "cylinder", "-body_density", "1000", "-body_rod_position",
           "0.14,0.1,0.13", *small)
t, a, v = floating.motion(frond.path("beam"))
s, b, w = floating.motion(frond.path("cylinder"))
check(len(t) == len(s) and np.allclose(t, s), "the runs have other frames")
angle, other = np.arccos(a), np.arccos(b)
for i in range(0, len(t), 3):
    print("t = %.1f s: angles %s and %s rad, speeds %.4f and %.4f m/s" % (t[i], angle[i].round(4), other[i].round(4), v[i, 0], w[i, 0]))
# Both surfaces are known to dp/4 of the radius R, and so is what the flow does to either: dp/4R of the turn and of the speed
# reached. The beam carries no torque about its axis; its share in a slender rod's turn is of order (d/L)^2 = 4 %.
R, L = 0.02, 0.2
bound = dp / (4 * R) + (2 * R / L) ** 2
turn = np.abs(angle - angle[0]).max()
print("turned by %.3f rad; largest difference of angles %.4f rad, of speeds %.4f of %.4f m/s; bound %.0f %%" %
      (turn, np.abs(angle - other).max(), np.abs(v[:, 0] - w[:, 0]).max(), v[:, 0].max(), 100 * bound))
check(turn > 0.2 and v[-1, 0] > 0.05, "the rod neither turned nor moved: %g rad, %g m/s" % (turn, v[-1, 0]))
check(np.abs(angle - other).max() < bound * turn, "angles differ by %g rad" % np.abs(angle - other).max())
check(np.abs(v[:, 0] - w[:, 0]).max() < bound * v[:, 0].max(), "speeds differ by %g m/s" % np.abs(v[:, 0] - w[:, 0]).max())
apptest.report()
