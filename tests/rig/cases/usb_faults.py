# SPDX-License-Identifier: Apache-2.0
"""What goes wrong on USB, while tactd presses 10 mm deep, 0.9 s after homing."""
from bench import checks
from bench.back_ends import FALCON
from bench.case import Case
from bench.faults import Latches, RidesThrough, StoppedByGuardian, attempt

AT = "0.9"
QUICK = "--homing-ms 100 --hand-tempo 2.5"
REAL_TIME = (checks.hard_real_time, checks.no_late_tick)
WATCH_IT_GO = ("for i in {1..200}; do [ -e /sys/bus/usb/devices/1-1 ] || break; sleep .01; done; "
               "[ -e /sys/bus/usb/devices/1-1 ] || echo $((${EPOCHREALTIME/./} * 1000 + clock_offset_ns))")


def fault(back_end, kind, message, required, also=(), meanwhile=""):
    name = kind.partition("@")[0].replace(":", "-")
    return Case(f"{back_end.name}-{name}", message, back_end,
                f"control $SECONDS_OF_RUN\n{meanwhile}\nsleep 1.5\n{attempt(required)}\nfinish", (*REAL_TIME, *also),
                fault=required, seconds=2.1,
                variables={"EMULATOR": f"{QUICK} --fault {kind}"})


def unplug(back_end):
    """Also the trap of an event thread that spins at FIFO and starves the kernel's hub worker."""
    return fault(back_end, f"unplug@{AT}", "a pulled device stops the force, and the kernel may take it apart",
                 Latches("device unplugged", detect_ms=3), (checks.device_gone,),
                 f"({WATCH_IT_GO}) >$RESULTS/unplugged.txt &")


def lost(detect_ms=24.0):
    return Latches("device lost", detect_ms=detect_ms, faded_ms=13, motors_ms=15)


def held_loop(back_end):
    """The loop alone is stopped, in its sleep, above everything but the watch and the bus's thread, which goes on;
    without an enable line only that thread can end the force. strace needs some 20 ms to begin."""
    required = Latches("loop stalled", detect_ms=400)
    return Case(f"{back_end.name}-loop-held", "a loop that is stopped for 300 ms does not leave its force on", back_end,
                "control $SECONDS_OF_RUN\nsleep 1.2\n"
                "held=$(grep -ls tact-loop /proc/$tactd/task/*/comm); held=${held%/comm}\n"
                "inject timeout 1 chrt -f 81 strace -qq -o /dev/null -p ${held##*/} "
                "-e inject=clock_nanosleep:delay_exit=300000:when=1\n"
                f"{attempt(required)}\nfinish",
                (checks.hard_real_time, checks.let_go_within(130)),
                fault=required, seconds=2.6, variables={"EMULATOR": QUICK})


def stopped(back_end):
    """The whole process is stopped, the bus's thread, too: the old force stays until it goes on."""
    required = Latches("loop late", detect_ms=2, or_first="loop stalled")
    return Case(f"{back_end.name}-stopped", "a process that was stopped does not push again on its own", back_end,
                "control $SECONDS_OF_RUN\nsleep 1.2\n"
                f"kill -STOP $tactd; sleep .05; inject kill -CONT $tactd; sleep .1\n{attempt(required)}\nfinish",
                (checks.hard_real_time,), fault=required, seconds=2.1, variables={"EMULATOR": QUICK})


def killed(back_end):
    """A Falcon may hold its last motor words for ever: only the guardian is there to send zeros."""
    return Case(f"{back_end.name}-killed", "a controller that is killed: its guardian takes the force", back_end,
                "control $SECONDS_OF_RUN\nsleep 1.2\ninject kill -KILL $tactd; sleep .1\nfinish",
                (), fault=StoppedByGuardian(), seconds=2.1, variables={"EMULATOR": QUICK})


CASES = [
    held_loop(FALCON),
    stopped(FALCON),
    killed(FALCON),
    unplug(FALCON),
    fault(FALCON, f"stall@{AT}", "a stalled endpoint stops the force for good",
          Latches("device failed", detect_ms=3, motors_ms=5)),
    fault(FALCON, f"short@{AT}", "a packet cut short is no sample", RidesThrough()),
    fault(FALCON, f"garbage@{AT}+60", "bytes that say nothing: faded, then a latched fault",
          Latches("device garbled", detect_ms=24, faded_ms=13, motors_ms=15)),
    fault(FALCON, f"no-reply:1@{AT}", "an answer 1 ms late is held over", RidesThrough()),
    fault(FALCON, f"no-reply:3@{AT}", "an answer 3 ms late fades and comes back", RidesThrough(fades=True)),
    fault(FALCON, f"no-reply:30@{AT}", "an answer that stays out for 30 ms: a latched fault", lost()),
    fault(FALCON, f"duplicate@{AT}", "an answer that comes twice is one sample", RidesThrough()),
]
