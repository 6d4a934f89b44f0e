#!/usr/bin/python3
"""optionpage.py PROGRAM FILE: the option reference by itself, from what `frond -help` says now."""
import sys

import options

text = options.reference(sys.argv[1]).replace(options.BEGIN, "").replace(options.END, "")
with open(sys.argv[2], "w", encoding="utf-8") as f:
    f.write("# Options of frond\n" + text)
print("%s: %d options" % (sys.argv[2], text.count("\n| `")))
