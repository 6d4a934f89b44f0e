"""Segre and Silberberg in 2D: a neutrally buoyant disk migrates to 0.2745 of the channel's width."""
import csv
import sys

from apptest import Frond, check, near, report

frond = Frond(sys.argv[1], sys.argv[2])
dp, end, means = 0.025, 30, []
for y in (0.2, 0.35):
    folder = "from%g" % y
    frond.runs("run", sys.argv[3] + "/examples/migration_2d.yaml", "-output_dir", folder, "-body_disk_position", "0.5,%g,0" % y, "-time_end",
               str(end), "-output_every", str(end))
    with open(frond.path(folder, "history.csv")) as f:
        rows = list(csv.DictReader(f))
    t = [float(r["time[s]"]) for r in rows]
    place = [float(r["disk_y[m]"]) for r in rows]
    late = [p for s, p in zip(t, place) if s > end - 6]
    mean = sum(late) / len(late)
    print("from %.2f m: on average %.4f m over the last 6 s, between %.4f and %.4f m; Inamuro et al. 0.2745 m" % (y, mean, min(late), max(late)))
    means.append(mean)
    # two walls and two sides of the disk, each known to dp/4
    near(mean, 0.2745, dp, "place of the disk that comes from %g m" % y)
check(abs(means[0] - means[1]) < dp / 2, "the two disks end at %g and %g m" % tuple(means))
report()
