#!/usr/bin/python3
"""Filter of the reference manual: turns the C comments of Frond into Doxygen's, for one file, on standard output.

A comment above a declaration documents it; one behind a struct member or an enum value documents that. Text is taken as it stands: what Doxygen would read as markup is escaped.
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


def public_names(path):
    """Functions that the headers beside this file declare."""
    names = set()
    for header in glob.glob(os.path.join(os.path.dirname(os.path.abspath(path)), "*.h")):
        with open(header, encoding="utf-8") as f:
            names |= set(re.findall(r"^FROND_EXTERN [^;(]*?(\w+)\(", f.read(), flags=re.M))
    return names


def source(path, lines):
    """Of a source file: its comments above public functions, with their declarations."""
    names, doc, i = public_names(path), None, 0
    while i < len(lines):
        if lines[i].startswith("/*"):
            k = i
            while "*/" not in lines[k]:
                k += 1
            doc, i = body("\n".join(lines[i : k + 1])), k + 1
            continue
        m = re.match(r"^[A-Za-z]\w+ \**(\w+)\(", lines[i])
        if m and m.group(1) in names and doc:
            k = i
            while "{" not in lines[k] and ";" not in lines[k]:
                k += 1
            yield "/** %s */\n%s\n{\n}" % (doc, "\n".join(lines[i:k]))
        doc, i = None, i + 1


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
    print("\n".join(header(path, lines) if path.endswith(".h") else source(path, lines)))


if __name__ == "__main__":
    main(sys.argv[1])
