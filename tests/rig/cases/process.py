# SPDX-License-Identifier: Apache-2.0
"""What other programs and people do to tactd while it pushes on the hand, 3.5 s into the liver."""
import dataclasses
import math

from bench import checks
from bench.back_ends import FALCON, ODRIVE06, SIM_DELTA
from bench.case import Case
from bench.faults import Latches, RidesThrough, attempt

DEEP = "control $SECONDS_OF_RUN\nsleep 3.4\n"  # the hand holds 10 mm of depth from 3.0 to 4.0 s
UNMOVED = (checks.hard_real_time, checks.no_late_tick, checks.whole_run, checks.touched,
           checks.same_forces)


def hog(milliseconds):
    """A program that keeps the CPU for so long at FIFO 95, above everything that tactd has."""
    return (f"inject chrt -f 95 bash -c 'end=$((${{EPOCHREALTIME/./}} + {milliseconds}000)); "
            "while ((${EPOCHREALTIME/./} < end)); do :; done'")


HOG = ("inject true; stress-ng -q --seed 1 --cpu 1 --switch 1 --timeout 1s\n"
       "prove 'the load ran' [ $? = 0 ]")
# In the middle of it less than an eighth of the memory is left.
PRESSURE = ("inject true; stress-ng -q --seed 1 --vm 1 --vm-bytes 90% --vm-keep --timeout 2s & load=$!\n"
            "sleep 1.7; prove 'memory was short' awk '/MemTotal/ {all = $2} /MemAvailable/ {left = $2} "
            "END {exit 8 * left > all}' /proc/meminfo\n"
            "wait $load; prove 'the load ran' [ $? = 0 ]")
PAUSES = "stand 3; sleep .2; stand 19"
# Grip and pull, so quickly that the hand holds the pull while it would hold the press.
PULLING = dataclasses.replace(SIM_DELTA, settings=(*SIM_DELTA.settings, *(
    f"hand.stroke.{i}.duration_s={s}" for i, s in enumerate((.5, .2, .05, .2, .4, .5, .3, .8, 1.1)))))
SHORT = (checks.proved("memory was short", "the load ran"),)


def frames_dropped(run):
    """The viewer's queue was full: else nothing would have stalled."""
    return [] if run.report.get("dropped_frames", 0) > 0 else ["no frame was dropped: the viewer was not stalled"]


@dataclasses.dataclass(frozen=True)
class ForceAfterPauses:
    """tactd stood for these numbers of periods and no others, lost no contact, and wrote the force before each in
    the late tick and the eleven after it. `pulls`: the tissue is pulled, not pressed."""
    skipped: tuple
    pulls: bool = False

    def __call__(self, run):
        pauses, lost = run.ticks.get("pauses", []), run.report.get("contact_lost")
        wrong = [] if lost == 0 else [f"contact was lost {lost} times"]
        have = tuple(pause["skipped"] for pause in pauses)
        if have != self.skipped:
            wrong.append(f"{have} periods were skipped, not {self.skipped}")
        for pause in pauses:
            before_N, after_N = pause["before_N"], pause["after_N"]
            force_N = math.hypot(*before_N)
            if force_N < 0.2 or (before_N[2] < 0.0) != self.pulls:
                wrong.append(f"force {before_N} N before the pause: it proves nothing")
            farthest_N = max(after_N, key=lambda later_N: math.dist(before_N, later_N))
            if len(after_N) < 12 or math.dist(before_N, farthest_N) > 0.05 * force_N:
                wrong.append(f"force {farthest_N} N after a pause of {pause['skipped']} periods, {before_N} N before")
        return wrong


def on_hardware(back_end, name, message, harm, proofs):
    """The same while a device on a real bus is pressed."""
    quick = "--homing-ms 100 --hand-tempo 2.5" if back_end is FALCON else "--hand-tempo 2.5"
    return Case(f"{back_end.name}-{name}", message, back_end,
                f"control $SECONDS_OF_RUN\nsleep .9\n{harm}\nfinish",
                (checks.hard_real_time, checks.no_late_tick, *proofs),
                fault=RidesThrough(), seconds=3.5, long_only=True, variables={"EMULATOR": quick})


