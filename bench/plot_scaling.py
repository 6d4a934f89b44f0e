#!/usr/bin/env python3
"""Plot the tables of bench_scaling: time of a coupled step against bodies or markers (Figs. 9 and 10 of the paper).

    bench_scaling -experiment beams -csv beams.csv
    plot_scaling.py beams.csv [more.csv ...] -o scaling.png
"""
import argparse
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TITLES = {"rigid": "rigid spheres", "size": "problem size, a sphere per 1000 markers", "beams": "flexible cantilevers"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+")
    parser.add_argument("-o", "--output", default="scaling.png")
    args = parser.parse_args()
    curves = {}
    for name in args.files:
        with open(name, newline="") as f:
            for row in csv.DictReader(f):
                x = float(row["markers"] if row["experiment"] == "size" else row["bodies"])
                curves.setdefault(row["experiment"], {}).setdefault((name, row["type"]), []).append((x, float(row["seconds"])))
    figure, axes = plt.subplots(1, len(curves), figsize=(5 * len(curves), 3.6), squeeze=False)
    for axis, (experiment, lines) in zip(axes[0], curves.items()):
        for (name, kind), points in lines.items():
            axis.plot(*zip(*sorted(points)), "o-", label=f"{kind} ({name})")
        axis.set_xlabel("markers" if experiment == "size" else "bodies")
        axis.set_ylabel("time of a step (s)")
        axis.set_ylim(bottom=0)
        axis.set_title(TITLES.get(experiment, experiment))
        axis.legend()
    figure.tight_layout()
    figure.savefig(args.output, dpi=150)


if __name__ == "__main__":
    main()
