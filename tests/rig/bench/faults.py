# SPDX-License-Identifier: Apache-2.0
"""Faults: what is required of each, and the table that a run writes."""
import dataclasses
import json


@dataclasses.dataclass(frozen=True)
class Latches:
    """The fault is latched under `name`; the force is zero in time; nothing moves again.

    A stop is zero `zero_ms` after the tick that knows. A loss fades before it latches: it is zero
    `faded_ms` after the injection."""
    name: str
    detect_ms: float            # from the injection to the first tick that knows
    zero_ms: float = 1.0        # from that tick to the first with zero force
    faded_ms: float = None      # instead: from the injection to the first tick with zero force
    exit_status: str = "1"
    motors_ms: float = None     # from the injection to no force in the emulated motors
    motors_later_ms: float = None   # instead: from the tick that knows to no torque in them
    or_first: str = ""          # another fault of the same harm, which may be seen first

    def check(self, run):
        ticks, wrong = run.ticks, []
        detected, zero = ticks.get("detected"), ticks.get("zero")
        if not ticks.get("pushed_before") or ticks.get("force_before_N", 0.0) == 0.0:
            wrong.append("no force when the fault came: it proves nothing")
        if not detected or detected["fault"] not in (self.name, self.or_first):
            wrong.append(f"latched '{(detected or {}).get('fault')}', not '{self.name}'")
        elif detected["after_ms"] > self.detect_ms:
            wrong.append(f"seen after {detected['after_ms']:.2f} ms, bound {self.detect_ms} ms")
        if not zero:
            wrong.append("the force never became zero")
        elif self.faded_ms is not None and zero["after_ms"] > self.faded_ms:
            wrong.append(f"zero after {zero['after_ms']:.2f} ms, bound {self.faded_ms} ms")
        elif self.faded_ms is None and detected and zero["after_ms"] - detected["after_ms"] > self.zero_ms:
            wrong.append(f"zero {zero['after_ms'] - detected['after_ms']:.2f} ms after that, "
                         f"bound {self.zero_ms} ms")
        if ticks.get("moved_after_N") != 0.0 or ticks.get("armed_ticks_after") != 0:
            wrong.append(f"it moved again: {ticks.get('moved_after_N')} N, armed for "
                         f"{ticks.get('armed_ticks_after')} ticks")
        if ticks.get("end_state") != "stopped" or ticks.get("end_fault") != (detected or {}).get("fault"):
            wrong.append(f"ended {ticks.get('end_state')} with '{ticks.get('end_fault')}': not latched")
        if run.text("tactd.status").strip() != self.exit_status:
            wrong.append(f"exit status {run.text('tactd.status').strip()}, not {self.exit_status}")
        if self.motors_ms is not None:
            wrong += motors_let_go(run, self.motors_ms)
        if self.motors_later_ms is not None:
            wrong += motors_let_go(run, self.motors_later_ms, since_ns=(detected or {}).get("time_ns"))
        return wrong

    def row(self, run):
        detected, zero = run.ticks.get("detected") or {}, run.ticks.get("zero") or {}
        return {"detected_as": detected.get("fault", "nothing"), "detected_ms": detected.get("after_ms"),
                "zero_ms": zero.get("after_ms"), "motors_ms": motors_ms(run),
                "bound": f"{self.detect_ms:g}, " + (f"zero {self.zero_ms:g} later" if self.faded_ms is None
                                                    else f"faded by {self.faded_ms:g}") + " ms",
                "moved_after_N": run.ticks.get("moved_after_N")}


OF_THE_DEVICE = {"bus down", "bus off", "drive fault", "drive silent", "device unplugged",
                 "device garbled", "homing lost", "device failed", "lines lost"}


def attempt(required):
    """bash: what must not bring a force back. A fault of the device outlives a reset; of all others,
    arming alone changes nothing."""
    if not isinstance(required, Latches):
        return ""
    return "ask reset; ask arm" if required.name in OF_THE_DEVICE else "ask arm"


def motors_let_go(run, within_ms, since_ns=None):
    """What the motors on the other side of the bus did: no torque in time, and none after it. Of a fault
    that the emulator committed itself it knows the first zero; of all others the zero that lasted."""
    injected = (run.emulator.get("faults") or [{}])[0]
    since_ns = since_ns or injected.get("injected_ns") or run.ticks.get("injected_ns") or 0
    zero_ns = injected.get("torque_zero_ns") if injected else run.emulator.get("torque_zero_since_ns")
    if not since_ns or not zero_ns:
        return [f"the motors kept their force: {injected}"]
    took_ms, again_N = (zero_ns - since_ns) / 1e6, injected.get("largest_after_zero_N", 0.0)
    wrong = []
    if took_ms > within_ms:
        wrong.append(f"the motors let go after {took_ms:.2f} ms, bound {within_ms} ms")
    if again_N >= 0.05:
        wrong.append(f"the motors pushed again: {again_N:.3f} N")
    return wrong


def motors_ms(run):
    """From the injection to motors without torque, ms; None without emulated motors."""
    injected = (run.emulator.get("faults") or [{}])[0]
    zero_ns = injected.get("torque_zero_ns") or run.emulator.get("torque_zero_since_ns")
    since_ns = injected.get("injected_ns") or run.ticks.get("injected_ns")
    return (zero_ns - since_ns) / 1e6 if zero_ns and since_ns else None


