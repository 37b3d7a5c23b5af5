# SPDX-License-Identifier: Apache-2.0
"""How long every phase of a tick is, in instructions, held against tests/data/bench_baseline.json.

One instruction is one nanosecond here, so a path is exact, but for an interrupt that falls into it. No
timer of the kernel and none of tactd does: the loop's grid of deadlines keeps away from both
(firmware/loop/release_schedule.h), and the kernel's lockup detector is off here as it is on an isolated core. What is
left are emulators and other programs, whose phase differs from seed to seed, and from host to host, as the
moment of the snapshot does. Heartbeats that wait in the first tick are such a phase (guest/bench.sh shifts
them by the seed). What is ours is there with every seed. So a number has grown when the shortest
of the timed runs is above what any of the baseline's six seeds had (its median: above their middle), and
`run` adds seeds before it says so. What a wake-up takes at most is the kernel's path
more than ours: it may grow by a quarter (and is held against cyclictest besides); its median like all
others. With another kernel of the baseline's series (6.1), so may all phases that call it. With one of
another series, of a release with its own compiler and libraries, numbers are reported and not evaluated.

The longest of a bus is its first tick, which empties the queue of the set-up and is some ten times as
long as any other, so between it and the median is a third number: what 99.9 % of the ticks of a
phase do not exceed.

The longest of a phase that calls nothing is the one tick that meets the hand where the law has most to
do. Which tick does is a matter of the device's delay, so it is held against the longest that any device
has met with the same scene; the total may be longer by the difference.
"""
import json
import statistics

ALLOWED_GROWTH = 1.05
KERNEL_GROWTH = 1.25
MOST = "p99.9_ns"
PHASES = ("wake", "read", "detect", "render", "limit", "write", "publish", "total")
CALLING = ("wake", "read", "write", "total")
OWN = tuple(phase for phase in PHASES if phase not in CALLING)
LONGEST = "longest_ns"
MEASURES = {"median_ns": "p50_ns", MOST: MOST, LONGEST: "max_ns"}


def shortest(_, of_seeds):
    return min(of_seeds)


def recorded(name, of_seeds):
    """For the baseline: the middle of the medians, and the longest of what another host's phase may show."""
    return statistics.median_high(of_seeds) if name == "median_ns" else max(of_seeds)


def measure(runs, over_seeds=shortest):
    """{back end: {phase: {median_ns, p99.9_ns, longest_ns}}} of the timed runs that have a report.

    over_seeds: a function of the number's name and of its value with each seed.
    """
    reports = {}
    for run in runs:
        if run.case.timed and run.report:
            reports.setdefault(run.case.back_end.name, []).append(run.report["phases"])
    return {back_end: {phase: {name: over_seeds(name, [seed[phase][key] for seed in seeds])
                               for name, key in MEASURES.items()} for phase in PHASES}
            for back_end, seeds in reports.items()}


def read(path):
    """{back end: phases} and the kernel that they were measured with."""
    known = read_all(path)
    return known.get("back_ends", {}), known.get("kernel")


def read_all(path):
    return json.loads(path.read_text()) if path.exists() else {}


def read_gate(path):
    """{stage: {way: instructions}}, see gate_paths.py."""
    return read_all(path).get("gate", {})


def series_of(kernel):
    """6.1 of 6.1.0-56-rt-amd64."""
    return (kernel or "").split(".")[:2]


def most_allowed(phase, name, old, same_kernel):
    of_kernel = (phase == "wake" and name != "median_ns") or (phase in CALLING and not same_kernel)
    return old * (KERNEL_GROWTH if of_kernel else ALLOWED_GROWTH)


def with_longest_of_scene(known, scene_of):
    """`known`, with the longest own phases of each back end as long as any with its scene had them."""
    lengthened = {}
    for back_end, phases in known.items():
        alike = [of for name, of in known.items() if scene_of.get(name) == scene_of.get(back_end)]
        longest = {phase: max(of[phase][LONGEST] for of in alike) for phase in OWN}
        longest["total"] = phases["total"][LONGEST] + sum(longest[phase] - phases[phase][LONGEST] for phase in OWN)
        lengthened[back_end] = phases | {phase: phases[phase] | {LONGEST: longest[phase]} for phase in longest}
    return lengthened


def incomplete(path):
    """A sentence for each back end that a phase was added to since."""
    return [f"{back_end}: the baseline lacks a number; tests/rig/run --write-baseline writes it"
            for back_end, phases in read(path)[0].items()
            if any(MEASURES.keys() - phases.get(phase, {}).keys() for phase in PHASES)]


def compare(measured, path, kernel, scene_of):
    """Complaints, one sentence for each number that grew by more than it may. The baseline is complete.

    scene_of: {back end: what its hand meets}, of all back ends.
    """
    known, known_kernel = read(path)
    wrong = []
    if known and series_of(kernel) != series_of(known_kernel):
        return wrong
    known = with_longest_of_scene(known, scene_of)
    for back_end, phases in measured.items():
        if back_end not in known:
            wrong.append(f"{back_end} has no baseline; tests/rig/run --write-baseline writes it")
            continue
        for phase, numbers in phases.items():
            for name, value in numbers.items():
                old = known[back_end][phase][name]
                if value > most_allowed(phase, name, old, kernel == known_kernel):
                    wrong.append(
                        f"{back_end}: {phase} {name.removesuffix('_ns')} took {old} instructions, now "
                        f"{value}: make it shorter, or change the baseline with a reason in the "
                        "commit (tests/rig/run --write-baseline)")
    return wrong


def other_kernel(path, kernel):
    """A sentence for who runs another kernel than the baseline's; empty when it is the same."""
    known = read(path)[1]
    held = ("phases that call it may be 25 % longer" if series_of(kernel) == series_of(known)
            else "no number is held against it")
    return "" if kernel == known else (
        f"the kernel is {kernel}, the baseline's was {known}: {held}; "
        "tests/rig/run --write-baseline makes the 5 % count again")


def read_cycles(path):
    """{back end: {median_us, p99_us, own_us}}, see bus_cycle.py."""
    return read_all(path).get("bus_cycles", {})


def write(runs, gate, cycles, path, kernel):
    """Replaces the back ends, the gate's paths and the cycles of buses that were measured, keeps the others."""
    known, old_kernel = read(path)
    fresh = measure(runs, recorded)
    numbers = {"kernel": kernel if fresh else old_kernel, "gate": gate or read_gate(path),
               "bus_cycles": dict(sorted((read_cycles(path) | cycles).items())),
               "back_ends": dict(sorted((known | fresh).items()))}
    path.write_text(json.dumps(numbers, indent=2) + "\n")
