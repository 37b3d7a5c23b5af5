#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the virtual bench evaluates by, without a guest: the longest tick of a law is held against all devices of its scene,
everything else against the device's own baseline; --once leaves out no kind of case, and other drives on CAN alone. A row of
tools/bench that misses its goal is in the table of the front page.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile

RIG = pathlib.Path(__file__).resolve().parent.parent / "rig"
sys.dont_write_bytecode = True
RESULTS = RIG.parents[1] / "tools/results"
sys.path[:0] = [str(RIG), str(RESULTS)]
from bench import baseline  # noqa: E402
from bench.case import all_cases  # noqa: E402
import measured  # noqa: E402
import tables  # noqa: E402

KERNEL = "6.1.0-rt"
SCENE_OF = {"one": "liver", "other": "liver", "alone": "gum"}
# What grew, of which back end, to how many thousandths of its baseline of 1000; `other` has 1200 as its longest of render.
GROWN = {
    ("one", "render", "longest_ns", 1040): False,
    ("one", "render", "longest_ns", 1250): False,   # as long as the other device's was
    ("one", "render", "longest_ns", 1270): True,
    ("one", "render", "p99.9_ns", 1060): True,
    ("one", "read", "longest_ns", 1060): True,    # a call: of the device, not of the scene
    ("alone", "render", "longest_ns", 1060): True,
    ("one", "total", "longest_ns", 1250): False,  # by the difference of render
    ("one", "total", "longest_ns", 1270): True,
}


def known():
    back_ends = {name: {phase: dict.fromkeys(baseline.MEASURES, 1000) for phase in baseline.PHASES} for name in SCENE_OF}
    back_ends["other"]["render"]["longest_ns"] = 1200
    return back_ends


def bounds(folder):
    path = folder / "baseline.json"
    path.write_text(json.dumps({"kernel": KERNEL, "back_ends": known()}))
    for (name, phase, measure, value), wanted in GROWN.items():
        now = known()
        now[name][phase][measure] = value
        if bool(baseline.compare(now, path, KERNEL, SCENE_OF)) != wanted:
            yield f"tests/rig/bench/baseline.py:1: {name}: {phase} {measure} of {value} is {'good' if wanted else 'refused'}"
    short = known()
    del short["alone"]["publish"]
    path.write_text(json.dumps({"kernel": KERNEL, "back_ends": short}))
    if len(baseline.incomplete(path)) != 1:
        yield "tests/rig/bench/baseline.py:1: a baseline without a phase is taken for whole"


def seeds():
    """Of six seeds the baseline keeps the middle of the medians and the longest of the others."""
    values = (10, 30, 20, 60, 50, 40)
    for name, wanted in (("median_ns", 40), (baseline.MOST, 60), (baseline.LONGEST, 60)):
        if baseline.recorded(name, values) != wanted:
            yield f"tests/rig/bench/baseline.py:1: of {values} the baseline keeps {baseline.recorded(name, values)} as {name}"


def listed():
    said = subprocess.run([sys.executable, RIG / "run", "--list", "--long"], capture_output=True, text=True)
    missing = [case.name for case in all_cases() if f"{case.name:24} {case.message}\n" not in said.stdout]
    if missing:
        yield f"tests/rig/run:1: --list lacks {missing[0]}{said.stderr[-300:]}"


def once():
    loader = importlib.machinery.SourceFileLoader("rig_run", str(RIG / "run"))
    run = importlib.util.module_from_spec(importlib.util.spec_from_loader("rig_run", loader))
    loader.exec_module(run)
    cases = [case for case in all_cases() if not case.long_only]
    kept = run.each_once(cases)

    def kinds(of):
        return {(case.back_end.bus, case.name.removeprefix(f"{case.back_end.name}-")) for case in of}
    if kinds(kept) != kinds(cases):
        yield f"tests/rig/run:1: --once leaves out {sorted(kinds(cases) - kinds(kept))}"
    for case in cases:
        if case not in kept and case.back_end.bus != "can":
            yield f"tests/rig/run:1: --once leaves out {case.name}, no case of other drives on CAN"


def front_page():
    rows = [{"what": what, "value": 4.8, "unit": "us", "goal": "<= 2", "command": "tools/bench", "missed": missed}
            for what, missed in (("contact of two spheres, median", False), ("  p99.9", True))]
    if [row["what"] for row in measured.missed_of(rows)] != ["contact of two spheres: p99.9"]:
        yield "tools/results/measured.py:1: a row that belongs to another one does not say so"
    row = {"what": "law table", "value": 1140.4, "unit": "kB", "goal": "<= 64", "command": "tactd liver.toml"}

    def lines_of(missed):
        values = json.loads((RESULTS / "bench.json").read_text())["values"] | {"missed": missed}
        return list(tables.measured(lambda name: values if name == "bench" else
                                    json.loads((RESULTS / f"{name}.json").read_text())["values"]))
    if [line for line in lines_of([row]) if line and line not in lines_of([])] != [
            "Goals of `tools/bench` that were **missed**: law table 1140.4 kB (<= 64)."]:
        yield "tools/results/tables.py:1: a row of tools/bench that misses its goal is not in the table"


def main():
    with tempfile.TemporaryDirectory() as folder:
        found = [*bounds(pathlib.Path(folder)), *seeds(), *listed(), *once(), *front_page()]
    print(*found, sep="\n", end="\n" if found else "")
    print(f"bench: {len(GROWN)} kinds of growth, {len(all_cases())} cases, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
