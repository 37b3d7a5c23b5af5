"""How long every phase of a tick is, in instructions, held against tests/data/bench_baseline.json.

One instruction is one nanosecond here, so the numbers are exact. An interrupt that falls into a
phase lengthens it: the shortest of the timed runs counts, which differ in
their seed and so in their phase against the kernel's clocks. The longest wake-up is the kernel's path
more than ours and moves by 10 % with that phase: it may grow by a quarter (and is held against
cyclictest besides); its median like all others.
"""
import json

ALLOWED_GROWTH = 1.05
LONGEST_WAKE_GROWTH = 1.25
PHASES = ("wake", "read", "touch", "feel", "judge", "write", "tell", "total")
MEASURES = {"median_ns": "p50_ns", "longest_ns": "max_ns"}


def measure(runs):
    """{back end: {phase: {median_ns, longest_ns}}} of the timed runs that have a report."""
    measured = {}
    for run in runs:
        if run.case.timed and run.report:
            phases = measured.setdefault(run.case.back_end.name, {})
            for phase in PHASES:
                numbers = phases.setdefault(phase, {})
                for measure_name, key in MEASURES.items():
                    value = run.report["phases"][phase][key]
                    numbers[measure_name] = min(value, numbers.get(measure_name, value))
    return measured


def compare(measured, path):
    """Complaints, one sentence for each number that grew by more than 5 %."""
    known = json.loads(path.read_text()) if path.exists() else {}
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


def write(measured, path):
    """Replaces the back ends that were measured, keeps the others."""
    known = json.loads(path.read_text()) if path.exists() else {}
    known.update(measured)
    path.write_text(json.dumps(dict(sorted(known.items())), indent=2) + "\n")
