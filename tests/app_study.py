"""`frond study substeps`: verdicts against analytic stability limits, orders, files, bad input.

Usage: app_study.py FROND OUTDIR SOURCE. The beam of the paper with 4 elements has omega_max = 2012 rad/s, with 8 4026 rad/s (references of
the beam swing, computed apart; 4 digits). RK4 is stable for omega h < 2.83, RK2 grows by sqrt(1 + z^4/4) in a step: at z = 0.2 by 1.2 in 0.2 s, which
is stable here, at z = 2 by 2.2 each step. Implicit types are stable at all of these. Bracket of RK4's limit: z = 2.7 and 3.0; stretched by its swing the beam's
frequencies change by less than 1 % in this time, and at z = 3 round-off grows by 1.5^134 = 1e23.
"""
import csv
import os
import sys

import apptest
from apptest import check, near

frond = apptest.Frond(sys.argv[1], sys.argv[2])
BEAM = os.path.join(os.path.abspath(sys.argv[3]), "examples", "beam_vacuum.yaml")


def study(out, types, ratios, options, scene=BEAM, extra=()):
    frond.runs("study", "substeps", scene, "--out", out, "--types", *types.split(), "--ratios", *ratios.split(), *extra, "--", "-history_every", "0", *options.split())
    with open(frond.path(out, "study.csv")) as f:
        return {(r["type"], int(r["ratio"])): r for r in csv.DictReader(f)}


def verdicts():
    rows = study("sweep", "rk2 rk4 alpha2 midpoint bdf2", "1 2 20", "-time_end 0.2 -time_step 2e-3 -beam_rod_elements 4", extra=["--reference", "50"])
    check(len(rows) == 15, "15 runs")
    near(float(rows["alpha2", 1]["z"]) / 2e-3, 2012, 0.5, "omega_max with 4 elements, rad/s")
    for (kind, ratio), r in rows.items():
        broken = kind in ("rk2", "rk4") and ratio == 1 or (kind, ratio) == ("rk2", 2)
        check(r["predicted"] == ("unstable" if broken else "stable"), f"{kind} ratio {ratio}: predicted {r['predicted']}")
        check((r["verdict"] in ("unstable", "blown up")) == broken, f"{kind} ratio {ratio}: {r['verdict']}, z = {r['z']}")
        if not broken:
            check(int(r["steps"]) == 100 * ratio, f"{kind} ratio {ratio}: {r['steps']} steps")
    for kind in ("alpha2", "midpoint", "bdf2"):  # second order; 10 times the steps; the fastest waves are not resolved at ratio 2
        fall = float(rows[kind, 2]["error"]) / float(rows[kind, 20]["error"])
        check(fall > 10**1.7, f"{kind}: error falls by {fall:.0f} from ratio 2 to 20, second order is 100")
        check(int(rows[kind, 20]["newton"]) >= 2000 and int(rows[kind, 20]["linear"]) >= 2000, f"{kind}: at least an iteration a step")
    import h5py

    with h5py.File(frond.path("sweep", "study.h5")) as f:
        check([x.decode() for x in f["verdict"][:]] == [r["verdict"] for r in rows.values()], "HDF5 has the verdicts of the CSV")
        check(f["error"].attrs["unit"] == "m" and f["z"].shape == (15,), "HDF5 has units and all rows")
    with open(frond.path("sweep", "study.png"), "rb") as f:
        check(f.read(8) == b"\x89PNG\r\n\x1a\n" and os.path.getsize(frond.path("sweep", "study.png")) > 5000, "plot")


def limit():
    for z, good in ((2.7, True), (3.0, False)):
        rows = study("limit", "rk4", "1", f"-time_end 0.2 -beam_rod_elements 4 -time_step {z / 2012.2:.6e}", extra=["--reference", "20"])
        check((rows["rk4", 1]["verdict"] == "stable") == good, f"rk4 at z = {z}: {rows['rk4', 1]['verdict']}")
    rows = study("limit", "alpha2", "1", "-time_end 0.02 -time_step 2e-3 -beam_rod_elements 8", extra=["--reference", "5"])
    near(float(rows["alpha2", 1]["z"]) / 2e-3, 4026, 0.5, "omega_max with 8 elements, rad/s")


def coupled():
    frond.write("small.yaml", apptest.SCENE)
    rows = study("coupled", "alpha2 rk2", "1 5", "-time_end 0.005", scene="small.yaml", extra=["--young", "1e6", "--reference", "20"])
    check(len(rows) == 4 and all(r["verdict"] == "stable" for r in rows.values()), "a beam in fluid")
    # z = 3.25: growth 5.4 a step over 5 steps, 4e3; the rest at z < 1 or implicit
    check([r["predicted"] for r in rows.values()].count("growing") == 1 and rows["rk2", 1]["predicted"] == "growing", "a beam in fluid: predictions")


def bad():
    for args, words in ((["dance"], ["dance", "substeps"]), (["substeps", "no.yaml"], ["no.yaml", "no such file"]), (["substeps"], ["scene"]),
                        (["substeps", BEAM, "--ratios", "0"], ["ratios", "whole number > 0", "0"]), (["substeps", BEAM, "--types", "euler"], ["types", "euler", "alpha2"]),
                        (["substeps", BEAM, "--young", "-1"], ["young"]), (["substeps", BEAM, "--beams", "twig", "--out", "q"], ["twig"]),
                        (["substeps", BEAM, "--out", "q", "--", "-time_step", "0"], ["time_step"])):
        frond.refuses(["study", *args], words)


verdicts()
limit()
coupled()
bad()
apptest.report()
