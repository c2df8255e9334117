# SPDX-License-Identifier: MIT
"""Every link and picture of the documents leads somewhere: links.py ROOT"""
import pathlib
import re
import subprocess
import sys


def anchors(text):
    """The names that headings are linked by."""
    found = set()
    for heading in re.findall(r"^#+ +(.+)$", re.sub(r"```.*?```", "", text, flags=re.S), flags=re.M):
        name = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()).replace(" ", "-")
        found.add(name)
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    files = subprocess.run(["git", "-C", root, "ls-files", "*.md"], capture_output=True, text=True, check=False).stdout.split()
    files = files or [str(file.relative_to(root)) for file in root.rglob("*.md") if "build" not in file.parts]
    lost = []
    for name in files:
        file = root / name
        text = file.read_text()
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.S)):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            to = (file.parent / path).resolve() if path else file
            if not to.exists():
                lost.append(f"{name}: {target}: no such file")
            elif anchor and to.suffix == ".md" and anchor not in anchors(to.read_text()):
                lost.append(f"{name}: {target}: no such heading")
    print("\n".join(lost))
    return 1 if lost else 0


sys.exit(main())
