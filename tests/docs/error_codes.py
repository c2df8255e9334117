# SPDX-License-Identifier: MIT
"""Holds that docs/errors.md has every error code of the sources, and no other.

usage: error_codes.py SOURCE
"""

import os
import re
import sys

ROOMS = ("notation dynamics import integrators planner controller plant loop library stability sweep tuning runtime processes watch report view "
         "commands").split()
# A code is the first argument of what is thrown or told.
THROWN = re.compile(r"""\b(?:InputError|RunFault|Error|fail|error|report)\s*[({]\s*(?:json,\s*program,\s*)?
                        (?:[\w.]+\s*\?\s*"([a-z_]+)"\s*:\s*)?"([a-z_]+)"\s*,""", re.X)


def main(source):
    found = {}
    for room in ROOMS:
        for folder, _, names in os.walk(os.path.join(source, room)):
            for name in names:
                if name.endswith((".cpp", ".hpp")):
                    file = os.path.join(folder, name)
                    for codes in THROWN.findall(open(file, encoding="utf-8").read()):
                        found.update({code: os.path.relpath(file, source) for code in codes if code})
    page = open(os.path.join(source, "docs/errors.md"), encoding="utf-8").read()
    listed = re.findall(r"^\| `([a-z_]+)` \|", page, re.M)
    wrong = [f"{found[code]}: '{code}' is not in docs/errors.md" for code in sorted(set(found) - set(listed))]
    wrong += [f"docs/errors.md: no source has '{code}'" for code in sorted(set(listed) - set(found))]
    wrong += [f"docs/errors.md: '{code}' stands there twice" for code in sorted(set(listed)) if listed.count(code) > 1]
    print(f"{len(found)} codes")
    print("\n".join(wrong))
    return 1 if wrong or not found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
