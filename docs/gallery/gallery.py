#!/usr/bin/env python3
"""The gallery: benchmark cases of the papers, run by the frond command, compared with their references, drawn and written up.

gallery.py FROND OUTDIR [CASE ...] [--fine] [--pages]

Runs the cases (all when none is named) into OUTDIR, prints every number beside its reference and bound, and ends with an error
when a bound is exceeded that the case is known to meet, or one does not come out as recorded. --fine: the finer of the two
resolutions; --pages: renew the pages and pictures of docs/gallery from this run. Each case is a module here (case_*.py) with a
TITLE, a TEXT for its page and a function run(gallery).
"""
import argparse
import csv
import glob
import importlib
import os
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


class Run:
    """A finished run: its history by column name without unit, its frames' paths, its closing lines and cost."""

    def __init__(self, folder, output, seconds):
        self.folder, self.seconds = folder, seconds
        with open(os.path.join(folder, "history.csv"), newline="") as f:
            rows = list(csv.reader(f))
        self.history = {h.split("[")[0]: [float(r[i]) for r in rows[1:]] for i, h in enumerate(rows[0])}
        self.balances = [line.strip() for line in output.splitlines() if "balance" in line and ":" in line]
        self.steps = int(self.history["step"][-1])

    def frames(self):
        return sorted(glob.glob(os.path.join(self.folder, "frame_*.h5")))


class Gallery:
    """What a case works with: runs, numbers beside references, the picture."""

    def __init__(self, name, frond, outdir, fine):
        self.name, self.frond, self.outdir, self.fine = name, frond, outdir, fine
        self.commands, self.rows, self.costs, self.notes, self.picture = [], [], [], [], None
        self.failed = False

    def run(self, scene, *options, label=""):
        """Run examples/SCENE.yaml with these options."""
        folder = os.path.join(self.outdir, self.name + ("_" + label if label else ""))
        command = ["run", os.path.join(ROOT, "examples", scene + ".yaml"), *options]
        self.commands.append(" ".join(["frond run", "examples/%s.yaml" % scene, *options]))
        begin = time.time()
        done = subprocess.run([self.frond, *command, "-output_dir", folder, "-output_overwrite", "-progress_every", "0"], capture_output=True, text=True)
        if done.returncode:
            sys.exit("%s\n%s" % (self.commands[-1], done.stderr))
        r = Run(folder, done.stdout, time.time() - begin)
        self.costs.append((label or scene, self._markers(r), r.steps, r.seconds, r.balances))
        return r

    @staticmethod
    def _markers(r):
        import h5py

        frames = r.frames()
        if not frames:
            return 0
        with h5py.File(frames[0]) as h:
            return len(h["markers/position"]) if "markers/position" in h else 0

    def number(self, what, ours, reference, bound, source, scale=None, demand=None):
        """ours beside reference; bound is on |ours - reference|/scale (default |reference|) and fails the case; demand, when
        given, is what we set out to reach and did not: the page says so."""
        error = (ours - reference) / (scale or reference)
        self.rows.append((what, "%.6g" % ours, "%.6g" % reference, "%+.2f %%" % (100 * error), "%.3g %%" % (100 * (demand or bound)),
                          "yes" if abs(error) <= (demand or bound) else "**no**", source))
        self._judge(abs(error) <= bound, what, "%.6g, reference %.6g, %+.2f %% (bound %.3g %%)" % (ours, reference, 100 * error, 100 * bound))

    def between(self, what, ours, low, high, source, slack=0.0):
        """ours between two values; slack widens the band for the test only, the page shows the band."""
        inside = low <= ours <= high
        self.rows.append((what, "%.6g" % ours, "%.6g to %.6g" % (low, high), "", "", "yes" if inside else "**no**", source))
        self._judge(low - slack <= ours <= high + slack, what, "%.6g, band %.6g to %.6g (+- %.3g)" % (ours, low, high, slack))

    def _judge(self, ok, what, text):
        self.failed |= not ok
        print("%s %s: %s: %s" % ("ok     " if ok else "FAILED ", self.name, what, text), flush=True)

    def note(self, text):
        self.notes.append(text)
        print("        " + text, flush=True)

    def draw(self, plot, height=3.6):
        """plot(axes) draws the picture."""
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        matplotlib.rcParams["svg.hashsalt"] = self.name
        self.picture = os.path.join(self.outdir, self.name + ".svg")
        figure, axes = plt.subplots(figsize=(6.4, height))
        plot(axes)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
        figure.tight_layout()
        figure.savefig(self.picture, metadata={"Date": None})
        plt.close(figure)

    def page(self, case):
        """The case's page as Markdown."""
        lines = ["# " + case.TITLE, "", case.TEXT.strip(), ""]
        if self.picture:
            lines += ["![%s](%s.svg)" % (case.TITLE, self.name), ""]
        lines += ["| quantity | ours | reference | error | bound | met | source |", "| --- | --- | --- | --- | --- | --- | --- |"]
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        lines += ["", "| run | markers | steps | wall time (s) |", "| --- | --- | --- | --- |"]
        lines += ["| %s | %d | %d | %.0f |" % cost[:4] for cost in self.costs]
        balances = [(label, b) for label, _, _, _, many in self.costs for b in many]
        if balances:
            lines += ["", "Balances:", ""] + ["- %s: %s" % b for b in balances]
        if self.notes:
            lines += [""] + ["- " + n for n in self.notes]
        if self.commands:
            lines += ["", "```", *self.commands, "```"]
        return "\n".join(lines) + "\n"


def cases():
    return sorted(os.path.basename(p)[5:-3] for p in glob.glob(os.path.join(HERE, "case_*.py")))


def write_pages(gallery, case):
    with open(os.path.join(HERE, gallery.name + ".md"), "w") as f:
        f.write(gallery.page(case))
    if gallery.picture:
        with open(gallery.picture) as svg, open(os.path.join(HERE, gallery.name + ".svg"), "w") as f:
            f.write("\n".join(line.rstrip() for line in svg.read().splitlines()) + "\n")


def main():
    p = argparse.ArgumentParser(description="Run the gallery's cases.")
    p.add_argument("frond")
    p.add_argument("outdir")
    p.add_argument("cases", nargs="*")
    p.add_argument("--fine", action="store_true", help="the finer resolution")
    p.add_argument("--pages", action="store_true", help="renew pages and pictures in docs/gallery")
    a = p.parse_args()
    unknown = set(a.cases) - set(cases())
    if unknown:
        sys.exit("no such case: %s; there are: %s" % (", ".join(sorted(unknown)), ", ".join(cases())))
    sys.path.insert(0, HERE)
    sys.dont_write_bytecode = True
    os.makedirs(a.outdir, exist_ok=True)
    failed = []
    for name in a.cases or cases():
        case, g = importlib.import_module("case_" + name), Gallery(name, os.path.abspath(a.frond), os.path.abspath(a.outdir), a.fine)
        case.run(g)
        if a.pages:
            write_pages(g, case)
        if g.failed or not g.rows:
            failed.append(name)
    print("%d cases, failed: %s" % (len(a.cases or cases()), ", ".join(failed) or "none"))
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
