"""
coverage.py JSON LIST [LEAST]: lines and branches from gcovr's JSON. Prints one line; writes LIST: shares of the branches by kind, lines never
reached for each file, branches never taken for each kind. Fails below LEAST percent of lines. Run in the folder of the repository.
"""
import json
import re
import sys

# The kind of a branch is the first whose pattern its statement has; the last is all that is left: decisions of our own.
KINDS = (
    ("PetscCall that returns an error", r"\bPetscCall(MPI|Abort|Back)?\("),
    ("files and HDF5 that fail", r"\bFileCheck\(|\bH5[A-Z]\w*\(|\b(fopen|fclose|fsync|fflush|ferror|rename|ftruncate|fstat|open|close|pread|pwrite|opendir|fork|waitpid|execv?p?)\("),
    ("out of memory", r"\b(Petsc)?(Malloc|Calloc|malloc|calloc|realloc|aligned_alloc)\w*\("),
    ("PetscCheck that refuses", r"\bPetsc(Check|Assert)\(|\bSETERRQ\("),
    ("threads and loops of OpenMP", r"#pragma omp"),
    ("loops", r"^\s*(\} )?(for|while) \("),
    ("decisions", r""),
)


def statement(text, line):
    """The line and what follows up to the end of its statement."""
    out = text[line - 1]
    for more in text[line:line + 8]:
        if re.search(r"[;{}]\s*(/\*.*\*/\s*)?$", out) or out.lstrip().startswith("#"):
            break
        out += " " + more.strip()
    return out


def ranges(numbers):
    out = []
    for n in numbers:
        if out and n == out[-1][1] + 1:
            out[-1][1] = n
        else:
            out.append([n, n])
    return ", ".join("%d" % a if a == b else "%d-%d" % (a, b) for a, b in out)


def percent(part, whole):
    return 100 * part / whole if whole else 100.0


def main():
    lines = reached = 0
    kinds = {name: [0, 0, []] for name, _ in KINDS}
    missing = []
    for f in json.load(open(sys.argv[1]))["files"]:
        text = open(f["file"], encoding="utf-8").read().splitlines()
        never = []
        for line in f["lines"]:
            if line.get("gcovr/noncode") or line.get("gcovr/excluded"):
                continue
            lines += 1
            reached += line["count"] > 0
            if not line["count"]:
                never.append(line["line_number"])
            branches = line.get("branches", [])
            if not branches:
                continue
            words = statement(text, line["line_number"])
            kind = kinds[next(name for name, pattern in KINDS if re.search(pattern, words))]
            kind[0] += len(branches)
            taken = sum(b["count"] > 0 for b in branches)
            kind[1] += taken
            if taken < len(branches):
                kind[2].append("%s:%d: %d of %d: %s" % (f["file"], line["line_number"], len(branches) - taken, len(branches), " ".join(words.split())[:90]))
        if never:
            missing.append("%s: %s" % (f["file"], ranges(sorted(never))))
    total, taken = (sum(k[i] for k in kinds.values()) for i in (0, 1))
    own = [sum(kinds[name][i] for name, _ in KINDS[1:]) for i in (0, 1)]
    decided = [sum(kinds[name][i] for name in ("loops", "decisions")) for i in (0, 1)]
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        out.write("| kind | branches | never taken | share of all never taken |\n| --- | --- | --- | --- |\n")
        for name, (n, t, _) in kinds.items():
            out.write("| %s | %d | %d | %.1f %% |\n" % (name, n, n - t, percent(n - t, total - taken)))
        out.write("\nLines never reached\n\n" + "\n".join(missing) + "\n")
        for name, (n, t, where) in kinds.items():
            out.write("\nBranches never taken: %s\n\n%s\n" % (name, "\n".join(where)))
    print("lines: %.1f %% (%d of %d), branches: %.1f %% (%d of %d); without error returns of PetscCall %.1f %%, loops and decisions alone %.1f %% (%d of %d)" %
          (percent(reached, lines), reached, lines, percent(taken, total), taken, total, percent(own[1], own[0]), percent(decided[1], decided[0]), decided[1], decided[0]))
    sys.exit(percent(reached, lines) < float(sys.argv[3]) if len(sys.argv) > 3 else 0)


main()
