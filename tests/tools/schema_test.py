#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The JSON of each program names its format and version, and is what tools/schema says of it.

    python3 tests/tools/schema_test.py BUILD_DIR

Every program with an option --json is run here, or named in ELSEWHERE with the reason. A schema allows no member that it
does not name, so a new member is a change of the schema. Needs python3-jsonschema. Exit status 0 or 1.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCHEMAS = ROOT / "tools/schema"
LIVER = ROOT / "model/scenes/liver.toml"
VECTORS = ROOT / "tests/data/vectors"
# format: the programs that write it, with arguments; {t} is a folder that goes in the end
COMMANDS = {
    "tactd-run": [f"tactd {LIVER} --free-run --ticks 50 --no-telemetry --no-black-box --json -"],
    "tactd-faults": ["tactd --faults --json {t}/faults.json"],
    "tactd-devices": ["tactd --list-devices --json {t}/devices.json"],
    "tact-limits": [f"tact-limits {LIVER} --out {{t}}/limits --no-pictures --plan late-ticks,e-stop,torque --json",
                    f"tact-limits {LIVER} --out {{t}}/wall --no-pictures --plan stiff-wall --json --tester T --serial A"],
    "tact-jitter": ["tact-jitter --bare --duration 0.2 --json {t}/bare.json",
                    f"tact-jitter {LIVER} --duration 0.3 --peer cyclictest --peer-gate 9 --json {{t}}/jitter.json"],
    "tact-jitter-compare": ["tact-jitter compare {t}/bare.json {t}/bare.json --json {t}/compared.json"],
    "tact-mesh": [f"tact-mesh --json --unit-m 0.01 {ROOT}/{{mesh}}"],
    "tact-verify": [f"tact-verify {VECTORS}/{{vectors}} --json"],
    "tact-stability": ["tact-stability --out {t}/maps --quick --only loss --no-pictures --json"],
}
# Programs whose JSON has its format and version, or another member that names it, and no schema.
ELSEWHERE = {
    "tact-arm-bench": "takes long", "tact-pose-bench": "takes long", "tact-figure": "takes long",
    "tact-chart": "its documents carry `schema`", "tact-condense": "takes long", "tact-doctor": "no format yet",
    "tact-fit": "needs measurements", "tact-plan": "needs a chart", "tact-reference": "takes long",
    "tact-track-send": "needs a recording", "tact-view": "serves until it is stopped",
}


def programs_with_json():
    """Names of programs whose sources have an option --json."""
    for path in sorted(ROOT.glob("*/*/CMakeLists.txt")):
        if path.relative_to(ROOT).parts[0] == "tests":
            continue
        for name, sources in re.findall(r"tact_program\((\S+)\s+SOURCES ([^)]*?) LINKS", path.read_text()):
            texts = [path.parent / word for word in sources.split()] + list(path.parent.glob("options.cc")) + \
                list(path.parent.glob("command_line.cc"))
            if any('"--json' in text.read_text() for text in texts if text.exists()):
                yield name


def told_by(build, command, folder):
    """The document of one run: of its file, or of its standard output."""
    words = command.format(t=folder, mesh="model/scenes/meshes/press.obj", vectors="001_disc_stack.json").split()
    done = subprocess.run([str(build / words[0]), *words[1:]], capture_output=True, text=True, check=False, timeout=250)
    file = words[words.index("--json") + 1] if "--json" in words[:-1] else "-"
    if file.startswith(str(folder)):
        return json.loads(pathlib.Path(file).read_text())
    if not done.stdout:
        raise ValueError(f"{command}: status {done.returncode}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)


def faults_of(name, document, schema):
    if (document.get("format"), document.get("version")) == (None, None):
        yield f"{name}: names neither its format nor its version"
    for error in jsonschema.Draft7Validator(schema).iter_errors(document):
        yield f"{name}: {'/'.join(map(str, error.absolute_path)) or 'top'}: {error.message[:200]}"


def blind(name, document, schema):
    """A document with another format, or a member more, must be refused."""
    for change in ({"format": "x"}, {"version": 999}, {"a_member_that_no_schema_has": 1}):
        if not list(faults_of(name, {**copy.deepcopy(document), **change}, schema)):
            yield f"{name}: its schema takes {change}"


def main():
    build, found, runs = pathlib.Path(sys.argv[1]).resolve(), [], 0
    known = {command.split()[0] for commands in COMMANDS.values() for command in commands}
    for name in sorted(set(programs_with_json()) - known - set(ELSEWHERE)):
        found.append(f"{name}: has --json, and is neither run here nor named in ELSEWHERE")
    files = {path.name.removesuffix(".schema.json") for path in SCHEMAS.glob("*.schema.json")}
    found += [f"{name}: a schema without a run, or a run without a schema" for name in sorted(files ^ set(COMMANDS))]
    with tempfile.TemporaryDirectory() as folder:
        for name in (name for name in COMMANDS if name in files):
            schema = json.loads((SCHEMAS / f"{name}.schema.json").read_text())
            for command in COMMANDS[name]:
                runs += 1
                try:
                    document = told_by(build, command, pathlib.Path(folder))
                except (OSError, ValueError, subprocess.TimeoutExpired) as error:
                    found.append(f"{name}: {error}")
                    continue
                found += faults_of(name, document, schema)
                found += blind(name, document, schema)
    print(*(f"{fault}\n" for fault in found), sep="", end="")
    print(f"schema: {len(files)} schemas, {runs} runs, {len(found)} faults")
    return 1 if found or not runs else 0


if __name__ == "__main__":
    sys.exit(main())
