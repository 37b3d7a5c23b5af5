# SPDX-License-Identifier: Apache-2.0
"""tact-jitter late on the bench: 200 delays of known causes, and what it says of each."""
import collections
import functools

from bench import checks
from bench.back_ends import SIM_DELTA
from bench.case import ROOT, Case
from bench.python_files import python_files

LATE = ROOT / "tools/jitter/late/tact-jitter-late"
THRESHOLD_US = 60
EACH = 40  # delays of a cause: 200 in all
CAUSES = {"thread": "thread", "interrupt": "interrupt", "softirq": "softirq", "fault": "page fault", "stall": "no software"}
NAMES = {"thread": "thread delay-thread", "interrupt": "interrupt local_timer", "softirq": "softirq HRTIMER"}
SCRIPT = f"""export PYTHONHOME=/tact/python
late="/tact/python/bin/python3 -B /tact/late/tact-jitter-late"
$late --hwlat 0.2 --threshold 50 >$RESULTS/hwlat.txt 2>&1
control $SECONDS_OF_RUN
{{
  $late --threshold {THRESHOLD_US} --json $RESULTS/late.json --trace $RESULTS/late.trace \\
    >$RESULTS/late.txt 2>$RESULTS/late.log
  echo $? >$RESULTS/late.status
}} & watching=$!
until grep -q watches $RESULTS/late.log; do kill -0 $watching || break; sleep .05; done
sleep .2
raised=$(pgrep -o '^ktimers/0')
for cause in {' '.join(CAUSES)}; do
  [ $cause != softirq ] || chrt -f -p 95 $raised
  tact-rig-delays $cause --grid $(tact-rig-ticks /tmp/ticks --grid) --count {EACH} --seed $SEED --tactd $tactd \\
    >>$RESULTS/delays.txt 2>>$RESULTS/delays.log
  [ $cause != softirq ] || chrt -f -p 1 $raised
  sleep .1
done
finish
tact-rig-ticks /tmp/ticks --late {THRESHOLD_US} >$RESULTS/late_ticks.txt
"""


def counted(run):
    """Of each cause: how many delays were named right, wrong, not known, not seen."""
    answers = {tick["due_ns"]: tick for tick in run.late.get("late_ticks", ())}
    out = {cause: collections.Counter() for cause in CAUSES}
    for line in run.text("delays.txt").splitlines():
        cause, due_ns = line.split()
        out[cause][verdict(cause, answers.pop(int(due_ns), None))] += 1
    return out, [answer for answer in answers.values() if answer["kind"] != "not known"]


def verdict(cause, answer):
    if answer is None or answer["kind"] == "not known":
        return "not seen" if answer is None else "not known"
    return "right" if answer["kind"] == CAUSES[cause] and answer["name"] == NAMES.get(cause, answer["name"]) else "wrong"


def named(run):
    """At least 95 % right and none wrong; none is named where nothing was done."""
    if not run.late:
        return ["tact-jitter late left nothing: " + (run.text("late.log") + run.text("case.log"))[-600:].strip()]
    of_cause, innocent = counted(run)
    wrong = [f"{cause}: {dict(verdicts)}, {EACH} were done" for cause, verdicts in of_cause.items()
             if verdicts["wrong"] or verdicts["right"] < 0.95 * EACH or verdicts.total() != EACH]
    return wrong + [f"named without a delay: {answer}" for answer in innocent]


def without_stalls(run):
    """hwlat runs, and an emulated CPU that no SMI holds has none."""
    said = run.text("hwlat.txt")
    return [] if "0 stalls above 50 us" in said else [f"hwlat: {said[-300:]}"]


def as_logged(run):
    """Each tick that woke late by the loop's own clock is there, and as late; page faults come before that clock is read."""
    answers = {tick["due_ns"]: tick for tick in run.late.get("late_ticks", ())}
    wrong, logged = [], [tuple(map(int, line.split())) for line in run.text("late_ticks.txt").splitlines()]
    for due_ns, woke_ns in logged:
        answer = answers.get(due_ns)
        if answer is None:
            wrong.append(f"the tick of {due_ns} ns woke {(woke_ns - due_ns) / 1000:.0f} us late, and is not there")
        elif answer["kind"] != "page fault" and not -1 < (woke_ns - due_ns) / 1000 - answer["wake_up_us"] < 10:
            wrong.append(f"the tick of {due_ns} ns woke {woke_ns - due_ns} ns late, not {answer['wake_up_us']} us")
    return wrong[:3] + ([] if len(logged) > 3 * EACH else [f"{len(logged)} ticks woke late: the delays delay nothing"])


CASES = [
    Case("late-named", "who made a tick late is named: thread, interrupt, softirq, page fault, stall", SIM_DELTA, SCRIPT,
         (checks.no_fault, named, as_logged, without_stalls), seconds=8, sweep=True, wall_limit_s=900,
         files=functools.partial(python_files, LATE)),
]
