#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No phase of a tick is more than 10 % above its budget, which is its cost in the last version of the changelog; a
p99.9 not more than 25 %, as a few ticks decide it, and of the wake-up the kernel.

usage: tests/house/budgets_test.py [--release VERSION]     with a version: the costs of now become the budgets

tests/data/bench_budgets.json has instructions by device or law, and phase (of the virtual bench), and microseconds (least
of many passes, of tools/bench). It is bound to the CHANGELOG by its digest; a later growth needs a line there:
    - Budget: heart render p99.9 3007 -> 17919: the heart has a compliance map now.
Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import hashlib
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = ROOT / "tests/data"
CHANGELOG = "tools/deploy/CHANGELOG.md"
BUDGETS = "tests/data/bench_budgets.json"
ALLOWED_GROWTH, P999_GROWTH = 1.10, 1.25
RAISE = re.compile(r"^- Budget: (.+) ([\d.]+) -> ([\d.]+): \S", re.M)
DIGEST = re.compile(r"^- Budgets of \S+: `([0-9a-f]{16})`", re.M)


def costs():
    """{name: cost}: median and p99.9 of each phase in instructions, and the hot contact in microseconds."""
    back_ends = json.loads((DATA / "bench_baseline.json").read_text())["back_ends"]
    found = {f"{back_end} {phase} {measure.removesuffix('_ns')}": float(numbers[measure])
             for back_end, phases in back_ends.items() for phase, numbers in phases.items()
             for measure in ("median_ns", "p99.9_ns")}
    hot_us = json.loads((ROOT / "tools/results/bench.json").read_text())["values"].get("hot_us", {})
    return found | {f"hot contact, {what}": value_us for what, value_us in hot_us.items()}


def digest(budgets):
    return hashlib.sha256(json.dumps(budgets, sort_keys=True).encode()).hexdigest()[:16]


def most_allowed(name, budget):
    return budget * (P999_GROWTH if name.endswith(" p99.9") else ALLOWED_GROWTH)


def breaches(now, budgets, changelog):
    if DIGEST.findall(changelog)[:1] != [digest(budgets)]:
        yield (f"{BUDGETS}:1: it is not the file that the last release's line in {CHANGELOG} names; "
               f"a release writes both: tests/house/budgets_test.py --release VERSION")
    raised = {name: (float(old), float(new)) for name, old, new in RAISE.findall(changelog)}
    for name, cost in now.items():
        budget = budgets["costs"].get(name)
        if budget is None:
            continue  # of a device, law or row that the release did not have
        allowed = most_allowed(name, raised.get(name, (budget, budget))[1])
        if cost > allowed:
            yield (f"{BUDGETS}:1: {name} costs {cost:g}, its budget is {budget:g}: make it shorter, or write in {CHANGELOG} "
                   f"'- Budget: {name} {budget:g} -> {cost:g}: REASON'")
    for name, (old, new) in raised.items():
        if now.get(name) is None or budgets["costs"].get(name) != old:
            yield f"{CHANGELOG}:1: '- Budget: {name} {old:g} -> {new:g}' raises no budget of {BUDGETS}; take the line out"
        elif now[name] <= most_allowed(name, old):
            yield f"{CHANGELOG}:1: '- Budget: {name} {old:g} -> {new:g}' is not needed, it costs {now[name]:g}; take the line out"


def self_test():
    """Each rule refuses what it is there for."""
    budgets = {"release": "1", "costs": {"liver render median": 1000.0}}
    line = f"- Budgets of 1: `{digest(budgets)}`\n"
    reason = "- Budget: liver render median 1000 -> 1300: a new law\n"
    for cost, changelog, count in ((1090, line, 0), (1110, line, 1), (1300, line + reason, 0), (1440, line + reason, 1),
                                   (1000, line + reason, 1), (1000, line.replace("`", "`0", 1), 1), (1000, "", 1)):
        found = len(list(breaches({"liver render median": cost}, budgets, changelog)))
        if found != count:
            yield f"tests/house/budgets_test.py:1: a cost of {cost} with {changelog!r} has {found} breaches"
    steep = {"release": "1", "costs": {"liver render p99.9": 1000.0}}
    for cost, count in ((1240, 0), (1260, 1)):
        if len(list(breaches({"liver render p99.9": cost}, steep, f"- Budgets of 1: `{digest(steep)}`\n"))) != count:
            yield f"tests/house/budgets_test.py:1: a p99.9 of {cost} is {'refused' if count == 0 else 'good'}"
    other = {"release": "1", "costs": {"liver render median": 2000.0}}
    if not list(breaches({"liver render median": 1900}, other, line)):
        yield "tests/house/budgets_test.py:1: a budget can be raised without a line in the CHANGELOG"


def release(version):
    budgets = {"release": version, "costs": costs()}
    (ROOT / BUDGETS).write_text(json.dumps(budgets, indent=1) + "\n")
    print(f"Write into {CHANGELOG}, above older lines of this kind, and take the lines '- Budget:' out:")
    print(f"- Budgets of {version}: `{digest(budgets)}`")


def main():
    if sys.argv[1:2] == ["--release"]:
        return release(sys.argv[2])
    budgets = json.loads((ROOT / BUDGETS).read_text())
    now = costs()
    found = [*self_test(), *breaches(now, budgets, (ROOT / CHANGELOG).read_text())]
    print(*found, sep="\n", end="\n" if found else "")
    print(f"budgets: {len(now)} costs against those of {budgets['release']}, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
