# SPDX-License-Identifier: Apache-2.0
"""Safety lines on the kernel's simulated GPIO chip, beside the simulated delta."""
from bench import checks, estop_times
from bench.back_ends import (CIA402, CLUTCH, FALCON, GRIP, MOTEUS, ODRIVE06, SIM_DELTA_LINES, with_lines,
                             with_switches)
from bench.case import Case
from bench.faults import Latches, RidesThrough, attempt

REAL_TIME = (checks.hard_real_time, checks.no_late_tick)
PRESSING = "control $SECONDS_OF_RUN\nsleep 3.2\n"  # 10 mm deep, enabled since 0.1 s
A, B, DEAD_MAN, ENABLE, HEARTBEAT = range(5)


def fault(name, message, harm, required, also=(), shown=True):
    return Case(f"lines-{name}", message, SIM_DELTA_LINES, f"{PRESSING}{harm}\n{attempt(required)}\nfinish",
                (*REAL_TIME, *((checks.permission_gone,) if shown else ()), *also), fault=required, seconds=3.8)


def immediate(name):
    """An input is read in every tick; the shell that pulls it needs some 0.2 ms."""
    return Latches(name, detect_ms=1.5)


def estop_at_any_phase(back_end, pressing_s, seconds, emulator="", bus_us=0.0, long_only=False):
    return Case(f"{back_end.name.split()[0]}-estop-phases",
                "zero is written one period and 100 us after the e-stop, wherever in the tick it opens",
                back_end, f"control $SECONDS_OF_RUN\nsleep {pressing_s}\n{estop_times.SCRIPT}finish",
                (*REAL_TIME, estop_times.InTime(bus_us)), seeds=tuple(range(1, len(estop_times.PHASES_us) + 1)),
                seconds=seconds, long_only=long_only, variables={"EMULATOR": emulator})


def foot_switch(back_end, long_only=False):
    """The emulated hand rests at its deepest from 3.3 to 3.7 s, and lifts until 5 s."""
    return Case(f"{back_end.name}-foot-switch", "a foot switch closes the jaws of a delta on CAN: what they hold pulls",
                with_switches(back_end),
                f"control $SECONDS_OF_RUN\nsleep 3.2\npull {GRIP} up; sleep 1.6; pull {GRIP} down\nfinish",
                (checks.hard_real_time, checks.no_fault, checks.pulled), seconds=5.2, long_only=long_only)


OUTPUTS = f"gpio_sim get {ENABLE} >$RESULTS/enable.txt\n"

CASES = [
    Case("lines-alive", "enable comes with the heartbeat, and every tick reads and sets all lines",
         SIM_DELTA_LINES,
         f"control $SECONDS_OF_RUN\nsleep .05\ngpio_sim get {ENABLE} >$RESULTS/enable_early.txt\n"
         f"sleep .4\n{OUTPUTS}"
         # Not always at the same part of a beat, however long a read takes.
         f"for i in $(seq 40); do gpio_sim get {HEARTBEAT}; sleep .00$((11 + 3 * (i % 3))); done >$RESULTS/heartbeat.txt\n"
         "finish\nmeasure_peer 5",
         (*REAL_TIME, checks.no_fault, checks.touched, checks.lines_alive), timed=True),
    Case("lines-threads", "one call reads all lines, one sets them",
         SIM_DELTA_LINES, "control $SECONDS_OF_RUN\ntrace_threads $tactd 1 >$RESULTS/threads.txt\nfinish",
         (checks.hard_real_time, checks.no_fault, checks.threads_as_listed), seconds=2.6),
    fault("estop-a", "channel A alone stops the force in the tick that reads it",
          f"inject pull {A} down; sleep .03; {OUTPUTS}pull {A} up; sleep .01", immediate("emergency stop")),
    fault("estop-b", "channel B alone stops the force in the tick that reads it",
          f"inject pull {B} down; sleep .03; {OUTPUTS}pull {B} up; sleep .01", immediate("emergency stop")),
    fault("estop", "both channels stop the force, and a released button alone moves nothing",
          f"inject pull {A} down; pull {B} down; sleep .05; {OUTPUTS}"
          f"pull {A} up; pull {B} up; sleep .01", immediate("emergency stop")),
    fault("discrepancy", "channels that disagree for 50 ms are a fault that no reset clears",
          f"inject pull {B} down; sleep .1; {OUTPUTS}pull {B} up; sleep .05\n"
          "ask reset; sleep .1", immediate("emergency stop"),
          (checks.reported("channel A of the e-stop did not open with channel B"),)),
    fault("stuck", "a channel that sticks is reported by name, and no reset clears it",
          f"inject pull {A} down; sleep .1; {OUTPUTS}pull {A} up; sleep .05\n"
          "ask reset; sleep .1", immediate("emergency stop"),
          (checks.reported("channel B of the e-stop did not open with channel A"),)),
    fault("dead-man", "a released dead-man stops the force",
          f"inject pull {DEAD_MAN} down; sleep .03; {OUTPUTS}pull {DEAD_MAN} up; sleep .01", immediate("dead man released")),
    fault("chip-removed", "a chip that is gone stops the force",
          "inject gpio_sim remove; sleep .05", Latches("lines lost", detect_ms=30), shown=False),
    Case("lines-killed", "a killed controller makes no more edges: the relay beside it drops",
         SIM_DELTA_LINES,
         f"{PRESSING}kill -KILL $tactd; sleep .02\n"
         f"for i in $(seq 20); do gpio_sim get {HEARTBEAT}; sleep .0013; done >$RESULTS/heartbeat.txt\n"
         "finish", (checks.no_more_edges,), seconds=5),
    Case("lines-chip-missing", "refused before any force, with the remedy", SIM_DELTA_LINES,
         "gpio_sim down\nrefused", (checks.refused("GPIO chip"),)),
    Case("lines-reset", "an e-stop is left by reset and then arm, in this order, and only so",
         SIM_DELTA_LINES,
         f"control $SECONDS_OF_RUN\nsleep 1\ninject pull {A} down; pull {B} down; sleep .1\n"
         f"pull {A} up; pull {B} up; sleep .1\nask arm; sleep .1\n"
         "ask reset; sleep .3; ask arm\nfinish",
         (checks.hard_real_time, checks.armed_again), seconds=4),
    Case("lines-clutch", "a clutch in a press takes the force away, and what is released inside the organ has none",
         with_switches(SIM_DELTA_LINES),
         f"{PRESSING}inject pull {CLUTCH} up; sleep .3; pull {CLUTCH} down; sleep .2\nfinish",
         (*REAL_TIME, checks.no_fault, checks.clutched), fault=RidesThrough(), seconds=3.9),
    foot_switch(ODRIVE06), foot_switch(CIA402, long_only=True), foot_switch(MOTEUS, long_only=True),
    estop_at_any_phase(SIM_DELTA_LINES, pressing_s=3.2, seconds=3.4),
    # The emulated drives run below the loop on its core: they have a frame when its tick is over.
    estop_at_any_phase(with_lines(ODRIVE06), pressing_s=1.1, seconds=1.3, bus_us=50.0, emulator="--hand-tempo 2.5"),
    *(estop_at_any_phase(with_lines(back_end), pressing_s=1.1, seconds=1.3, bus_us=50.0,
                         emulator="--hand-tempo 2.5", long_only=True) for back_end in (CIA402, MOTEUS)),
    # Two microframes of the emulated bus lie between the write and the motors.
    estop_at_any_phase(with_lines(FALCON), pressing_s=1.3, seconds=1.5, bus_us=250.0, long_only=True,
                       emulator="--homing-ms 100 --hand-tempo 2.5"),
]
