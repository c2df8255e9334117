# SPDX-License-Identifier: MIT
"""Holds that a shared library exports the documented names and no others.

usage: exported_names.py LIBRARY PAGE

The page's table has a row a name, in back quotes in its first cell: a type, an enumeration or a function. Whatever
belongs to a documented type (members, type information) is documented with it.
"""

import re
import subprocess
import sys

EXPORTED = re.compile(r"(?:typeinfo(?: name)? for |vtable for )?mixloop::v1::(\w+)")


def exported(library):
    """{name below mixloop: the symbols that belong to it}, and the symbols of no such name."""
    lines = subprocess.run(["nm", "-DC", "--defined-only", library], text=True, capture_output=True, check=True).stdout
    names, strange = {}, []
    for line in lines.splitlines():
        _, kind, symbol = line.split(maxsplit=2) if not line.startswith(" ") else ("", *line.split(maxsplit=1))
        if kind == "A":  # the version that the names belong to
            continue
        match = EXPORTED.match(symbol)
        if match and "::Content::" not in symbol.split("(")[0]:
            names.setdefault(match[1], []).append(symbol)
        else:
            strange.append(symbol)
    return names, strange


def documented(page):
    """{name: whether it has symbols of its own: enumerations and plain structs have none that must be there}."""
    rows = re.findall(r"^\| `(\w+)(?:\(\))?` \|([^|]*)\|", open(page, encoding="utf-8").read(), re.M)
    return {name: not re.search(r"\b(enumeration|plain struct)\b", kind) for name, kind in rows}


def main(library, page):
    names, strange = exported(library)
    table = documented(page)
    wrong = [f"exported, and no name of ours: {symbol}" for symbol in strange]
    wrong += [f"exported, not in {page}: {name} ({names[name][0]})" for name in names if name not in table]
    wrong += [f"in {page}, not exported: {name}" for name, needed in table.items() if needed and name not in names]
    print(f"{len(names)} names with {sum(map(len, names.values()))} symbols exported, {len(table)} documented")
    print("\n".join(wrong))
    return 1 if wrong or not names or not table else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
