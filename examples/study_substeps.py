#!/usr/bin/python3
"""Which time integrator and step ratio for the beams? Sweep TS type x fluid/beam step ratio x Young's modulus over a scene.

    python3 examples/study_substeps.py examples/beam_vacuum.yaml --out study -- -time_end 0.5
    python3 examples/study_substeps.py examples/cantilever_fluid.yaml --young 2e7 2e9 -- -sph_dp 0.04 -time_end 0.1

Everything behind -- goes to every run. Each run is compared with a reference of its modulus: generalised-alpha with spectral radius 1 and
--reference beam steps in a fluid step. Written to --out: study.csv, study.h5 (the same table) and study.png. Columns: error is the rms over the
run of the distance of the first beam's tip from the reference's, m; steps, Newton and linear iterations are the beams'; wall is the
whole run's wall time, s. A run is `unstable` when it stops with an error, when a value is not finite, or when the tip ends more than --blowup (m)
off the reference; `refused` when the type cannot take the problem.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import time

TYPES = {
    "rk2": "-ancf_ts_type rk -ancf_ts_rk_type 2a",
    "rk4": "-ancf_ts_type rk -ancf_ts_rk_type 4",
    "alpha2": "-ancf_ts_type alpha2",
    "midpoint": "-ancf_ts_type theta -ancf_ts_theta_theta 0.5",
    "bdf2": "-ancf_ts_type bdf -ancf_ts_bdf_order 2",
    "arkimex": "-ancf_ts_type arkimex -ancf_ts_arkimex_fully_implicit -ancf_ts_adapt_type none",
    "irk": "-ancf_ts_type irk -ancf_ts_irk_nstages 2",
    "dirk": "-ancf_ts_type dirk -ancf_ts_adapt_type none",
}


def simulate(a, out, options):
    """Run the scene; (seconds, exit code, last line of errors, rows of the history)."""
    history = os.path.join(out, "history.csv")
    if os.path.exists(history):
        os.remove(history)
    start = time.monotonic()
    command = [a.frond, "run", a.scene, "-output_dir", out, "-output_overwrite", "-output_every", "1e9", "-progress_every", "1e9"]
    try:
        p = subprocess.run(command + options + a.options, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=a.timeout)
        code, errors = p.returncode, p.stderr.strip().splitlines()
    except subprocess.TimeoutExpired:
        code, errors = -1, [f"longer than {a.timeout:g} s"]
    rows = []
    if os.path.exists(history):
        with open(history) as f:
            rows = [{k: float(v) for k, v in r.items()} for r in csv.DictReader(f)]
    return time.monotonic() - start, code, errors[-1] if errors else "", rows


def tips(rows):
    name = next(k[: -len("_tip_x[m]")] for k in rows[0] if k.endswith("_tip_x[m]"))
    return [(r["time[s]"], [r[f"{name}_tip_{k}[m]"] for k in "xyz"]) for r in rows]


def distances(run, reference):
    """Distances at the run's times, the reference interpolated linearly between its rows."""
    d, j = [], 0
    for t, x in run:
        while j + 2 < len(reference) and reference[j + 1][0] < t:
            j += 1
        (t0, a), (t1, b) = reference[j], reference[min(j + 1, len(reference) - 1)]
        s = min(1.0, (t - t0) / (t1 - t0)) if t1 > t0 else 0.0
        d.append(math.dist(x, [p + s * (q - p) for p, q in zip(a, b)]))
    return d


def verdict(a, code, error, rows, reference):
    if code and not rows:
        return "refused", math.nan
    if any(not math.isfinite(v) for r in rows for v in r.values()):
        return "unstable", math.nan
    d = distances(tips(rows), reference) if rows else [math.inf]
    rms = math.sqrt(sum(v * v for v in d) / len(d))
    return ("unstable" if code or d[-1] > a.blowup else "stable"), rms


