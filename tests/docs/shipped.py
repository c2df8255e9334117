# SPDX-License-Identifier: MIT
"""Holds that docs/shipped.md lists every scene and experiment, each with the first sentence of its own head.

usage: shipped.py SOURCE [--write]     --write puts the tables there
"""

import glob
import os
import re
import sys


def sentence(file):
    """The first sentence of the comment that a file begins with."""
    lines = []
    for line in open(file, encoding="utf-8"):
        if not line.startswith("#"):
            break
        lines.append(line[1:].strip())
    return re.split(r"(?<=[^.A-Z]\.)\s", " ".join(lines))[0].rstrip(".:")


def table(source, folder):
    rows = ["| | |", "|---|---|"]
    for file in sorted(glob.glob(os.path.join(source, folder, "*.yaml"))):
        name = os.path.basename(file)
        rows.append(f"| [{name}](../{folder}/{name}) | {sentence(file)} |")
    return "\n".join(rows) + "\n\n"


def main(source, write=False):
    page = os.path.join(source, "docs/shipped.md")
    text = open(page, encoding="utf-8").read()
    expected = text
    for folder in ("scenes", "experiments"):
        expected = re.sub(rf"(## {folder.capitalize()}\n\n)(?:\|.*\n)*\n*", lambda m: m[1] + table(source, folder), expected)
    if write:
        open(page, "w", encoding="utf-8").write(expected)
    elif text != expected:
        print("docs/shipped.md isn't what the files' heads say; tests/docs/shipped.py . --write puts it right")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], "--write" in sys.argv))
