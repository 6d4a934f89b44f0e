#!/usr/bin/python3
"""Filter of the reference manual: turns the C comments of Frond into Doxygen's, for one file, on standard output.

A comment above a declaration documents it; one behind a struct member or an enum value documents that. Text is taken as it stands: what Doxygen would read as markup is escaped.

Above a function, sentences that begin with the names of arguments and a colon ("dp: spacing, m, > 0.", "lo, hi: 3, m.") document these, and one that begins with "Source:" its origin.
The object that a function belongs to needs no words. Errors are read from the code: the checks of the function and of the private functions that it calls.
"""
import glob
import os
import re
import sys

DECLARATION = re.compile(r"^(FROND_EXTERN|typedef|#define \w+ )")


def escape(text):
    text = re.sub(r"([\\@&$#<>%])", r"\\\1", text)
    text = text.replace("::", "\\::").replace("*/", "").replace("~", "\\~")
    return re.sub(r"^(\s*)([-+*])(\s)", r"\1\\\2\3", text, flags=re.M)


def body(comment):
    """Text of a block comment."""
    text = comment.strip()
    text = re.sub(r"^/\*@?|@?\*/$", "", text)
    text = "\n".join(re.sub(r"^\s*\* ?", "", line) if line.strip().startswith("*") else line.strip() for line in text.splitlines())
    text = re.sub(r"^\s*\w+(\(\))? - ", "", text.strip())
    return escape(text)


OBJECTS = {"Sph": "the fluid", "Ancf": "the beams", "Rigid": "the bodies", "Couple": "the coupling", "CoupleSurface": "the surface", "CoupleAttach": "the attachments", "CoupleShort": "the short-range forces", "FrondScene": "the scene"}


def arguments(declaration):
    """Names and types of a function's arguments."""
    inner = declaration[declaration.index("(") + 1 : declaration.rindex(")")]
    found = [re.match(r"\s*((?:const |struct )*\w+(?: const)?)\s*([\s*]*(?:const\s*)?[\s*]*)(\w+)((?:\[[^\]]*\])*)\s*$", a) for a in inner.split(",")]
    return [(m.group(3), m.group(1), m.group(2).strip() + m.group(4)) for m in found if m]


def function(text, declaration, errors):
    """Comment of a function: what it says of each argument, where the method comes from, errors."""
    args = arguments(declaration)
    names = "|".join(a[0] for a in args) or "(?!)"
    parts = re.split(r"(?:(?<=[.;:)])|^)\s*(?=(?:(?:%s)(?:, (?:%s))*|Source): )" % (names, names), re.sub(r"\s+", " ", text.strip()))
    words, about, origin = [], {}, []
    for part in parts:
        label, _, rest = part.partition(": ")
        if re.fullmatch("(?:%s)(?:, (?:%s))*" % (names, names), label):
            about.update((name, rest) for name in label.split(", "))
        elif label == "Source" and rest:
            origin = ["@par Source", rest]
        else:
            words += [part, ""]
    for name, kind, form in args:
        if not form and kind in OBJECTS:
            about.setdefault(name, OBJECTS[kind])
    out = words + ["@param %s %s" % (a[0], about[a[0]]) for a in args if a[0] in about] + origin
    if not re.match(r"(FROND_EXTERN )?void ", declaration):
        code = "PetscErrorCode" in declaration.split("(")[0]
        out.append("@return %s" % ("0, or an error code of PETSc%s" % (": " + errors if errors else " from what it calls.") if code else "The value described."))
    return "\n".join(out)


def declaration_end(lines, i):
    """Index behind the declaration (up to ';' or '{' at depth 0) that starts at line i."""
    depth = 0
    for k in range(i, len(lines)):
        code = re.sub(r"/\*.*?\*/", "", lines[k])
        depth += code.count("{") + code.count("(") - code.count("}") - code.count(")")
        if depth <= 0 and (";" in code or code.rstrip().endswith("}")) or lines[k].startswith("#define"):
            return k + 1
    return len(lines)


def split_members(text):
    """`type a[3], b; /**< text */` becomes one line for each name."""

    def split(m):
        indent, kind, names, doc = m.groups()
        names = re.split(r",\s*(?![^\[]*\])", names)
        return "\n".join("%s%s%s; /**< %s */" % (indent, kind, n, doc) for n in names)

    return re.sub(r"^(\s+)((?:const )?\w+ )([\w\[\]*]+(?:, [\w\[\]*]+)+);\s*/\*\*< (.*?) \*/", split, text, flags=re.M | re.S)


def members(text):
    """Trailing comments of members, and comments on lines of their own inside a struct or an enum."""
    text = re.sub(r"^([^\n/]*[;,{}A-Za-z0-9_)\]=][ \t]*)/\*\s?(.*?)\*/", lambda m: m.group(1) + "/**< " + body("/*" + m.group(2) + "*/") + " */", text, flags=re.M | re.S)
    return re.sub(r"^(\s+)/\*(?!\*)(.*?)\*/\s*$", lambda m: m.group(1) + "/** " + body("/*" + m.group(2) + "*/") + " */", text, flags=re.M | re.S)


