"""Seed Sect. 4.2, Fig. 5: a cantilever released horizontally in a fluid swings at 1 Pa s and is close to critically damped at 10 Pa s.

Usage: couple_cantilever.py FROND OUTDIR SOURCE [dp]. Coarse by default: one marker across the beam (dp = d = 0.04 m).

Checked: the tip's overshoot beyond its static rest position (elastica under the buoyancy-reduced weight, solved here by
shooting) is above 20 % of the way at 1 Pa s and below 10 % at 10 Pa s; the momentum balance of fluid, beam, walls and clamp
closes to 1 % of its largest term (the support's impulse is integrated by the trapezoidal rule over a force that rings);
what the transfer loses is round-off. The semi-analytic small-swing damping ratios about the hanging state at 10 Pa s (0.628, Sader's
added mass and drag) is printed beside the one that the overshoot stands for.
"""
import csv
import importlib
import math
import os
import subprocess
import sys


def run(frond, scene, out, mu, dp):
    command = [frond, "run", scene, "-output_dir", out, "-output_overwrite", "-sph_dp", str(dp), "-sph_viscosity", str(mu),
               "-sph_max_speed", "2", "-time_end", "2.2", "-output_every", "1", "-progress_every", "20"]
    subprocess.run(command, check=True)
    with open(os.path.join(out, "history.csv")) as f:
        return list(csv.DictReader(f))


def main():
    frond, outdir, source = sys.argv[1:4]
    dp = float(sys.argv[4]) if len(sys.argv) > 4 else 0.04
    scene = os.path.join(source, "examples", "cantilever_fluid.yaml")
    sys.path.insert(0, os.path.join(source, "docs", "gallery"))
    rest = importlib.import_module("case_cantilever_fluid").elastica_tip()
    failed = 0

    def check(ok, text):
        nonlocal failed
        failed += not ok
        print(("ok      " if ok else "FAILED  ") + text)

    print(f"static rest position of the tip: x {rest[0]:.4f}, z {rest[1]:.4f} m")
    for mu, low, high in ((1, 0.2, 1.0), (10, 0.0, 0.1)):
        rows = run(frond, scene, f"{outdir}_mu{mu}", mu, dp)
        x = [float(r["rod_tip_x[m]"]) for r in rows]
        over = (rest[0] - min(x)) / (1 - rest[0])
        zeta = -math.log(over) / math.hypot(math.pi, math.log(over)) if over > 0 else 1.0
        first = next((float(r["time[s]"]) for r, xi in zip(rows, x) if xi < rest[0]), float("nan"))
        print(f"mu {mu} Pa s: passes the rest position at {first:.3f} s, overshoot {100 * over:.1f} %, like a damping ratio of {zeta:.3f}")
        check(low < over < high, f"overshoot {over:.3f} between {low} and {high}")
        check(math.isfinite(first), "the tip reaches its rest position")
        last = rows[-1]
        residual = max(abs(float(last[f"momentum_residual_{k}[kg m/s]"])) for k in "xyz") / float(last["momentum_scale[kg m/s]"])
        check(residual < 0.01, f"momentum residual {residual:.2e} of the largest term, below 0.01")
        for what, unit in (("force", "N"), ("moment", "N m"), ("power", "W")):
            lost = max(float(r[f"transfer_{what}_lost[{unit}]"]) for r in rows)
            check(lost < 1e-11, f"{what} lost in transfer at most {lost:.1e} {unit}")
    print("small swings about the hanging state at 10 Pa s: damping ratio 0.628 (semi-analytic)")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
