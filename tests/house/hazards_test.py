#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tests/safety/hazards.toml is whole and true: no hazard without a requirement, no requirement without a test,
and no name that is not in the sources.

From the table to the sources: each test of a room is a TEST of its folder, each property a CHECK of tests/proof, each case
one of tests/rig/cases or of tools/limits; a stage and a fault are those of gate.h and fault.h.
From the sources to the table: it has every stage of the gate, every fault but 0, every property of tests/proof but its
witnesses and contracts, every bench case with a fault, every case of tact-limits, and every test that must see a mutation
of the groups gate and loop, or of the rooms guardian and watch.
Across: a bench case that latches a fault is below a requirement that names it; a property, below its stage.

Reads the tree as text, but the bench's cases, which it imports. Prints every breach as a sentence. Exit status 0 or 1.
"""
import fnmatch
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TABLE = "tests/safety/hazards.toml"
KEYS = {"hazard": ({"id", "hazard", "cause"}, {"remains"}),
        "requirement": ({"id", "hazards", "text", "by"}, {"stages", "faults"}),
        "test": ({"id", "proves", "by", "names"}, set())}
IDS = {"hazard": r"HZ-\d\d", "requirement": r"REQ-\d\d", "test": r"TEST-\d\d\d?"}
PROOF, BENCH, LIMITS = "tests/proof/run", "tests/rig/run", "build/tact-limits"
SAFETY_GROUPS = ("gate", "loop")  # of tests/mutations, and each group that names a program of
SAFETY_PROGRAMS = ("firmware_guardian_test", "firmware_watch_test")
DECLARED = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.M)


def is_proof(words):
    return not words.startswith(("witness: ", "contract: "))


class Sources:
    """What the tree has, by name."""

    def __init__(self, root):
        gate, faults = (root / "firmware/gate/gate.h").read_text(), (root / "model/fault.cc").read_text()
        names = re.search(r"kStageName\{([^}]*)\}", gate)
        self.stages = re.findall(r'"(\w+)"', names[1]) if names else []
        numbers = re.findall(r"^  (k\w+) = (\d+),", (root / "model/fault.h").read_text(), re.M)
        self.faults = {int(number) for _, number in numbers} - {0}
        called = dict(re.findall(r'Fault::(k\w+),\s*"([^"]+)"', faults))
        self.number_of = {called[name]: int(number) for name, number in numbers if name in called}
        self.tests = {}  # program: its tests
        for path in sorted((root / "tests").rglob("*_test.cc")):
            program = "_".join(path.parent.relative_to(root / "tests").parts) + "_test"
            self.tests.setdefault(program, set()).update(".".join(found) for found in DECLARED.findall(path.read_text()))
        proof = [path.read_text() for path in (root / "tests/proof").glob("*.[ch]")]
        lemmas = re.search(r"LEMMAS = \{(.*?)\}", (root / "tests/proof/run").read_text(), re.S)
        words = [word for text in proof for word in re.findall(r'"([a-z]+: [^"]+)"\)', text)]
        words += re.findall(r': "([a-z]+: [^"]+)"', lemmas[1]) if lemmas else []
        self.properties = {word for word in words if is_proof(word)}
        plan = (root / "tools/limits/cases/plan.cc").read_text()
        wall = re.search(r'kWallName = "([\w-]+)"', (root / "tools/limits/cases/plan.h").read_text())
        self.cases = set(re.findall(r'(?:Case\{\.name = |goes_wrong\(\s*)"([\w-]+)"', plan)) | ({wall[1]} if wall else set())
        self.bench = bench_cases(root)  # name: None, "" or the fault that it latches
        self.wanted = {line for path in (root / "tests/mutations").rglob("*.patch") for line in seen_by(path.read_text())}


def bench_cases(root):
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(root / "tests/rig"))
    from bench import case  # pylint: disable=import-outside-toplevel
    return {one.name: getattr(one.fault, "name", "") if one.fault else None for one in case.all_cases()}


def seen_by(patch):
    """(program, pattern of a test) of a patch that breaks a promise of safety."""
    head = dict(line.split(": ", 1) for line in patch.partition("diff --git ")[0].splitlines() if ": " in line)
    program, *patterns = head.get("seen by", "").split()
    if program.endswith("_test") and (head.get("group") in SAFETY_GROUPS or program in SAFETY_PROGRAMS):
        for pattern in ":".join(patterns).split(":"):
            yield program, pattern


def shape_breaches(table):
    if (table.get("format"), table.get("version")) != ("tact-hazards", 1):
        yield "its format is not tact-hazards 1"
    for kind, (needed, more) in KEYS.items():
        seen = set()
        for row in table.get(kind, []):
            name = row.get("id", "?")
            if not re.fullmatch(IDS[kind], name) or name in seen:
                yield f"{kind} {name}: its id is not {IDS[kind]}, or occurs twice"
            seen.add(name)
            if not needed <= set(row) <= needed | more or not all(row.values()):
                yield f"{name}: needs {', '.join(sorted(needed))}, none of them empty, and no other key"


def chain_breaches(table):
    """From hazard to test and back by the ids alone."""
    ids = {kind: {row.get("id") for row in table.get(kind, [])} for kind in KEYS}
    met = {one for row in table.get("requirement", []) for one in row.get("hazards", [])}
    shown = {one for row in table.get("test", []) for one in row.get("proves", [])}
    for there, used, missing in ((ids["hazard"], met, "no requirement meets it"),
                                 (ids["requirement"], shown, "no test shows it")):
        yield from (f"{name}: {missing}" for name in sorted(there - used))
        yield from (f"{name}: is named, and is not in the table" for name in sorted(used - there))


def name_breaches(table, sources):
    """From the table to the sources."""
    known = {PROOF: sources.properties, BENCH: set(sources.bench), LIMITS: sources.cases}
    for row in table.get("requirement", []):
        for stage in set(row.get("stages", [])) - set(sources.stages):
            yield f"{row['id']}: {stage} is no stage of the gate"
        for fault in set(row.get("faults", [])) - sources.faults:
            yield f"{row['id']}: {fault} is no fault"
    for row in table.get("test", []):
        there = known.get(row["by"], sources.tests.get(row["by"].removeprefix("build/tests/")))
        if there is None:
            yield f"{row['id']}: {row['by']} is no command that this test knows"
            continue
        yield from (f"{row['id']}: {row['by']} has no {name}" for name in row["names"] if name not in there)


def named_by(table, command):
    return {name for row in table.get("test", []) if row["by"] == command for name in row["names"]}


def orphan_breaches(table, sources):
    """From the sources to the table."""
    rows = table.get("requirement", [])
    there = {"the stage": (set(sources.stages), {one for row in rows for one in row.get("stages", [])}),
             "the fault": (sources.faults, {one for row in rows for one in row.get("faults", [])}),
             "the property": (sources.properties, named_by(table, PROOF)),
             "the bench case": ({name for name, fault in sources.bench.items() if fault is not None},
                                named_by(table, BENCH)),
             "the case of tact-limits": (sources.cases, named_by(table, LIMITS))}
    for what, (all_of_them, named) in there.items():
        yield from (f"{what} {one} is in no row" for one in sorted(all_of_them - named))
    for program, pattern in sorted(sources.wanted):
        if not fnmatch.filter(named_by(table, f"build/tests/{program}"), pattern):
            yield f"the test {pattern} of {program} sees a mutation, and is in no row"


def cross_breaches(table, sources):
    """Does a name stand below what it is about?"""
    about = {row["id"]: row for row in table.get("requirement", [])}
    for row in table.get("test", []):
        proved = [about[name] for name in row["proves"] if name in about]
        faults = {one for requirement in proved for one in requirement.get("faults", [])}
        stages = {one for requirement in proved for one in requirement.get("stages", [])}
        for name in row["names"]:
            fault = sources.number_of.get(sources.bench.get(name)) if row["by"] == BENCH else None
            if fault and fault not in faults:
                yield f"{row['id']}: {name} latches fault {fault}, of which its requirements do not speak"
            if row["by"] == PROOF and name.split(": ")[0] not in stages:
                yield f"{row['id']}: \"{name}\" is of a stage of which its requirements do not speak"


def breaches(table, sources):
    found = list(shape_breaches(table))
    if not found:
        for rule in (chain_breaches, name_breaches, orphan_breaches, cross_breaches):
            found += rule(table) if rule is chain_breaches else rule(table, sources)
    return found


class Small:
    """Sources with one of each."""
    stages, faults, number_of = ["slew"], {7}, {"slew limited": 7}
    tests = {"a_test": {"A.IsSo"}}
    properties, cases, bench = {"slew: it is so"}, {"step"}, {"jump": "slew limited"}
    wanted = {("a_test", "A.Is*")}


def small_table(**changes):
    table = {"format": "tact-hazards", "version": 1,
             "hazard": [{"id": "HZ-01", "hazard": "h", "cause": "c"}],
             "requirement": [{"id": "REQ-01", "hazards": ["HZ-01"], "text": "t", "by": "gate",
                              "stages": ["slew"], "faults": [7]}],
             "test": [{"id": f"TEST-0{i}", "proves": ["REQ-01"], "by": by, "names": [name]} for i, (by, name) in enumerate(
                 (("build/tests/a_test", "A.IsSo"), (PROOF, "slew: it is so"), (BENCH, "jump"), (LIMITS, "step")))]}
    for place, value in changes.items():
        kind, index, key = place.split("_")
        table[kind][int(index)] = {**table[kind][int(index)], key: value}
    return table


def blind_rules():
    """Each rule on a breach of it: the ones not seen; and what is taken for a breach in a table in order."""
    for words, changes in {
            "needs by": {"requirement_0_by": ""}, "occurs twice": {"test_1_id": "TEST-00"},
            "no requirement meets it": {"requirement_0_hazards": ["HZ-02"]}, "no test shows it": {
                f"test_{i}_proves": ["REQ-02"] for i in range(4)},
            "is no stage": {"requirement_0_stages": ["jump"]}, "is no fault": {"requirement_0_faults": [8]},
            "has no A.IsNot": {"test_0_names": ["A.IsNot"]}, "is no command": {"test_0_by": "make"},
            "the stage slew": {"requirement_0_stages": ["x"]}, "the fault 7": {"requirement_0_faults": [8]},
            "the property slew: it is so": {"test_1_names": ["x"]}, "the bench case jump": {"test_2_names": ["x"]},
            "the case of tact-limits step": {"test_3_names": ["x"]}, "sees a mutation": {"test_0_names": ["B.Is"]},
            "latches fault 7": {"requirement_0_faults": [8]},
            "of a stage of which": {"requirement_0_stages": ["x"]}}.items():
        if not any(words in breach for breach in breaches(small_table(**changes), Small)):
            yield f"a breach of this rule is not seen: {words}"
    yield from (f"takes for a breach: {breach}" for breach in breaches(small_table(), Small))


def main():
    table, sources = tomllib.loads((ROOT / TABLE).read_text()), Sources(ROOT)
    found = [f"{TABLE}: {breach}" for breach in breaches(table, sources)]
    found += [f"tests/house/hazards_test.py: {breach}" for breach in blind_rules()]
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    counts = ", ".join(f"{len(table[kind])} {kind}s" for kind in KEYS)
    print(f"hazards: {counts}, {len(sources.faults)} faults, {len(sources.wanted)} tests that see a mutation, "
          f"{len(found)} breaches")
    if min(len(sources.stages), len(sources.faults), len(sources.properties), len(sources.bench), len(sources.wanted)) < 9:
        print("hazards: too few of a kind: the check does not see the tree")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
