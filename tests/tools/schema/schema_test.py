#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The JSON of each program names its format and version, and is what tools/schema says of it.

    python3 tests/tools/schema/schema_test.py BUILD_DIR

Every program with an option --json is run here; of tact-lab reference, which takes minutes, the committed files are evaluated. A
schema allows no member that it does not name, so a new member is a change of the schema. Needs python3-jsonschema. Exit
status 0 or 1.
"""
import copy
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCHEMAS = ROOT / "tools/schema"
SCENES = ROOT / "model/scenes"
LIVER = SCENES / "liver.toml"
REFERENCES = ROOT / "tests/data/reference"
BOX = ("--set elastic.youngs_modulus_Pa=5000 elastic.poisson_ratio=0.45 elastic.fixed_min_m=[-1,-1,-1] "
       "elastic.fixed_max_m=[1,1,-0.0199] --mesh-size-m 0.03")
KINDS = ("status", "frame", "figure")  # of /live
FEW = "--quick --no-pictures --laws"
VECTORS = ROOT / "tests/data/vectors"
# format: the programs that write it, with arguments; {t} is a folder that goes in the end
COMMANDS = {
    "tactd-run": [f"tactd {LIVER} --free-run --ticks 50 --no-telemetry --no-black-box --json -"],
    "tactd-faults": ["tactd --faults --json {t}/faults.json"],
    "tactd-parameters": [f"tactd {LIVER} --parameters --json -", f"tactd {SCENES}/gum.toml --parameters --json {{t}}/gum.json"],
    "tactd-devices": ["tactd --list-devices --json {t}/devices.json"],
    "tact-limits": [f"tact-limits {LIVER} --out {{t}}/limits --no-pictures --plan late-ticks,e-stop,torque --json",
                    f"tact-limits {LIVER} --out {{t}}/wall --no-pictures --plan stiff-wall --json --tester T --serial A"],
    "tact-jitter": ["tact-jitter --bare --duration 0.2 --json {t}/bare.json",
                    f"tact-jitter {LIVER} --duration 0.3 --peer cyclictest --peer-gate 9 --json {{t}}/jitter.json"],
    "tact-jitter-compare": ["tact-jitter compare {t}/bare.json {t}/bare.json --json {t}/compared.json"],
    "tact-mesh": [f"tact-mesh --json --unit-m 0.01 {ROOT}/{{mesh}}",
                  f"tact-mesh --json {ROOT}/{{mesh}} --weld --out {{t}}/welded.obj --align {LIVER}"],
    "tact-verify": [f"tact-verify {VECTORS}/{{vectors}} --json"],
    "tact-stability": ["tact-lab stability --out {t}/maps --quick --only loss --no-pictures --json"],
    "tact-sweep": [f"tact-lab sweep {ROOT}/tests/data/scenes/plain.toml --depth-m 0.002 --limit-N-per-m 1 --no-pictures "
                   "--out {t}/sweep --json"],
    "tact-doctor": ["tact-doctor --json"],
    "tact-mcap": ["tact-mcap {t}/run.tactlog {t}/run.mcap --json"],
    "tact-condense": [f"tact-lab condense {ROOT}/tests/data/scenes/plain.toml {BOX} --out {{t}}/map --json"],
    "tact-fit": [f"tact-lab fit {LIVER} --relaxation {{t}}/hold.csv --json",
                 f"tact-lab fit {LIVER} --set varies_by_place=false --data {{t}}/press.csv --law hex_sheet,compliance --json",
                 f"tact-lab fit {LIVER} --reference {REFERENCES}/liver.json --law disc_stack_linear --json"],
    "tact-chart": [f"tact-lab chart {LIVER} --reference {REFERENCES}/liver.json {FEW} compliance --out {{t}}/chart --json"],
    "tact-tool-chart": [f"tact-lab chart {LIVER} --tool-reference {REFERENCES}/liver_tool.json {FEW} rhombus "
                        f"--finite-strain {REFERENCES}/liver_finite_strain_tool.json "
                        "--out {t}/tool --json"],
    "tact-plan": [f"tact-lab plan {LIVER} --chart {{t}}/chart/chart.json --dry-run --json"],
    "tact-view": [],  # these by viewer_documents()
    "tact-live": [],
    "tact-view-export": [],
}
# What takes minutes to make is committed.
FILES = {
    "tact-reference": ["liver.json"], "tact-tool-reference": ["liver_tool.json", "liver_tool_skin.json"],
    "tact-sideways-reference": ["liver_sideways.json"],
}


def programs_with_json():
    """Names of programs and subcommands whose sources have an option --json."""
    for path in [ROOT / top / "CMakeLists.txt" for top in ("firmware", "host", "tools")]:
        for name, sources in re.findall(r"tact_program\((\S+)\s+SOURCES ([^)]*?)\s+LINKS", path.read_text()):
            texts = [path.parent / word for word in sources.split()]
            texts += [text.parent / word for text in texts for word in ("options.cc", "command_line.cc")]
            for text in texts:
                if text.exists() and '"--json' in text.read_text():  # a subcommand is a file of tools/lab
                    yield f"tact-{text.stem}".replace("_", "-") if name == "tact-lab" else name


def output_of(build, command, folder):
    """The document of one run: of its file, or of its standard output."""
    words = command.format(t=folder, mesh="model/scenes/meshes/press.obj", vectors="001_disc_stack.json").split()
    done = subprocess.run([str(build / words[0]), *words[1:]], capture_output=True, text=True, check=False, timeout=250)
    file = words[words.index("--json") + 1] if "--json" in words[:-1] else "-"
    if file.startswith(str(folder)):
        return json.loads(pathlib.Path(file).read_text())
    if not done.stdout:
        raise ValueError(f"{command}: status {done.returncode}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)


def prepare(build, folder):
    """Inputs of the programs: a log, a press and a hold of a bench."""
    subprocess.run([str(build / "tactd"), str(LIVER), "--free-run", "--ticks", "50", "--no-telemetry", "--no-black-box",
                    "--record", str(folder / "run.tactlog")], stdout=subprocess.DEVNULL, check=True, timeout=60)
    (folder / "press.csv").write_text("depth_m,force_N\n0,0\n0.001,0.05\n0.002,0.14\n0.003,0.26\n0.004,0.4\n0.005,0.56\n")
    (folder / "hold.csv").write_text("time_s,force_N\n0,1\n0.5,0.9\n1,0.83\n2,0.75\n4,0.66\n8,0.61\n16,0.6\n")


def messages(port, token, seconds=20):
    """Text messages of ws://127.0.0.1:PORT/live, as they come."""
    with socket.create_connection(("127.0.0.1", port), timeout=seconds) as connection:
        connection.sendall(f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                           f"Sec-WebSocket-Key: dGVzdCBvZiB0aGUgdGVzdA==\r\nSec-WebSocket-Version: 13\r\n"
                           f"Origin: http://127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\n\r\n".encode())
        stream, seen = connection.makefile("rb"), 0
        while stream.readline().strip():
            pass  # the head of the answer
        while head := stream.read(2):
            size = head[1] & 0x7f
            if size > 125:
                size = int.from_bytes(stream.read(2 if size == 126 else 8), "big")
            text = stream.read(size)
            if head[0] & 0x0f != 1:
                continue  # no text
            message = json.loads(text)
            if message["kind"] == "frame":
                seen += 1
                answer = json.dumps({"seen": seen}).encode()
                connection.sendall(bytes([0x81, 0x80 | len(answer), 0, 0, 0, 0]) + answer)
            yield message


