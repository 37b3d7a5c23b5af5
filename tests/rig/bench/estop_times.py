# SPDX-License-Identifier: Apache-2.0
"""From the edge of an e-stop contact to the zero that is written: per device, over the phases of a tick.

The edge is timed before the contact is pulled, zero after it was written: what is measured is never
shorter than what was. The longest way is that of an edge just behind the look of a tick, so one falls there.
"""
import dataclasses
import statistics

from bench import path_table
from bench.cost_table import CAUSES

BEGIN = "<!-- e-stop, made by tests/rig/run --write-baseline; with --long also the back ends of --long -->\n"
PERIOD_us = 1000.0
BOUND_us = PERIOD_us + 100.0
# After a deadline, us: before the look of its tick, just behind it, and through the rest of the period.
PHASES_us = (0, 10, 260, 510, 760)
WIDEST_GAP_us = 260.0
SCRIPT = (f"phases=({' '.join(map(str, PHASES_us))})\n"
          "tact-rig-lines press ${line[0]}/pull --grid-ns $(tact-rig-ticks /tmp/ticks --grid) "
          "--phase-us ${phases[SEED - 1]} >$RESULTS/edge.json\n"
          "[[ $(<$RESULTS/edge.json) =~ \\\"before_ns\\\":([0-9]+) ]] && injected=${BASH_REMATCH[1]}\n")


def written_us(run):
    """From the edge to the return of the write of zero, the loop's own clock; None: never."""
    return since_edge_us(run, run.report.get("stop", {}).get("zero_ns", 0))


def motors_us(run):
    """From the edge to motors without torque, by the drives' own word; None: never, or no drives."""
    return since_edge_us(run, run.emulator.get("torque_zero_since_ns") or 0)


def since_edge_us(run, time_ns):
    edge_ns = run.ticks.get("injected_ns", 0)
    return (time_ns - edge_ns) / 1000.0 if 0 < edge_ns < time_ns else None


def phase_us(run):
    """Of the edge: since the deadline of the tick before it."""
    after = run.ticks.get("first_tick_after") or {}
    return (run.ticks.get("injected_ns", 0) - after.get("due_ns", 0)) / 1000.0 % PERIOD_us


@dataclasses.dataclass(frozen=True)
class InTime:
    """Zero is written within a period and 100 us of the edge, and with the motors `bus_us` later; a force
    was there, and none came back."""
    bus_us: float = 0.0

    def __call__(self, run):
        ticks, wrong = run.ticks, []
        if ticks.get("force_before_N", 0.0) == 0.0:
            wrong.append("no force when the e-stop opened: it proves nothing")
        if (ticks.get("detected") or {}).get("fault") != "emergency stop":
            wrong.append(f"the e-stop was not seen: {ticks.get('detected')}")
        wrong += late("zero was written", written_us(run), BOUND_us)
        if run.emulator:
            wrong += late("the motors let go", motors_us(run), BOUND_us + self.bus_us)
        if ticks.get("moved_after_N") != 0.0 or ticks.get("end_state") != "stopped":
            wrong.append(f"ended {ticks.get('end_state')}, it moved again with {ticks.get('moved_after_N')} N")
        return wrong


def late(what, took_us, bound_us):
    if took_us is None:
        return [f"it never came that {what}"]
    return [] if took_us <= bound_us else [f"{what} {took_us:.0f} us after the edge, bound {bound_us:.0f} us"]


def measured(runs):
    """{back end: [(phase, written, motors or None)]} of the runs that opened the e-stop, us."""
    found = {}
    for run in runs:
        if any(isinstance(check, InTime) for check in run.case.checks) and written_us(run) is not None:
            found.setdefault(run.case.back_end.name, []).append((phase_us(run), written_us(run), motors_us(run)))
    return found


def compare(runs):
    """Complaints about parts of the period that no edge fell into, where all of them were asked for."""
    wrong = []
    for name, edges in measured(runs).items():
        phases = sorted(phase for phase, _, _ in edges)
        gap_us = max(after - before for before, after in zip(phases, phases[1:] + [phases[0] + PERIOD_us]))
        if len(edges) == len(PHASES_us) and gap_us > WIDEST_GAP_us:
            wrong.append(f"{name}: no edge of the e-stop in {gap_us:.0f} us of the period: "
                         f"{[round(phase) for phase in phases]}")
    return wrong


def table(runs):
    lines = ["| back end | edges | e-stop to zero written, median / longest | longest edge at | "
             "e-stop to motors without torque, median / longest |", "|---|---|---|---|---|"]
    for name, edges in measured(runs).items():
        written = [edge[1] for edge in edges]
        motors = [edge[2] for edge in edges if edge[2] is not None]
        lines.append(f"| {name} | {len(edges)} | {pair(written)} | {max(edges, key=lambda edge: edge[1])[0]:.0f} us | "
                     f"{pair(motors) if motors else '-'} |")
    return "\n".join(lines) + "\n" if len(lines) > 2 else ""


def readme_table(runs, old):
    """As hal/gpio/README.md has it: a row for each back end, that of `old` where none was measured."""
    rows = {line.split(" | ")[0].removeprefix("| "): line for line in old.splitlines()[2:]}
    for name, edges in measured(runs).items():
        label = CAUSES[name.split()[0]][0]
        motors = [edge[2] for edge in edges if edge[2] is not None]
        rows[label] = f"| {label} | {pair([edge[1] for edge in edges])} | {pair(motors) if motors else '-'} |"
    return "\n".join(["| back end, with safety lines | zero written, median / longest | "
                      "motors without torque, median / longest |", "|---|---|---|", *rows.values()]) + "\n"


def write(runs, path):
    _, old, _ = path_table.split(path.read_text(), BEGIN)
    path_table.write(readme_table(runs, old), path, BEGIN)


def pair(values_us):
    return f"{statistics.median(values_us):.0f} / {max(values_us):.0f} us"
