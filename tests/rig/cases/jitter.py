# SPDX-License-Identifier: Apache-2.0
"""tact-jitter on the bench: what it measures at a pin, against what the loop's own clock says."""
from bench.back_ends import BACK, LOOP_BACK
from bench.case import Case

IN_THE_PULSE = ("read", "detect", "render", "limit", "write")  # the scope line is up for as long as these


def pin_agrees(run):
    """A pulse is as long as its phases but for the wire's own delay. Ticks that touch nothing are shorter
    than the wire can see; edges before its interrupt had its priority find no other edge."""
    series, emulator = run.jitter.get("series", {}), run.emulator
    if run.text("jitter.status").strip() != "0" or "pin" not in series:
        return ["tact-jitter left no pulse: " + run.text("jitter.log")[-300:].strip()]
    pin, wrong = series["pin"], []
    delay_ns = emulator.get("latency_max_ns", 0)
    phases_ns = sum(series[phase]["p50_ns"] for phase in IN_THE_PULSE)
    if not 5_000 < delay_ns < 100_000:
        wrong.append(f"the wire's delay of up to {delay_ns} ns is none to evaluate a pulse by")
    if abs(pin["p50_ns"] - phases_ns) > delay_ns:
        wrong.append(f"a pulse lasts {pin['p50_ns']} ns, its phases {phases_ns} ns: more apart than the wire's "
                     f"{delay_ns} ns")
    if pin["samples"] < 0.9 * run.jitter["ticks"] or run.jitter["pin_edges_unpaired"] > 0.02 * run.jitter["ticks"]:
        wrong.append(f"{pin['samples']} pulses of {run.jitter['ticks']} ticks, "
                     f"{run.jitter['pin_edges_unpaired']} edges unpaired")
    return wrong


CASES = [
    Case("jitter-loop-back", "input to force at the scope pin is what the loop's own clock says", LOOP_BACK,
         f"measure_jitter --loop-back {BACK}", (pin_agrees,), seconds=1.5),
]