def fault(name, message, harm, required, also=(), back_end=SIM_DELTA):
    """A case of 6 s: run deep into the tissue, do the harm, wait for the end."""
    return Case(name, message, back_end, f"{DEEP}{harm}\n{attempt(required)}\nfinish", also, fault=required, seconds=6)


CASES = [
    fault("stopped-50-ms", "a process that was stopped does not push again on its own",
          "kill -STOP $tactd; sleep .05; inject kill -CONT $tactd; sleep .1",
          Latches("loop late", detect_ms=2), (checks.hard_real_time,)),
    fault("hog-fifo-95-3-ms", "a short loss of the CPU costs ticks, not the run",
          hog(3),
          RidesThrough(most_skipped=19), (checks.hard_real_time,)),
    fault("hog-fifo-95-40-ms", "a long loss of the CPU to a higher priority stops the force for good",
          hog(40),
          Latches("loop late", detect_ms=60), (checks.hard_real_time,)),
    fault("loop-held-60-ms", "a loop that does not come back from a call is stopped by the watch above it",
          # strace holds it inside its sleep, above everything but the watch
          "held=$(grep -ls tact-loop /proc/$tactd/task/*/comm); held=${held%/comm}\n"
          "inject timeout 1 chrt -f 84 strace -qq -o /dev/null -p ${held##*/} "
          "-e inject=clock_nanosleep:delay_exit=60000:when=1",
          Latches("loop stalled", detect_ms=150), (checks.hard_real_time,)),
    fault("stands-pressing", "what is pressed has the same force after a pause", PAUSES,
          RidesThrough(most_skipped=19), (checks.hard_real_time, ForceAfterPauses((3, 19)))),
    fault("stands-pulling", "what is held is held after a pause, and pulls as before it", PAUSES,
          RidesThrough(most_skipped=19), (checks.hard_real_time, ForceAfterPauses((3, 19), pulls=True)), PULLING),
    fault("hog-cpu", "ordinary load takes nothing from the loop", HOG,
          RidesThrough(), (*UNMOVED, checks.proved("the load ran"))),
    fault("memory-pressure", "memory that is short elsewhere is never short in the loop", PRESSURE,
          RidesThrough(), (*UNMOVED, *SHORT)),
    fault("viewer-stalled", "a viewer that never reads costs neither a tick nor a force",
          "tact-rig-viewer $SOCKET >/tmp/seen 2>&1 & viewer=$!\n"
          "sleep .3; prove 'the viewer had a frame' grep -q 'had a frame' /tmp/seen; inject kill -STOP $viewer\n"
          "sleep 2; prove 'the viewer stood' grep -q '^State:.T' /proc/$viewer/status; kill -KILL $viewer",
          RidesThrough(), (*UNMOVED, checks.proved("the viewer had a frame", "the viewer stood"), frames_dropped)),
    fault("clock-step", "the time of day may jump, the loop does not know it",
          "inject date -s '2031-05-05 05:05:05'; prove 'it was 2031' [ $(date +%Y) = 2031 ]; sleep .5\n"
          "date -s '2001-01-01'; prove 'it was 2001' [ $(date +%Y) = 2001 ]",
          RidesThrough(), (*UNMOVED, checks.proved("it was 2031", "it was 2001"))),
    *(on_hardware(back_end, name, message, harm, proofs)
      for back_end in (ODRIVE06, FALCON)
      for name, message, harm, proofs in (
          ("hog-cpu", "ordinary load takes nothing from the loop", HOG, (checks.proved("the load ran"),)),
          ("memory-pressure", "memory that is short elsewhere is never short in the loop", PRESSURE, SHORT))),
    Case("exit-beside-fifo", "tactd's end does not delay another real-time loop, FIFO 50",
         SIM_DELTA, "control $SECONDS_OF_RUN\nmeasure_peer 3 50 &\nfinish",
         (checks.hard_real_time, checks.no_fault, checks.peer_undisturbed(200_000)), seconds=2),
    Case("killed-beside-fifo", "nor is its sudden death",
         SIM_DELTA, "control $SECONDS_OF_RUN\nmeasure_peer 3 50 &\nsleep 1\nkill -KILL $tactd\nfinish",
         (checks.peer_undisturbed(200_000),), seconds=10),
]
