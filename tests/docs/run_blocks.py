# SPDX-License-Identifier: MIT
"""Runs the command blocks of a Markdown page, one after the other, in a folder that looks like the repository.

usage: run_blocks.py SOURCE BIN PAGE

Fences that are commands, by the first word after the backticks:
  sh         run as it stands by sh -eu; a command that fails fails the page
  sh slow    not run by the tests (too long, needs a person or another machine): counted
  yaml FILE  written to that file, for the commands below it
  console    `$ COMMAND` lines are run, and each line shown below one must be in what it prints ("..." for left out)
The second word `status=N` is the exit status that is expected of the block. A fence without a word that begins with a
command of ours is an error: it would never be run.
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile

COMMAND = re.compile(r"(\$ |tools/|build/|mixloop(-\w+)? \w|cmake |apt-get |lcm-)")


def blocks(page):
    """(line, words, text) of every fence."""
    words, text, start = None, [], 0
    for number, line in enumerate(open(page, encoding="utf-8"), 1):
        if line.startswith("```"):
            if words is None:
                words, text, start = line[3:].split(), [], number
            else:
                yield start, words, "".join(text)
                words = None
        elif words is not None:
            text.append(line)


def copy_of(source, binaries, folder):
    """Links to all that the repository has, but a build folder with these binaries; what is written stays in here."""
    for name in os.listdir(source):
        if name not in ("build", "results", ".git"):
            os.symlink(os.path.join(source, name), os.path.join(folder, name))
    os.makedirs(os.path.join(folder, "build/release"))
    os.symlink(binaries, os.path.join(folder, "build/release/bin"))


def run(text, folder):
    done = subprocess.run(["sh", "-eu"], input=text, cwd=folder, text=True, capture_output=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def run_sh(text, expected, folder):
    status, out, err = run(text, folder)
    return [] if status == expected else [f"exit status {status}, expected {expected}", out[-2000:], err[-2000:]]


def run_console(text, expected, folder):
    commands, shown = [], []
    for line in text.splitlines():
        if line.startswith("$ "):
            commands.append(line[2:])
        elif line.strip() and line.strip() != "...":
            shown.append(line.rstrip())
    status, out, err = run("\n".join(commands), folder)
    printed = {line.rstrip() for line in (out + err).splitlines()}
    wrong = [] if status == expected else [f"exit status {status}, expected {expected}", err[-2000:]]
    return wrong + [f"not printed: {line}" for line in shown if line not in printed]


def main(source, binaries, page):
    ran = slow = 0
    failures = []
    with tempfile.TemporaryDirectory(prefix="mixloop-docs-") as folder:
        copy_of(os.path.realpath(source), os.path.realpath(binaries), folder)
        os.environ["PATH"] = os.path.realpath(binaries) + ":" + os.environ["PATH"]
        for line, words, text in blocks(page):
            where = f"{os.path.relpath(page, source)}:{line}"
            if not words and COMMAND.match(text):
                failures.append(f"{where}: a command in a fence without a word: sh, sh slow or console")
            if words[:1] == ["yaml"] and len(words) == 2:
                with open(os.path.join(folder, words[1]), "w", encoding="utf-8") as file:
                    file.write(text)
            if not words or words[0] not in ("sh", "console"):
                continue
            if "slow" in words[1:]:
                slow += 1
                continue
            expected = next((int(w[7:]) for w in words[1:] if w.startswith("status=")), 0)
            runner = run_sh if words[0] == "sh" else run_console
            failures += [f"{where}: {text}{shlex.quote(what)}" for what in runner(text, expected, folder)]
            ran += 1
    print(f"{os.path.relpath(page, source)}: {ran} command blocks run, {slow} marked slow and not run")
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
