# SPDX-License-Identifier: MIT
"""Holds that the schemas say what the readers read, and the pages what the schemas say.

usage: schemas.py SOURCE MIXLOOP

Every shipped scene and experiment validates. In files that have every kind of mapping, a strange key in any of them, and
the lack of any required one, is refused by the schema and by the reader. The tables of keys in docs are those keys.
"""

import copy
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

COMMAND = {"scene": "explain", "experiment": "simulate", "sweep": "sweep"}


class Loader(yaml.SafeLoader):
    """As YAML 1.2, and an editor, has it: `off` and `no` are texts."""


Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))

# The section of docs where each kind of mapping has its keys: all of them, and of a table no others.
SECTIONS = {
    "the scene": ("scenes.md", "The keys"),
    "a transform": ("scenes.md", "transforms"),
    "a pose or joint": ("scenes.md", "transforms"),
    "a closure 'coincide'": ("scenes.md", "closures"),
    "a closure 'distance'": ("scenes.md", "closures"),
    "a closure 'parallel'": ("scenes.md", "closures"),
    "a closure 'align'": ("scenes.md", "closures"),
    "a closure 'zero'": ("scenes.md", "closures"),
    "a closure's point": ("scenes.md", "closures"),
    "a closure's axis": ("scenes.md", "closures"),
    "a body": ("scenes.md", "bodies"),
    "an inertia": ("scenes.md", "bodies"),
    "a load": ("scenes.md", "loads"),
    "a load at a coordinate": ("scenes.md", "loads"),
    "a load along a formula": ("scenes.md", "loads"),
    "a load between two points": ("scenes.md", "loads"),
    "an end of a load": ("scenes.md", "loads"),
    "the end effector": ("scenes.md", "end_effector"),
    "a box": ("scenes.md", "solids"),
    "a sphere": ("scenes.md", "solids"),
    "a cylinder or a capsule": ("scenes.md", "solids"),
    "the experiment": ("experiments.md", "The keys"),
    "the path": ("experiments.md", "path"),
    "the line": ("experiments.md", "path"),
    "a via point": ("experiments.md", "path"),
    "a point of the motors": ("experiments.md", "path"),
    "the controller": ("experiments.md", "controller"),
    "the state to feed back about": ("experiments.md", "controller"),
    "the controller's safety": ("hil.md", None),
    "the plant": ("experiments.md", "plant"),
    "what holds in real time": ("hil.md", None),
    "the sensors": ("experiments.md", "sensors"),
    "the actuators": ("experiments.md", "actuators"),
    "the torque ripple": ("experiments.md", "actuators"),
    "the drives' friction": ("experiments.md", "actuators"),
    "the limits": ("experiments.md", "limits and expect"),
    "what is expected": ("experiments.md", "limits and expect"),
    "a fault": ("experiments.md", "faults"),
    "the sweep": ("sweeps.md", "The file"),
    "what is expected of a share of the runs": ("sweeps.md", "expect"),
}


def schema_of(mixloop, kind):
    return json.loads(subprocess.run([mixloop, "schema", kind], capture_output=True, text=True, check=True).stdout)


def mappings(schema):
    """Every kind of mapping in a schema: {title: schema}."""
    found = {}

    def walk(part):
        if isinstance(part, dict):
            if part.get("additionalProperties") is False:
                found[part["title"]] = part
            for inner in part.values():
                walk(inner)
        elif isinstance(part, list):
            for inner in part:
                walk(inner)

    walk(schema)
    return found


def places(document, schema):
    """(path, title) of every mapping of a known kind in a document that validates."""
    if "anyOf" in schema and "properties" not in schema:
        for one in schema["anyOf"]:
            if jsonschema.Draft7Validator(one).is_valid(document):
                yield from places(document, one)
                return
    if isinstance(document, list):
        for i, item in enumerate(document):
            yield from (((i, *path), title) for path, title in places(item, schema["items"]))
    elif isinstance(document, dict) and "properties" in schema:
        yield (), schema["title"]
        for key, value in document.items():
            yield from (((key, *path), title) for path, title in places(value, schema["properties"][key]))


def required(schema):
    return schema["required"] if "required" in schema else schema["anyOf"][-1]["required"]


def alternatives(schema):
    """What stands in a mapping, one and one alone."""
    return schema.get("oneOf") or schema.get("anyOf", [{}])[-1].get("oneOf", [])


def at(document, path):
    for step in path:
        document = document[step]
    return document


def refusal(mixloop, kind, document, folder):
    """The code by which the reader refuses a document, or none."""
    file = os.path.join(folder, "changed.yaml")
    with open(file, "w", encoding="utf-8") as out:
        yaml.safe_dump(document, out, sort_keys=False)
    command = [mixloop, COMMAND[kind], file]
    done = subprocess.run(command + ["--json"], capture_output=True, text=True)
    return json.loads(done.stdout).get("error", {}).get("code") if done.returncode == 2 else None


