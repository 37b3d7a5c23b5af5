# SPDX-License-Identifier: Apache-2.0
"""How long a cycle of the bus takes: from its sign (estimates due, SYNC, report sent) to the torque
that follows from it, and the part of the emulated device in it. Guest time, 1 kHz. The cycle that waits
for the loop's first tick is none."""
import statistics

PERIOD_us = 1000.0
OWN_CLOCK = {"odrive06": 150.0, "odrive05": 150.0}  # a tick, three frames each way, the emulator's own part


def rows(runs):
    """(back end, median, p99, longest, own median, own longest), us, of every timed run."""
    found = {}
    for run in runs:
        cycle, own = run.emulator.get("bus_cycle_ns"), run.emulator.get("own_share_ns")
        if run.case.timed and cycle and own:
            found[run.case.back_end.name] = [cycle["median"], cycle["p99"], cycle["max"],
                                             own["median"], own["max"]]
    return [(name, *(value / 1000 for value in values)) for name, values in found.items()]


def measure(runs):
    """{back end: {median_us, p99_us, own_us}} for the baseline; of several seeds the middle."""
    of_all = {}
    for run in runs:
        for name, median, p99, _, own, _ in rows([run]):
            of_all.setdefault(name, []).append((median, p99, own))
    return {name: dict(zip(("median_us", "p99_us", "own_us"),
                           (round(statistics.median_high(values)) for values in zip(*seen))))
            for name, seen in of_all.items()}


def compare(measured, known):
    """Complaints. Drives with a clock of their own are in any phase of the loop: a period, and what the
    shortest cycle takes. Those that follow the loop take what they took."""
    wrong = []
    for name, now in measured.items():
        if name not in known:
            wrong.append(f"{name} has no bus cycle in the baseline; tests/rig/run --write-baseline writes it")
            continue
        for key in ("median_us", "p99_us"):
            most = PERIOD_us + OWN_CLOCK[name] if name in OWN_CLOCK else 1.05 * known[name][key]
            if now[key] > most:
                wrong.append(f"{name}: the bus cycle's {key.removesuffix('_us')} is {now[key]} us, "
                             f"{known[name][key]} in the baseline, {most:.0f} allowed")
    return wrong


def table(runs):
    lines = ["| back end | cycle, median | 99 % | longest | of it the emulator's, median | longest |",
             "|---|---|---|---|---|---|"]
    for name, *values in rows(runs):
        lines.append(f"| {name} | " + " | ".join(f"{value:.0f} us" for value in values) + " |")
    return "\n".join(lines) + "\n" if len(lines) > 2 else ""