CHECK = re.compile(r"(?:PetscCheck\(|SETERRQ\()")
LIBRARY = {}


def split_call(text, start):
    """Arguments, as they stand, of the call whose parenthesis is at start."""
    depth, quoted, args, word, k = 0, False, [], "", start
    while k < len(text):
        c = text[k]
        if quoted:
            word += c
            if c == "\\":
                k += 1
                word += text[k]
            elif c == '"':
                quoted = False
        elif c == '"':
            quoted = True
            word += c
        elif c in "([{":
            depth += 1
            word += c if depth > 1 else ""
        elif c in ")]}":
            depth -= 1
            if depth == 0:
                return [a.strip() for a in args + [word]]
            word += c
        elif c == "," and depth == 1:
            args.append(word)
            word = ""
        else:
            word += c
        k += 1
    return []


def library(folder):
    """Every function of the C files of a folder: its arguments, body and file."""
    if folder not in LIBRARY:
        LIBRARY[folder] = {}
        for path in sorted(glob.glob(os.path.join(folder, "*.c"))):
            with open(path, encoding="utf-8") as f:
                text = re.sub(r"/\*.*?\*/", "", f.read(), flags=re.S)
            for m in re.finditer(r"^(?:static )?(?:inline )?[A-Za-z]\w+ \**(\w+)(\([^;{]*?\))\n\{\n(.*?)^\}", text, flags=re.M | re.S):
                LIBRARY[folder].setdefault(m.group(1), (arguments(m.group(2)), m.group(3)))
    return LIBRARY[folder]


def message(args, known):
    """Words of a check: its code and its text, numbers left open, names put in where the caller's are known."""
    text = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', re.sub(r'"\s*PetscInt_FMT(\s*")?', lambda m: "d" if m.group(1) else 'd"', args[1])))
    values = iter(args[2:])

    def put(m):
        if m.group(0) == "%%":
            return "%"
        value = re.sub(r"^\(\w+\)", "", next(values, "").strip())
        value = known.get(value, value)
        return value[1:-1] if value.startswith('"') else value if re.fullmatch(r"-?[0-9.]+(e-?\d+)?", value) else "..."

    return "%s: %s" % (args[0], escape(re.sub(r"%(?:%|[-+0-9.]*(?:l|z)?[dgsuifx])", put, text)))


def collect(functions, public, name, known, seen, found):
    args, code = functions[name]
    for m in CHECK.finditer(code):
        call = split_call(code, m.end() - 1)
        call = call[2:] if m.group(0).startswith("PetscCheck") else call[1:]
        text = message(call, known)
        if text not in found:
            found.append(text)
    for m in re.finditer(r"\b([A-Z]\w+)\(", code):
        callee = m.group(1)
        if callee in functions and callee not in public and callee not in seen:
            given = [known.get(a, a) for a in split_call(code, m.end() - 1)]
            names = {a[0]: v for a, v in zip(functions[callee][0], given)}
            collect(functions, public, callee, names, seen | {callee}, found)


def errors_of(header_path, name):
    """Lines for the errors that the function itself can raise."""
    folder = os.path.dirname(os.path.abspath(header_path))
    functions, found = library(folder), []
    if name not in functions:
        return ""
    public = set(re.findall(r"^FROND_EXTERN [^;(]*?(\w+)\(", "".join(open(h, encoding="utf-8").read() for h in glob.glob(os.path.join(folder, "*.h"))), flags=re.M))
    collect(functions, public, name, {}, {name}, found)
    return "".join("\n- %s" % f for f in found)


def header(path, lines):
    out, doc, i = [], None, 0
    while i < len(lines):
        line = lines[i]
        if line.lstrip().startswith("/*"):
            k = i
            while "*/" not in lines[k]:
                k += 1
            doc = body("\n".join(lines[i : k + 1]))
            if not out:
                out += ["/** @file %s" % os.path.basename(path), doc, "*/"]
                doc = None
            i = k + 1
            continue
        if DECLARATION.match(line):
            k = declaration_end(lines, i)
            code = "\n".join(lines[i:k])
            m = re.match(r"FROND_EXTERN [^;(]*?(\w+)\(", code)
            if doc and m:
                doc = function(doc, code, errors_of(path, m.group(1)))
            if doc:
                out.append("/** " + doc + " */")
            out.append(split_members(members("\n".join(lines[i:k]))))
            i, doc = k, None
            continue
        doc = None
        out.append(line)
        i += 1
    return out


def main(path):
    with open(path, encoding="utf-8") as f:
        lines = f.read().splitlines()
    print("\n".join(header(path, lines)))


if __name__ == "__main__":
    main(sys.argv[1])