def changed_files_are_refused(source, mixloop, kind, names, schema, wrong):
    validator, known, visited, tried = jsonschema.Draft7Validator(schema), mappings(schema), set(), 0
    folder = os.path.join(source, "tests/schema")
    with tempfile.TemporaryDirectory() as scratch:
        os.makedirs(os.path.join(scratch, "a/b"))
        for name in ("scenes", "experiments"):
            os.symlink(os.path.join(source, name), os.path.join(scratch, name))
        for name in names:
            with open(os.path.join(folder, name), encoding="utf-8") as text:
                document = yaml.load(text, Loader)
            for path, title in places(document, schema):
                where = f"{name}: {'.'.join(map(str, path)) or 'its root'} ({title})"
                if title in visited:
                    continue
                visited.add(title)
                changes = [("unknown_key", lambda m: m.update(strange_key=1))]
                changes += [("missing_key", lambda m, k=key: m.pop(k)) for key in required(known[title])]
                either = [one["required"][0] for one in alternatives(known[title])]
                changes += [("missing_key", lambda m: [m.pop(key, None) for key in either])] if either else []
                changes += [("doubly_defined", lambda m, k=key: m.update({k: 1})) for key in set(either) - set(at(document, path))]
                for code, change in changes:
                    other = copy.deepcopy(document)
                    change(at(other, path))
                    if validator.is_valid(other):
                        wrong.append(f"{where}: the schema takes what has {code}")
                    found = refusal(mixloop, kind, other, os.path.join(scratch, "a/b"))
                    if found not in (code, "missing_key", "unknown_key"):
                        wrong.append(f"{where}: the reader says {found}, expected {code}")
                    tried += 1
    wrong += [f"{kind}: no file of tests/schema has {title}" for title in sorted(set(known) - visited)]
    return tried


def section(source, page, heading):
    text = open(os.path.join(source, "docs", page), encoding="utf-8").read()
    if heading is None:
        return text
    found = re.search(rf"^#+ {re.escape(heading)}\n(.*?)(?=^#+ |\Z)", text, re.M | re.S)
    return found[1] if found else ""


def keys_of_table(text):
    """The first words in back quotes of a table's first cells, where its head says that these are keys."""
    keys = set()
    for table in re.findall(r"^\| key \|.*\n\|[-|]+\n((?:\|.*\n)+)", text, re.M):
        for cell in re.findall(r"^\| ([^|]*) \|", table, re.M):
            keys |= set(re.findall(r"`(\w+)", cell))
    return keys


def pages_name_the_keys(source, known, wrong):
    tables = {}
    for title, schema in known.items():
        page, heading = SECTIONS[title]
        text = section(source, page, heading)
        words = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]*)`|```.*?```", text, re.S)))) | set(
            re.findall(r"\w+", " ".join(re.findall(r"```.*?```", text, re.S))))
        wrong += [f"docs/{page}, {heading}: doesn't name '{key}' of {title}"
                  for key in schema["properties"] if key not in words]
        tables.setdefault((page, heading), set()).update(schema["properties"])
    for (page, heading), keys in tables.items():
        strange = keys_of_table(section(source, page, heading)) - keys
        wrong += [f"docs/{page}, {heading}: '{key}' is no key" for key in sorted(strange)]


def shipped_files(source, kind):
    """Sweeps lie beside the experiments, and are named so."""
    if kind == "sweep":
        return glob.glob(os.path.join(source, "experiments", "*.sweep.yaml"))
    return [file for file in glob.glob(os.path.join(source, f"{kind}s", "*.yaml")) if not file.endswith(".sweep.yaml")]


def main(source, mixloop):
    source = os.path.realpath(source)
    wrong, known, tried = [], {}, 0
    for kind, names in (("scene", ["scene.yaml", "closures.yaml"]), ("experiment", ["experiment.yaml", "line.yaml", "free.yaml", "near_singular.yaml", "motors.yaml"]),
                        ("sweep", ["many.sweep.yaml"])):
        schema = schema_of(mixloop, kind)
        jsonschema.Draft7Validator.check_schema(schema)
        validator = jsonschema.Draft7Validator(schema)
        shipped = sorted(shipped_files(source, kind))
        for file in shipped + [os.path.join(source, "tests/schema", name) for name in names]:
            for error in validator.iter_errors(yaml.load(open(file, encoding="utf-8"), Loader)):
                wrong.append(f"{file}: {error.json_path}: {error.message[:200]}")
        if wrong:
            break
        tried += changed_files_are_refused(source, mixloop, kind, names, schema, wrong)
        known.update(mappings(schema))
    if not wrong:
        pages_name_the_keys(source, known, wrong)
    print(f"{len(known)} kinds of mapping, {tried} changed files")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