@dataclasses.dataclass(frozen=True)
class RidesThrough:
    """What must not stop tactd: no fault, and at most so many periods lost at once."""
    most_skipped: int = 0
    fades: bool = False         # samples must have been missed

    def check(self, run):
        ticks, wrong = run.ticks, []
        if ticks.get("injected_ns", 0) == 0 or not ticks.get("first_tick_after"):
            wrong.append("nothing was injected while tactd ran: it proves nothing")
        if any(fault.get("acts") == 0 for fault in run.emulator.get("faults") or ()):
            wrong.append("the emulator changed nothing: it proves nothing")
        if self.fades and not ticks.get("missed"):
            wrong.append("no sample was missed: it proves nothing")
        if ticks.get("detected") or ticks.get("end_state") != "armed":
            wrong.append(f"stopped by '{ticks.get('end_fault')}', ended {ticks.get('end_state')}")
        if ticks.get("most_skipped_at_once", 1 << 30) > self.most_skipped:
            wrong.append(f"{ticks.get('most_skipped_at_once')} periods lost at once, "
                         f"{self.most_skipped} allowed")
        if run.text("tactd.status").strip() != "0":
            wrong.append(f"exit status {run.text('tactd.status').strip()}")
        return wrong

    def row(self, run):
        lost = run.ticks.get("most_skipped_at_once")
        return {"detected_as": "rides through", "detected_ms": None, "zero_ms": None, "motors_ms": None,
                "bound": f"{self.most_skipped} periods lost, {lost} were", "moved_after_N": None}


@dataclasses.dataclass(frozen=True)
class StoppedByDrives:
    """tactd is gone without a word: the drives' own watchdogs take the force."""
    within_ms: float
    trips: int

    def check(self, run):
        wrong = []
        if run.emulator.get("watchdog_trips") != self.trips:
            wrong.append(f"{run.emulator.get('watchdog_trips')} watchdogs tripped, not {self.trips}")
        if run.text("tactd.status").strip() != "137":
            wrong.append(f"exit status {run.text('tactd.status').strip()}: it was not killed")
        if run.ticks.get("force_before_N", 0.0) == 0.0:
            wrong.append("no force when it was killed: it proves nothing")
        oldest_ms = run.emulator.get("oldest_command_ns", 1e12) / 1e6
        if oldest_ms > self.within_ms:
            wrong.append(f"a torque was held for {oldest_ms:.2f} ms, bound {self.within_ms} ms")
        return wrong

    def row(self, run):
        return {"detected_as": "by the drives", "detected_ms": None,
                "zero_ms": run.emulator.get("oldest_command_ns", 0) / 1e6, "motors_ms": motors_ms(run),
                "bound": f"{self.within_ms:g} ms", "moved_after_N": None}


@dataclasses.dataclass(frozen=True)
class StoppedByGuardian:
    """tactd is gone without a word: its guardian takes the force, before any watchdog could."""
    within_ms: float = 5.0

    def check(self, run):
        wrong = []
        if run.text("tactd.status").strip() != "137":
            wrong.append(f"exit status {run.text('tactd.status').strip()}: it was not killed")
        if run.ticks.get("force_before_N", 0.0) == 0.0:
            wrong.append("no force when it was killed: it proves nothing")
        if "tact-guardian: tactd" not in run.text("tactd.log"):
            wrong.append("the guardian did not report that it acted")
        return wrong + motors_let_go(run, self.within_ms)

    def row(self, run):
        return {"detected_as": "by the guardian", "detected_ms": None, "zero_ms": None,
                "motors_ms": motors_ms(run), "bound": f"{self.within_ms:g} ms", "moved_after_N": None}


def write_table(runs, folder):
    """faults.md and faults.json in `folder`, a row for every run with a fault."""
    rows = []
    for run in runs:
        if run.case.fault is not None:
            rows.append({"fault": run.case.name, "back_end": run.case.back_end.name,
                         "seed": run.seed, **run.case.fault.row(run),
                         "verdict": "good" if not run.complaints else "; ".join(run.complaints)})
    (folder / "faults.json").write_text(json.dumps(rows, indent=2) + "\n")
    lines = ["# Faults on the virtual bench", "",
             "Times are guest time: ms from the injection to the tick that knows, and to the first with "
             "zero force; of the motors, to no torque in the emulated drives. A loss ramps down to zero before it "
             "latches.", "",
             "| fault | back end | detected as | injected to detected | injected to zero | to idle motors | "
             "bound | moved afterwards | verdict |", "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        lines.append("| " + " | ".join(
            [row["fault"], row["back_end"], row["detected_as"], ms(row["detected_ms"]),
             ms(row["zero_ms"]), ms(row["motors_ms"]), row["bound"],
             "-" if row["moved_after_N"] is None else f"{row['moved_after_N']:g} N",
             row["verdict"]]) + " |")
    (folder / "faults.md").write_text("\n".join(lines) + "\n")
    return rows


def ms(value):
    return "-" if value is None else f"{value:.2f} ms"
