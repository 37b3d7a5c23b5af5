"""How long every phase of a tick is, in instructions, held against tests/data/bench_baseline.json.

One instruction is one nanosecond here, so a path is exact, and two things besides ours move it: an
interrupt that falls into a phase, and the phase of this run against the kernel's clocks, which differs
from seed to seed and from snapshot to snapshot. What is ours is there with every seed. So a number has
grown when the shortest of the timed runs has, and `run` adds seeds before it says so; the baseline
is the middle of six seeds. The longest wake-up is the kernel's path more than ours: it may grow by a
quarter (and is held against cyclictest besides); its median like all others. With another kernel
than the baseline's, so may all phases that call it.
"""
import json
import statistics

ALLOWED_GROWTH = 1.05
KERNEL_GROWTH = 1.25
CALLING = ("wake", "read", "write", "total")
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
    """{back end: phases} and the kernel that they were measured with."""
    known = json.loads(path.read_text()) if path.exists() else {}
    return known.get("back_ends", {}), known.get("kernel")


def growth(phase, name, same_kernel):
    of_kernel = (phase, name) == ("wake", "longest_ns") or (phase in CALLING and not same_kernel)
    return KERNEL_GROWTH if of_kernel else ALLOWED_GROWTH


def compare(measured, path, kernel):
    """Complaints, one sentence for each number that grew by more than it may."""
    known, known_kernel = read(path)
    wrong = []
    for back_end, phases in measured.items():
        if back_end not in known:
            wrong.append(f"{back_end} has no baseline; tests/rig/run --write-baseline writes it")
            continue
        for phase, numbers in phases.items():
            for name, value in numbers.items():
                old = known[back_end].get(phase, {}).get(name, 0)
                if value > old * growth(phase, name, kernel == known_kernel):
                    wrong.append(
                        f"{back_end}: {phase} {name.removesuffix('_ns')} took {old} instructions, now "
                        f"{value}: make it shorter, or change the baseline with a reason in the "
                        "commit (tests/rig/run --write-baseline)")
    return wrong


def write(runs, path, kernel):
    """Replaces the back ends that were measured, keeps the others; returns all."""
    known, _ = read(path)
    known.update(measure(runs, statistics.median_high))
    told = {"kernel": kernel, "back_ends": dict(sorted(known.items()))}
    path.write_text(json.dumps(told, indent=2) + "\n")
    return known
