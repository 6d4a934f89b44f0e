#!/usr/bin/python3
"""Which time integrator and step ratio for the beams? Sweep TS type x fluid/beam step ratio x Young's modulus over a scene.

    frond study substeps examples/beam_vacuum.yaml --out study -- -time_end 0.5
    frond study substeps examples/cantilever_fluid.yaml --young 2e7 2e9 -- -sph_dp 0.04 -time_end 0.1

Everything behind -- goes to every run. A scene without fluid is a beam alone. Each run is compared with a reference of its modulus: generalised-alpha
with spectral radius 1 and --reference beam steps in a step of the scene. Written to --out: study.csv, study.h5 (the same table) and study.png. Columns:
young (Pa), type, ratio; verdict; predicted; z = omega_max h of the beam's straight shape, h the beam's step; error: rms over the run of the distance of
the first beam's tip from the reference's (m); energy: energy gained over the run, in parts of the largest kinetic energy (without fluid and damping);
steps, newton, linear: of the beams; wall: of the whole run (s).

verdict: refused: the type cannot take the problem. blown up: the run stopped, or a value is not finite. unstable: the tip ends more than --blowup
beam lengths off the reference, or more than 10 % of energy came from nowhere. stable: else.
predicted, for an undamped beam: from the growth max |R(i omega h)|^steps over the beam's modes: stable up to 10, unstable from 1e6 (round-off is
then visible), growing between; implicit types here are A-stable.
"""
import argparse
import csv
import math
import os
import re
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
EXPLICIT_ORDER = {"rk2": 2, "rk4": 4}  # R(z) is the exponential series up to the order
UNITS = {"young": "Pa", "error": "m", "wall": "s"}


def fail(text):
    sys.exit("frond: error: study substeps: " + text)


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


def frequencies(path):
    """Angular frequencies of the straight beams of a run's settings.txt, rad/s, ascending; and the length of the first beam, m.

    Element matrices of the shape functions, Eq. 19 of the paper, in exact and in 3-point Gauss quadrature for mass and stiffness, as the code's default."""
    import numpy as np

    number = r"([-+0-9.e]+)"
    pattern = rf"beam \d+: (\d+) elements, L {number} m, .*EA {number} N, EI {number} N m\^2, rhoA {number} kg/m, ends (\w+)/(\w+)"
    with open(path) as f:
        beams = re.findall(pattern, f.read())
    if not beams:
        fail("the scene has no ANCF beam")
    omega, dof = [], {"free": 0, "pin": 1, "clamp": 2}
    for n, *rest in beams:
        n, (length, EA, EI, rhoA) = int(n), map(float, rest[:4])
        l = length / n
        for axial in (True, False):
            M, K = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
            for points, target in ((4, M), (3, K)):
                x, w = np.polynomial.legendre.leggauss(points)
                for s, weight in zip((x + 1) / 2, w / 2 * l):
                    S = np.array([1 - 3 * s**2 + 2 * s**3, l * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, l * (s**3 - s**2)])
                    Sx = np.array([-6 * s + 6 * s**2, l * (1 - 4 * s + 3 * s**2), 6 * s - 6 * s**2, l * (3 * s**2 - 2 * s)]) / l
                    Sxx = np.array([-6 + 12 * s, l * (-4 + 6 * s), 6 - 12 * s, l * (6 * s - 2)]) / l**2
                    v, c = (S, rhoA) if target is M else (Sx, EA) if axial else (Sxx, EI)
                    for e in range(n):
                        target[2 * e:2 * e + 4, 2 * e:2 * e + 4] += weight * c * np.outer(v, v)
            fixed = list(range(dof[rest[4]])) + [2 * n + k for k in range(dof[rest[5]])]
            keep = [k for k in range(2 * n + 2) if k not in fixed]
            L = np.linalg.inv(np.linalg.cholesky(M[np.ix_(keep, keep)]))
            omega += list(np.sqrt(np.maximum(np.linalg.eigvalsh(L @ K[np.ix_(keep, keep)] @ L.T), 0)))
    return sorted(omega), float(beams[0][1])


def predict(kind, omega, h, steps):
    if kind not in EXPLICIT_ORDER:
        return "stable"
    size = max(abs(sum((1j * w * h) ** k / math.factorial(k) for k in range(EXPLICIT_ORDER[kind] + 1))) for w in omega)
    growth = steps * math.log10(size)
    return "stable" if growth <= 1 else "unstable" if growth >= 6 else "growing"


def tips(rows):
    name = next((k[: -len("_tip_x[m]")] for k in rows[0] if k.endswith("_tip_x[m]")), None)
    if name is None:
        fail("the scene has no beam")
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


def gained(rows):
    """Energy gained over a run without fluid and damping, in parts of the largest kinetic energy; NaN otherwise."""
    if not rows or any(k.startswith("fluid") for k in rows[0]) or any(r["beams_dissipation[W]"] for r in rows):
        return math.nan
    total = [sum(r[f"beams_{k}[J]"] for k in ("kinetic", "elastic", "potential")) for r in (rows[0], rows[-1])]
    largest = max(r["beams_kinetic[J]"] for r in rows)
    return (total[1] - total[0]) / largest if largest > 0 else math.nan


def verdict(a, code, rows, reference, length, energy):
    """(verdict, rms error in m)"""
    if code and len(rows) <= 1:
        return "refused" if code == 1 else "blown up", math.nan
    if code or any(not math.isfinite(v) for r in rows for v in r.values()):
        return "blown up", math.nan
    d = distances(tips(rows), reference)
    return "unstable" if d[-1] > a.blowup * length or energy > 0.1 else "stable", math.sqrt(sum(v * v for v in d) / len(d))


