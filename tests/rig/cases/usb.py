# SPDX-License-Identifier: Apache-2.0
"""A Falcon on USB, and the vendor SDKs of the others as stubs."""
from bench import checks
from bench.back_ends import FALCON, FALCON_COLD, FORCE_DIMENSION, PHANTOM
from bench.case import Case

SOUND = (checks.hard_real_time, checks.no_fault, checks.no_late_tick, checks.touched)


def alive(back_end, *also, seeds=(1,)):
    return Case(f"{back_end.name}-alive", "the device presses the liver for 10 s", back_end,
                "control $SECONDS_OF_RUN\nfinish\nmeasure_peer 5", (*SOUND, *also), timed=True,
                seeds=seeds)


def swept(back_end):
    return Case(f"{back_end.name}-sweep", "no interleaving with other work loses a tick or a sample",
                back_end, "noise $SEED\ncontrol $SECONDS_OF_RUN\nfinish", SOUND, sweep=True, seconds=1.5,
                variables={"EMULATOR": "--homing-ms 100 --hand-tempo 2.5"})


def calls(back_end):
    return Case(f"{back_end.name}-threads", "the listed calls of the device, and sleep", back_end,
                "control $SECONDS_OF_RUN\nsleep .3\n"
                "trace_threads $tactd 1 >$RESULTS/threads.txt\nfinish",
                (checks.hard_real_time, checks.no_fault, checks.threads_as_listed), seconds=3)


CASES = [
    alive(FALCON, checks.pressed_by_hand),
    alive(FORCE_DIMENSION),
    alive(PHANTOM, seeds=(1, 2, 3)),  # one seed may fall on another timer of the kernel: the middle counts
    swept(FALCON),
    *(calls(back_end) for back_end in (FALCON, FORCE_DIMENSION, PHANTOM)),
    Case("falcon-upload", "a Falcon without firmware gets its owner's file, and is homed", FALCON_COLD,
         "control $SECONDS_OF_RUN\nfinish", (checks.hard_real_time, checks.no_fault), seeds=(1, 1), seconds=2.5,
         variables={"EMULATOR": "--homing-ms 100 --hand-tempo 2.5"}),
    Case("falcon-no-firmware", "a Falcon without firmware and without a file is refused",
         FALCON_COLD, "DEVICE+=(--set 'device.falcon.firmware=\"\"')\nrefused",
         (checks.refused("firmware"),)),
    Case("falcon-absent", "no Falcon is reported with the remedy", FORCE_DIMENSION,
         "usb up\nDEVICE=(--set 'device.kind=\"falcon\"')\nrefused", (checks.refused("0403:cb48"),)),
]
