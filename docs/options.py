#!/usr/bin/python3
"""The option reference of README.md, from what `frond -help` says.

    /usr/bin/python3 docs/options.py build/bin/frond            write it into README.md
    /usr/bin/python3 docs/options.py build/bin/frond --check    exit code 1 when README.md is out of date
"""
import os
import re
import subprocess
import sys

BEGIN, END = "<!-- options: made by docs/options.py -->", "<!-- options end -->"
TITLES = [
    ("Scene: domain and fluid", "Domain and fluid"),
    ("Scene: walls", "Walls"),
    ("Scene: regions", "Regions"),
    ("Regions: the same", "Regions: `region_...` for all, `region_<name>_...` for one"),
    ("Scene: structures", "Structures"),
    ("Beams", "Beams: `beam_...` for all, `beam_<name>_...` for one"),
    ("Lumped beams", "Lumped beams: `beam_...` for all, `beam_<name>_...` for one"),
    ("Rigid bodies: the same", "Rigid bodies: `body_...` for all, `body_<name>_...` for one"),
    ("Scene: joints", "Joints"),
    ("Joints: the same", "Joints: `joint_...` for all, `joint_<name>_...` for one"),
    ("Scene: openings", "Openings of the fluid"),
    ("Openings: the same", "Openings: `opening_...` for all, `opening_<name>_...` for one"),
    ("Scene: links", "Links between beams"),
    ("Links: the same", "Links: `link_...` for all, `link_<name>_...` for one"),
    ("Scene: run and output", "Run and output"),
    ("SPH fluid options", "Fluid"),
    ("Coupling options", "Coupling"),
    ("Attachment options", "Beams attached to bodies"),
    ("Slender beams (ANCF)", "Beam solver"),
    ("Rigid bodies", "Rigid body solver"),
    ("Short-range forces", "Short-range forces of rigid bodies and beams"),
    ("Short-range forces of beams", "Short-range forces of beams"),
]
LINE = re.compile(r"^ {2,4}-(\w+):?\s*(?:<(.*?)>:?)?\s*(.*?)\s*(?:\((\w*)\))?$")


def blocks(text):
    """Title -> list of (name, default, description) of every block of -help."""
    found, rows = {}, None
    lines = text.splitlines()
    for before, line in zip([""] + lines, lines):
        if before.startswith("-----"):
            rows = found.setdefault(line.rstrip(":"), [])
        elif rows is not None and line.startswith("  -"):
            m = LINE.match(line)
            if m and not any(m.group(1) == r[0] for r in rows):
                given = "" if re.search(r"\((needed|default)\b", m.group(3)) else default(m.group(2))
                rows.append((m.group(1), given, describe(m.group(3))))
    return found


def default(text):
    """'now cubic : formerly cubic' -> 'cubic'; '1.2 : 1.2' -> '1.2'."""
    if not text:
        return ""
    value = text.replace("now ", "").replace("formerly ", "").split(" : ")[-1].strip()
    value = re.sub(r"(\d)\.(?=\D|$)", r"\1", value)
    return {"TRUE": "true", "FALSE": "false", "": ""}.get(value, value)


def describe(text):
    m = re.match(r"(.*) \(choose one of\) (.*)$", text)
    if m:
        text = m.group(1) + ": " + ", ".join("`%s`" % w for w in m.group(2).split())
    return text.replace("|", "\\|").replace("<", "&lt;").strip()


def reference(program):
    text = subprocess.run([program, "-help"], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
    found = blocks(text)
    out = [BEGIN, ""]
    for start, title in TITLES:
        names = [t for t in found if t == start or (t.startswith(start) and start not in ("Rigid bodies", "Short-range forces"))]
        if not names:
            sys.exit("docs/options.py: frond -help has no block '%s'" % start)
        out += ["#### " + title, "", "| option | default | meaning |", "| --- | --- | --- |"]
        out += ["| `%s` | %s | %s |" % (n, "`%s`" % d if d else "", t) for n, d, t in found[names[0]] if n not in ("fault_nan",)]
        out.append("")
    return "\n".join(out + [END])


def main():
    readme = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "README.md")
    with open(readme, encoding="utf-8") as f:
        old = f.read()
    start, end = old.index(BEGIN), old.index(END) + len(END)
    new = old[:start] + reference(sys.argv[1]) + old[end:]
    if "--check" in sys.argv:
        if new != old:
            import difflib

            print("".join(difflib.unified_diff(old.splitlines(True), new.splitlines(True), "README.md", "frond -help")))
            sys.exit("README.md is out of date: run docs/options.py")
        return
    with open(readme, "w", encoding="utf-8") as f:
        f.write(new)


if __name__ == "__main__":
    main()
