# SPDX-License-Identifier: Apache-2.0
"""Drives on CAN: tactd's own bus code, the kernel's, and three emulated drives that swing an arm."""
from bench import checks
from bench.back_ends import CIA402, MOTEUS, ODRIVE05, ODRIVE06
from bench.case import Case

SOUND = (checks.hard_real_time, checks.no_fault, checks.no_late_tick, checks.touched,
         checks.pressed_by_hand)


def alive(back_end):
    return Case(f"{back_end.name}-alive", "a delta on CAN presses the liver for 10 s", back_end,
                "control $SECONDS_OF_RUN\nfinish\nmeasure_peer 5", SOUND, timed=True)


def swept(back_end, long_only=False):
    return Case(f"{back_end.name}-sweep", "no interleaving with other work loses a tick or a sample",
                back_end, "noise $SEED\ncontrol $SECONDS_OF_RUN\nfinish",
                (checks.hard_real_time, checks.no_fault, checks.no_late_tick, checks.touched), sweep=True,
                long_only=long_only, seconds=1.5, variables={"EMULATOR": "--hand-tempo 2.5 --phase-us $((SEED * 137 % 1000))"})


def not_looped_back(run):
    """Another program on the controller's own interface hears the drives, and nothing that tactd says: a copy
    of each frame would be made in the loop's own call."""
    heard = {line.split()[2].partition("#")[0] for line in run.text("own_side.txt").splitlines()}
    said = {f"{identifier:03X}" for _, identifier, _ in checks.frames_of(run)} - heard
    wrong = [] if heard else ["nothing was heard on the controller's side: it proves nothing"]
    torques = {f"{base + node * step:03X}" for node in (1, 2, 3) for base, step in TORQUES[run.case.back_end]}
    return wrong + [f"the loop's own {one} is looped back" for one in sorted(torques - said)]


# Identifiers of torques: base + node * step.
TORQUES = {ODRIVE06: ((0x00E, 0x20),), CIA402: ((0x200, 1),)}


def recorded(back_end, bus_check):
    return Case(f"{back_end.name}-recorded", "the bus as candump sees it, frame by frame, from both sides", back_end,
                "candump -L can1 >$RESULTS/candump.txt & background+=($!)\n"
                "candump -L can0 >$RESULTS/own_side.txt & background+=($!)\n"
                "control $SECONDS_OF_RUN\nfinish",
                (checks.hard_real_time, checks.no_fault, bus_check, not_looped_back), seeds=(1, 1), seconds=0.9,
                variables={"EMULATOR": "--hand-tempo 2.5"})


def calls(back_end):
    return Case(f"{back_end.name}-threads", "one call in, one call out, and sleep", back_end,
                "control $SECONDS_OF_RUN\nsleep .3\n"
                "trace_threads $tactd 1 >$RESULTS/threads.txt\nfinish",
                (checks.hard_real_time, checks.no_fault, checks.threads_as_listed), seconds=3)


def refused(back_end, name, emulator, *words):
    return Case(f"{back_end.name}-{name}", "refused before any force, with the remedy", back_end,
                "refused", (checks.refused(*words),), variables={"EMULATOR": emulator})


CASES = [
    *(alive(back_end) for back_end in (ODRIVE06, ODRIVE05, CIA402, MOTEUS)),
    swept(ODRIVE06),
    swept(CIA402, long_only=True),
    recorded(ODRIVE06, checks.bus_of_odrives),
    recorded(CIA402, checks.bus_of_cia402),
    *(calls(back_end) for back_end in (ODRIVE06, CIA402, MOTEUS)),
    refused(ODRIVE06, "unpowered", "--fault unpowered@0", "are they on"),
    refused(CIA402, "unpowered", "--fault unpowered@0", "are they on"),
    refused(MOTEUS, "unpowered", "--fault unpowered@0", "are they on"),
    Case("odrive06-bus-down", "refused before any force, with the remedy", ODRIVE06,
         "ip link set can0 down\nrefused", (checks.refused("ip link set can0 up"),)),
    refused(ODRIVE06, "no-ack", "--fault unpowered@0 --clock start " +
            " ".join(f"--fault no-ack-frame@{time}" for time in (0.4, 0.6, 0.8, 1.0, 1.2)),
            "acknowledge"),
]
