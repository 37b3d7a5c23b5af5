# SPDX-License-Identifier: Apache-2.0
"""What goes wrong on a CAN bus and in drives, while tactd presses 10 mm deep, 0.9 s after enabling."""
from bench import checks
from bench.back_ends import CIA402, MOTEUS, ODRIVE05, ODRIVE06
from bench.case import Case
from bench.faults import Latches, RidesThrough, StoppedByDrives, StoppedByGuardian, attempt

# `ip link set down` needs some 15 ms before the kernel says so.
AT = "0.9"           # s after the drives are enabled: pressing
TEMPO = "--hand-tempo 2.5"
RAMP_ms = 12.0       # a missed sample holds, from the second the force fades in 10 ms
REAL_TIME = (checks.hard_real_time,)
# Motors behind a bus that still carries frames: zero torque and the stop leave in the tick that knows, and
# the emulated drives run when it is over. Without frames they stop by themselves: an ODrive's and a moteus'
# watchdog of 10 ms, a CiA 402 drive's consumer of heartbeats, and a tick and its look at the time.
REPORT_ms = 1.0
ALONE_ms = {"odrive06": 12.0, "cia402": 25.0, "moteus": 12.0}
# The same happens on ODrives in every run.
LONG = {("cia402", name) for name in ("link-down", "error-passive", "duplicated", "reordered", "wrong-node")}
LONG |= {("cia402", name) for name in ("clock-forward", "clock-back", "no-buffers", "silent", "stopped")}
LONG |= {("odrive05", "drive-fault")}


def kind_of(order):
    return order.partition("@")[0].partition(":")[0]


def counted(name, most):
    """The device counted at most so many, as its report says."""
    def check(run):
        count = run.report.get("device_counts", {}).get(name)
        return [] if count is not None and count <= most else [f"{count} {name}, at most {most} allowed"]
    return check


def every_tick_sampled(run):
    ticks = run.report.get("gate", {}).get("fresh")
    return [] if ticks == 0 else [f"{ticks} ticks without a sample, not 0"]


FILTERED = (*REAL_TIME, counted("strays", 0))       # the kernel kept them out, not the device
NONE_LOST = (*REAL_TIME, counted("old", 0), every_tick_sampled)


def committed(back_end, kind, message, required, options="", proofs=REAL_TIME):
    """A fault that the emulated drives commit by themselves."""
    return Case(f"{back_end.name}-{kind_of(kind)}", message, back_end,
                f"control $SECONDS_OF_RUN\nsleep 1.5\n{attempt(required)}\nfinish",
                proofs, fault=required, seconds=1.9, long_only=(back_end.name, kind_of(kind)) in LONG,
                variables={"EMULATOR": f"{TEMPO} --fault {kind} {options}"})


def done_to(back_end, name, message, harm, required, seconds=1.9, proofs=REAL_TIME):
    """A fault of the bus itself: the script waits until tactd presses, then does the harm."""
    return Case(f"{back_end.name}-{name}", message, back_end,
                f"control $SECONDS_OF_RUN\nsleep {AT}\n{harm}\nsleep .4\n{attempt(required)}\nfinish",
                proofs, fault=required, seconds=seconds, long_only=(back_end.name, name) in LONG,
                variables={"EMULATOR": TEMPO})


def error_frame(back_end, name, frame):
    required = Latches("bus off", detect_ms=12, motors_later_ms=REPORT_ms)
    return done_to(back_end, name, "an error frame of the controller stops the force for good",
                   f"inject cansend can1 {frame}", required)


def lost(detect_ms=23.0):
    """Samples stay out: faded to zero after a hold, latched after twenty."""
    return Latches("device lost", detect_ms=detect_ms, faded_ms=RAMP_ms + 2.5, motors_ms=RAMP_ms + 2.5)