def sweep(a):
    table = []
    for young in a.young:
        base = ["-beam_young", f"{young:g}"]
        for beam in a.beams:
            base += [f"-beam_{beam}_young", f"{young:g}"]
        reference_options = base + f"-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1 -ancf_substeps {a.reference}".split()
        out = os.path.join(a.out, "reference")
        wall, code, error, rows = simulate(a, out, reference_options)
        if code:
            fail(f"the reference run with E = {young:g} Pa failed: {error.removeprefix('frond: error: ')}")
        reference = tips(rows)
        omega, length = frequencies(os.path.join(out, "settings.txt"))
        step, end = rows[-1]["time[s]"] / rows[-1]["step[1]"], rows[-1]["time[s]"]
        print(f"E {young:g} Pa: reference in {wall:.1f} s; omega_max {omega[-1]:.5g} rad/s, mean step {step:.3g} s", flush=True)
        for kind in a.types:
            for ratio in a.ratios:
                wall, code, error, rows = simulate(a, os.path.join(a.out, "run"), base + TYPES[kind].split() + ["-ancf_substeps", str(ratio)])
                energy = gained(rows)
                state, rms = verdict(a, code, rows, reference, length, energy)
                last = rows[-1] if rows else {}
                row = {"young": young, "type": kind, "ratio": ratio, "verdict": state, "predicted": predict(kind, omega, step / ratio, end / step * ratio),
                       "z": omega[-1] * step / ratio, "error": rms, "energy": energy, "steps": int(last.get("beams_steps[1]", 0)),
                       "newton": int(last.get("beams_newton[1]", 0)), "linear": int(last.get("beams_linear[1]", 0)), "wall": wall}
                table.append(row)
                print(f"  {kind:9} ratio {ratio:3} {state:9} (predicted {row['predicted']}, z {row['z']:.3g}) error {rms:.2e} m, {row['steps']} steps, {row['newton']} Newton, "
                      f"{row['linear']} linear, {wall:.2f} s" + (f" ({error})" if code else ""), flush=True)
    return table


def write(a, table):
    with open(os.path.join(a.out, "study.csv"), "w", newline="") as f:
        w = csv.DictWriter(f, list(table[0]))
        w.writeheader()
        w.writerows(table)
    import h5py

    with h5py.File(os.path.join(a.out, "study.h5"), "w") as f:
        for k in table[0]:
            text = isinstance(table[0][k], str)
            d = f.create_dataset(k, data=[r[k] for r in table], dtype=h5py.string_dtype() if text else None)
            d.attrs["unit"] = UNITS.get(k, "1")


def plot(a, table):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, len(a.young), figsize=(5 * len(a.young), 8), squeeze=False, sharex=True)
    for column, young in enumerate(a.young):
        for kind in a.types:
            rows = [r for r in table if r["young"] == young and r["type"] == kind and r["verdict"] == "stable"]
            axes[0][column].loglog([r["ratio"] for r in rows], [r["error"] for r in rows], "o-", label=kind)
            axes[1][column].loglog([r["ratio"] for r in rows], [r["wall"] for r in rows], "o-", label=kind)
        axes[0][column].set_title(f"E = {young:g} Pa (only stable runs)")
        axes[1][column].set_xlabel("beam steps per step of the scene")
    axes[0][0].set_ylabel("tip error, rms, m")
    axes[1][0].set_ylabel("wall time, s")
    axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(os.path.join(a.out, "study.png"), dpi=110)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        fail(message + " (frond study substeps -h)")


def positive(kind):
    def convert(text):
        value = kind(text)
        if not value > 0 or not math.isfinite(value):
            raise ValueError
        return value
    convert.__name__ = "number > 0" if kind is float else "whole number > 0"
    return convert


def main():
    argv, extra = sys.argv[1:], []
    if "--" in argv:
        argv, extra = argv[: argv.index("--")], argv[argv.index("--") + 1 :]
    p = Parser(prog="frond study substeps", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scene", help="YAML file; a scene without fluid is a beam alone")
    p.add_argument("--frond", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "bin", "frond"), help="the command")
    p.add_argument("--out", default="out_study", help="folder of the results (default: out_study)")
    p.add_argument("--types", nargs="+", default=["rk2", "rk4", "alpha2", "midpoint", "bdf2", "arkimex", "irk", "dirk"], choices=list(TYPES))
    p.add_argument("--ratios", nargs="+", type=positive(int), default=[1, 2, 5, 10, 20, 50], help="beam steps in a step of the scene")
    p.add_argument("--young", nargs="+", type=positive(float), default=[20e6], help="Pa")
    p.add_argument("--beams", nargs="*", default=["rod"], help="names of the beams whose modulus is swept (default: rod)")
    p.add_argument("--reference", type=positive(int), default=200, help="beam steps in a step of the scene for the reference (default: 200)")
    p.add_argument("--blowup", type=positive(float), default=0.1, help="beam lengths (default: 0.1)")
    p.add_argument("--timeout", type=positive(float), default=600, help="of one run, s (default: 600)")
    a = p.parse_args(argv)
    a.options = extra
    if not os.path.isfile(a.scene):
        fail(f"scene {a.scene}: no such file")
    for module in ("numpy", "h5py", "matplotlib"):
        try:
            __import__(module)
        except ImportError:
            fail(f"needs the Python module {module}; FROND_PYTHON names another interpreter than {sys.executable}")
    try:
        os.makedirs(a.out, exist_ok=True)
    except OSError as e:
        fail(f"--out {a.out}: {e.strerror}")
    table = sweep(a)
    write(a, table)
    plot(a, table)
    print(f"{len(table)} runs: {a.out}/study.csv, study.h5, study.png")


if __name__ == "__main__":
    main()