def one_of_each_kind(port, token):
    seen = {}
    for message in messages(port, token):
        contacts = message.get("contacts") if message["kind"] == "frame" else "-"
        if contacts or message["kind"] not in seen:
            seen[message["kind"]] = message
        if len(seen) == len(KINDS) and seen["frame"].get("contacts"):
            return list(seen.values())
    raise ValueError(f"/live sent {sorted(seen)} alone")


def viewer_documents(build, folder):
    """What tact-view says when it is ready, to a page, and of the export of what it has recorded."""
    path, recording, page = folder / "socket", folder / "recording", folder / "page"
    page.mkdir()
    scenes = folder / "scenes"
    scenes.mkdir()
    (scenes / "liver.json").write_text(json.dumps(output_of(build, f"tactd {LIVER} --parameters --json -", folder)))
    (page / "index.html").write_text("<!doctype html>")
    view = str(build / "tact-view")
    with subprocess.Popen([view, "--socket", str(path), "--port", "0", "--record", str(recording), "--figure",
                           "--scenes", str(scenes), "--page", str(page), "--json"],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as viewer:
        try:
            ready = json.loads(viewer.stdout.readline())
            with subprocess.Popen([str(build / "tactd"), str(LIVER), "--seconds", "20", "--no-black-box", "--socket", str(path)],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
                live = one_of_each_kind(ready["port"], ready["token"])
                run.terminate()
        finally:
            viewer.send_signal(signal.SIGINT)
    export = subprocess.run([view, "--open", str(recording), "--export", str(folder / "frames.csv"), "--json"],
                            capture_output=True, text=True, check=False, timeout=60)
    with subprocess.Popen([view, "--open", str(recording), "--port", "0", "--page", str(page), "--json"],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as viewer:
        try:
            ready = json.loads(viewer.stdout.readline())
            live.append(next(one for one in messages(ready["port"], ready["token"]) if "replay" in one))
        finally:
            viewer.send_signal(signal.SIGINT)
    return [("tact-view", ready), ("tact-view-export", json.loads(export.stdout)), *(("tact-live", one) for one in live)]


def faults_of(name, document, schema):
    if document.get("schema", document.get("format", document.get("kind"))) is None:
        yield f"{name}: names neither its format nor its version"
    for error in jsonschema.Draft7Validator(schema).iter_errors(document):
        yield f"{name}: {'/'.join(map(str, error.absolute_path)) or 'top'}: {error.message[:200]}"


def blind(name, document, schema):
    """A document with another format, or a member more, must be refused."""
    key = next(key for key in ("schema", "format", "kind") if key in document)
    named = ({key: "x"}, {"version": 999}) if key == "format" else ({key: "x"},)
    for change in (*named, {"a_member_that_no_schema_has": 1}):
        if not list(faults_of(name, {**copy.deepcopy(document), **change}, schema)):
            yield f"{name}: its schema takes {change}"


def documents(build, folder):
    """(format, document or the words of a failure) of every run and every file."""
    prepare(build, folder)
    for name, commands in COMMANDS.items():
        for command in commands:
            try:
                yield name, output_of(build, command, folder)
            except (OSError, ValueError, subprocess.TimeoutExpired) as error:
                yield name, str(error)
    for name, files in FILES.items():
        for file in files:
            yield name, json.loads((REFERENCES / file).read_text())
    try:
        yield from viewer_documents(build, folder)
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        yield "tact-view", str(error)


def main():
    build, found, seen = pathlib.Path(sys.argv[1]).resolve(), [], []
    known = {command.split()[0] for commands in COMMANDS.values() for command in commands} | set(COMMANDS) | set(FILES)
    for name in sorted(set(programs_with_json()) - known):
        found.append(f"{name}: has --json, and is not run here")
    files = {path.name.removesuffix(".schema.json") for path in SCHEMAS.glob("*.schema.json")}
    with tempfile.TemporaryDirectory() as folder:
        for name, document in documents(build, pathlib.Path(folder)):
            seen.append(name)
            if isinstance(document, str):
                found.append(f"{name}: {document}")
            elif name in files:
                schema = json.loads((SCHEMAS / f"{name}.schema.json").read_text())
                found += faults_of(name, document, schema)
                found += blind(name, document, schema)
    seen.append("tact-jitter-late")  # needs root: tests/tools/jitter/late_report_test.py
    found += [f"{name}: a schema without a document, or a document without a schema" for name in sorted(files ^ set(seen))]
    print(*(f"{fault}\n" for fault in found), sep="", end="")
    print(f"schema: {len(files)} schemas, {len(seen)} documents, {len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
