"""How long every phase of a tick is, in instructions, held against tests/data/bench_baseline.json.

One instruction is one nanosecond here, so a path is exact, and two things besides ours move it: an
interrupt that falls into a phase, and the phase of this run against the kernel's clocks, which differs
from seed to seed and from snapshot to snapshot. What is ours is there with every seed. So a number has
grown when the shortest of the timed runs has, and `run` adds seeds before it says so; the baseline
is the middle of six seeds. The longest wake-up is the kernel's path more than ours: it may grow by a
quarter (and is held against cyclictest besides); its median like all others.
"""
import json
import statistics

ALLOWED_GROWTH = 1.05
LONGEST_WAKE_GROWTH = 1.25
PHASES = ("wake", "read", "touch", "feel", "judge", "write", "tell", "total")
MEASURES = {"median_ns": "p50_ns", "longest_ns": "max_ns"}


def measure(runs, of_seeds=min):
    """{back end: {phase: {median_ns, longest_ns}}} of the timed runs that have a report."""
    reports = {}
    for run in runs:
        if run.case.timed and run.report:
            reports.setdefault(run.case.back_end.name, []).append(run.report["phases"])
    return {back_end: {phase: {name: of_seeds(seed[phase][key] for seed in seeds)
                               for name, key in MEASURES.items()} for phase in PHASES}
            for back_end, seeds in reports.items()}


def read(path):
    return json.loads(path.read_text()) if path.exists() else {}


def compare(measured, path):
    """Complaints, one sentence for each number that grew by more than 5 %."""
    known = read(path)
    wrong = []
    for back_end, phases in measured.items():
        if back_end not in known:
            wrong.append(f"{back_end} has no baseline; tests/rig/run --write-baseline writes it")
            continue
        for phase, numbers in phases.items():
            for name, value in numbers.items():
                old = known[back_end].get(phase, {}).get(name, 0)
                of_kernel = (phase, name) == ("wake", "longest_ns")
                if value > old * (LONGEST_WAKE_GROWTH if of_kernel else ALLOWED_GROWTH):
                    wrong.append(
                        f"{back_end}: {phase} {name.removesuffix('_ns')} took {old} instructions, now "
                        f"{value}: make it shorter, or change the baseline with a reason in the "
                        "commit (tests/rig/run --write-baseline)")
    return wrong


def write(runs, path):
    """Replaces the back ends that were measured, keeps the others; returns all."""
    known = read(path)
    known.update(measure(runs, statistics.median_high))
    path.write_text(json.dumps(dict(sorted(known.items())), indent=2) + "\n")
    return known