def sweep(a):
    table = []
    for young in a.young:
        base = ["-beam_young", f"{young:g}"]
        for beam in a.beams:
            base += [f"-beam_{beam}_young", f"{young:g}"]
        reference_options = base + f"-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1 -ancf_substeps {a.reference}".split()
        wall, code, error, rows = simulate(a, os.path.join(a.out, "reference"), reference_options)
        if code:
            sys.exit(f"the reference run with E = {young:g} Pa failed: {error}")
        reference = tips(rows)
        print(f"E {young:g} Pa: reference in {wall:.1f} s")
        for name in a.types:
            for ratio in a.ratios:
                wall, code, error, rows = simulate(a, os.path.join(a.out, "run"), base + TYPES[name].split() + ["-ancf_substeps", str(ratio)])
                state, rms = verdict(a, code, error, rows, reference)
                last = rows[-1] if rows else {}
                row = {"young": young, "type": name, "ratio": ratio, "verdict": state, "error": rms, "steps": last.get("beams_steps[1]", 0),
                       "newton": last.get("beams_newton[1]", 0), "linear": last.get("beams_linear[1]", 0), "wall": wall}
                table.append(row)
                print(f"  {name:9} ratio {ratio:3} {state:9} error {rms:.2e} m, {row['steps']:.0f} steps, {row['newton']:.0f} Newton, {row['linear']:.0f} linear, {wall:.1f} s"
                      + (f" ({error})" if code else ""), flush=True)
    return table


def write(a, table):
    with open(os.path.join(a.out, "study.csv"), "w", newline="") as f:
        w = csv.DictWriter(f, list(table[0]))
        w.writeheader()
        w.writerows(table)
    import h5py

    units = {"young": "Pa", "error": "m", "wall": "s"}
    with h5py.File(os.path.join(a.out, "study.h5"), "w") as f:
        for k in table[0]:
            text = isinstance(table[0][k], str)
            d = f.create_dataset(k, data=[r[k] for r in table], dtype=h5py.string_dtype() if text else None)
            d.attrs["unit"] = units.get(k, "1")


def plot(a, table):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, len(a.young), figsize=(5 * len(a.young), 8), squeeze=False, sharex=True)
    for column, young in enumerate(a.young):
        for name in a.types:
            rows = [r for r in table if r["young"] == young and r["type"] == name and r["verdict"] == "stable"]
            axes[0][column].loglog([r["ratio"] for r in rows], [r["error"] for r in rows], "o-", label=name)
            axes[1][column].loglog([r["ratio"] for r in rows], [r["wall"] for r in rows], "o-", label=name)
        axes[0][column].set_title(f"E = {young:g} Pa (unstable runs left out)")
        axes[1][column].set_xlabel("beam steps per fluid step")
    axes[0][0].set_ylabel("tip error, rms, m")
    axes[1][0].set_ylabel("wall time, s")
    axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(os.path.join(a.out, "study.png"), dpi=110)


def main():
    argv, extra = sys.argv[1:], []
    if "--" in argv:
        argv, extra = argv[: argv.index("--")], argv[argv.index("--") + 1 :]
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("scene")
    p.add_argument("--frond", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "bin", "frond"))
    p.add_argument("--out", default="out_study")
    p.add_argument("--types", nargs="+", default=["rk2", "alpha2", "midpoint", "bdf2", "arkimex", "irk", "dirk"], choices=list(TYPES))
    p.add_argument("--ratios", nargs="+", type=int, default=[1, 2, 5, 10, 20, 50])
    p.add_argument("--young", nargs="+", type=float, default=[20e6])
    p.add_argument("--beams", nargs="*", default=["rod"], help="names of the beams whose modulus is swept")
    p.add_argument("--reference", type=int, default=200, help="beam steps per fluid step of the reference")
    p.add_argument("--blowup", type=float, default=0.1, help="m")
    p.add_argument("--timeout", type=float, default=600, help="of one run, s")
    a = p.parse_args(argv)
    a.options = extra
    os.makedirs(a.out, exist_ok=True)
    table = sweep(a)
    write(a, table)
    plot(a, table)
    print(f"{len(table)} runs: {a.out}/study.csv, study.h5, study.png")


if __name__ == "__main__":
    main()