CASES = [
    # What the bus does.
    done_to(ODRIVE06, "link-down", "an interface that goes down stops the force for good",
            "inject ip link set can0 down",
            Latches("bus down", detect_ms=25, motors_later_ms=ALONE_ms["odrive06"])),
    done_to(CIA402, "link-down", "an interface that goes down stops the force for good",
            "inject ip link set can0 down; sleep .2; ip link set can0 up",
            Latches("bus down", detect_ms=25, motors_later_ms=ALONE_ms["cia402"])),
    *(error_frame(back_end, "bus-off", "20000040#0000000000000000") for back_end in (ODRIVE06, CIA402)),
    *(error_frame(back_end, "error-passive", "20000004#0030000000000000") for back_end in (ODRIVE06, CIA402)),
    *(done_to(back_end, "foreign", "a command of another sender stops the force for good", f"inject cansend can1 {frame}",
              Latches("foreign command", detect_ms=12, motors_later_ms=REPORT_ms))
      for back_end, frame in ((ODRIVE06, "04E#CDCC4C3E00000000"), (CIA402, "202#0F003200"), (MOTEUS, "002##1015000"))),
    *(done_to(back_end, "no-buffers", "a bus that takes no frames is a missed cycle; the drives stop",
              # The time counts from the command; its files and the module are read before.
              "modprobe sch_netem; tc qdisc show dev can0 >/dev/null\n"
              "inject tc qdisc replace dev can0 root netem limit 1 delay 1s", required)
      for back_end, required in (
          # Their watchdogs stop the motors before the bus has missed twenty batches. A heartbeat in between reports it.
          (ODRIVE06, Latches("bus down", detect_ms=80, motors_later_ms=0, or_first="drive fault")),
          # They miss a heartbeat before the bus has missed twenty batches, each in its own millisecond, and say so.
          (CIA402, Latches("drive fault", detect_ms=80, motors_later_ms=2 * REPORT_ms, or_first="bus down")))),
    # What happens to frames.
    committed(ODRIVE06, f"lost@{AT}+40", "frames that stay out: fade, then a latched fault",
              lost()),
    committed(CIA402, f"lost@{AT}+40", "frames that stay out: fade, then a latched fault", lost()),
    committed(ODRIVE06, f"duplicated@{AT}+300", "a frame that comes twice is one sample",
              RidesThrough()),
    committed(CIA402, f"duplicated@{AT}+300", "a frame that comes twice is one sample",
              RidesThrough()),
    committed(ODRIVE06, f"reordered@{AT}+300", "frames of a tick may come in any order",
              RidesThrough()),
    committed(CIA402, f"reordered@{AT}+300", "frames of a tick may come in any order",
              RidesThrough()),
    # A CiA 402 drive's sample has no velocity: nothing in it says that the arm moves.
    committed(ODRIVE06, "stale:2@1.1+200", "an old position again, while the arm moves: no sample", lost(30.0)),
    *(committed(back_end, f"wrong-node:2@{AT}+60", "frames of a foreign node do not even reach the loop", lost(),
                proofs=FILTERED) for back_end in (ODRIVE06, CIA402)),
    committed(ODRIVE06, f"garbage:1@{AT}+60", "positions that jump about are those of no arm",
              Latches("homing lost", detect_ms=5, motors_ms=7)),
    # What happens to drives.
    committed(ODRIVE06, f"drive-fault:2@{AT}", "a drive that reports an error stops all three",
              Latches("drive fault", detect_ms=103, motors_ms=104)),
    committed(ODRIVE05, f"drive-fault:2@{AT}", "a drive that reports an error stops all three",
              Latches("drive fault", detect_ms=103, motors_ms=104)),
    committed(CIA402, f"drive-fault:2@{AT}", "a drive that reports an error stops all three",
              Latches("drive fault", detect_ms=3, motors_ms=5)),
    committed(MOTEUS, f"drive-fault:2@{AT}", "a drive that reports an error stops all three",
              Latches("drive fault", detect_ms=3, motors_ms=5)),
    committed(CIA402, f"emcy:3@{AT}", "an emergency message stops all three",
              Latches("drive fault", detect_ms=3, motors_ms=5)),
    committed(ODRIVE06, f"heartbeat-missing:1@{AT}+600", "a drive without heartbeat stops all three",
              Latches("drive silent", detect_ms=355, motors_ms=357)),
    committed(CIA402, f"heartbeat-missing:1@{AT}+600", "a drive without heartbeat stops all three",
              Latches("drive silent", detect_ms=40, motors_ms=42)),
    *(committed(back_end, f"silent:3@{AT}+600", "a drive that falls silent: fade, then a latched fault", lost())
      for back_end in (ODRIVE06, CIA402)),
    # What happens to tactd.
    *(done_to(back_end, f"clock-{way}", "the kernel stamps frames by the time of day, which may jump: no sample is lost",
              f"inject date -s '{day}'", RidesThrough(), proofs=NONE_LOST)
      for back_end in (ODRIVE06, CIA402) for way, day in (("forward", "2031-05-05"), ("back", "2001-01-01"))),
    *(done_to(back_end, "killed", "a controller that is killed: its guardian takes the force",
              "inject kill -KILL $tactd; sleep .1", StoppedByGuardian(), proofs=())
      for back_end in (ODRIVE06, CIA402, MOTEUS)),
    *(done_to(back_end, "killed-alone", "and its guardian with it: the drives' own watch over their host stops them",
              "inject kill -KILL $(pgrep tact-guardian) $tactd; sleep .1",
              StoppedByDrives(within_ms=ALONE_ms[back_end.name], trips=3), proofs=())
      for back_end in (ODRIVE06, CIA402, MOTEUS)),
    *(done_to(back_end, "held", "a controller that is held: its guardian takes the force",
              "inject kill -STOP $tactd; sleep .1; kill -KILL $tactd; sleep .1", StoppedByGuardian(within_ms=40.0), proofs=())
      for back_end in (ODRIVE06, CIA402, MOTEUS)),
    done_to(ODRIVE06, "guardian-held", "a controller whose guardian is held stops",
            "inject kill -STOP $(pgrep tact-guardian)",
            Latches("guardian lost", detect_ms=620)),
    done_to(ODRIVE06, "guardian-killed", "a controller whose guardian is killed stops",
            "inject kill -KILL $(pgrep tact-guardian)",
            Latches("guardian lost", detect_ms=7)),
    *(done_to(back_end, "stopped", "drives that stopped a sleeping controller's force keep it stopped",
              "kill -STOP $tactd; sleep .05; inject kill -CONT $tactd",
              Latches("drive fault", detect_ms=3, motors_ms=ALONE_ms[back_end.name] - 50,
                      or_first="loop late"))  # stopped within a tick: late first
      for back_end in (ODRIVE06, CIA402)),
]
