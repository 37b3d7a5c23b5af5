"""What goes wrong on USB, while tactd presses 10 mm deep, 0.9 s after homing; by both transports."""
from bench import checks
from bench.back_ends import FALCON_LIBUSB, FALCON_USBFS
from bench.case import Case
from bench.faults import Latches, RidesThrough, attempt

AT = "0.9"
QUICK = "--homing-ms 100 --hand-tempo 2.5"
REAL_TIME = (checks.hard_real_time, checks.no_late_tick)
WATCH_IT_GO = "sleep 1.6\n[ -e /sys/bus/usb/devices/1-1 ] && ls /sys/bus/usb/devices || echo gone"


def fault(back_end, kind, sentence, required, also=(), meanwhile=""):
    name = kind.partition("@")[0].replace(":", "-")
    return Case(f"{back_end.name}-{name}", sentence, back_end,
                f"control $SECONDS_OF_RUN\n{meanwhile}\nsleep 1.5\n{attempt(required)}\nfinish", (*REAL_TIME, *also),
                fault=required, seconds=2.1, variables={"EMULATOR": f"{QUICK} --fault {kind}"})


def unplug(back_end):
    """Also the trap of an event thread that spins at FIFO and starves the kernel's hub worker."""
    return fault(back_end, f"unplug@{AT}", "a pulled device stops the force, and the kernel may take it apart",
                 Latches("device unplugged", detect_ms=3), (checks.device_gone,),
                 f"({WATCH_IT_GO}) >$RESULTS/unplugged.txt &")


def lost(detect_ms=24.0):
    return Latches("device lost", detect_ms=detect_ms, zero_ms=-7.0, motors_ms=15)


CASES = [
    unplug(FALCON_USBFS),
    unplug(FALCON_LIBUSB),
    fault(FALCON_USBFS, f"stall@{AT}", "a stalled endpoint stops the force for good",
          Latches("device failed", detect_ms=3, motors_ms=5)),
    fault(FALCON_LIBUSB, f"stall@{AT}", "a stalled endpoint stops the force for good",
          Latches("device failed", detect_ms=3, motors_ms=5)),
    fault(FALCON_USBFS, f"short@{AT}", "a packet cut short is no sample", RidesThrough()),
    fault(FALCON_USBFS, f"garbage@{AT}+60", "bytes that say nothing: faded, then a latched fault",
          Latches("device garbled", detect_ms=24, zero_ms=-5, motors_ms=15)),
    fault(FALCON_USBFS, f"no-reply:1@{AT}", "an answer 1 ms late is held over", RidesThrough()),
    fault(FALCON_USBFS, f"no-reply:3@{AT}", "an answer 3 ms late fades and comes back",
          RidesThrough(fades=True)),
    fault(FALCON_USBFS, f"no-reply:30@{AT}", "an answer that stays out for 30 ms: a latched fault", lost()),
    fault(FALCON_LIBUSB, f"no-reply:30@{AT}", "an answer that stays out for 30 ms: a latched fault", lost()),
    fault(FALCON_USBFS, f"duplicate@{AT}", "an answer that comes twice is one sample", RidesThrough()),
]
