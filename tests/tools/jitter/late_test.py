#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-jitter late names what ran: by recorded traces, and by random ones against a count of every microsecond.

    python3 tests/tools/jitter/late_test.py
"""
import collections
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
LATE = ROOT / "tools/jitter/late"
TRACES = pathlib.Path(__file__).with_name("late_traces.txt")
sys.dont_write_bytecode = True
sys.path.insert(0, str(LATE))
from late_oracle import IDLE, LOOP, OTHERS, PERIOD_US, Trace, random_tick  # noqa: E402
from late_reason import Evidence, LoopMonitor, Tick, explain, period_of  # noqa: E402
from late_report import read_trace  # noqa: E402
from late_trace import parse, priority_of, switch_of  # noqa: E402
from late_tracefs import Counters, Wrong, cpus_of, find_loop, mask_of  # noqa: E402


class Parts(unittest.TestCase):
    def test_each_microsecond_belongs_to_who_ran_in_it(self):
        kinds = collections.Counter()
        for seed in range(600):
            trace, tick, usual_us, want = random_tick(random.Random(seed))
            reason = explain(trace.lines, tick, 50, usual_us)
            self.assertEqual(dict(reason.parts), dict(want), f"seed {seed}")
            answer = reason.answer()
            key, most_us = max(want.items(), key=lambda pair: pair[1])
            self.assertEqual(answer["kind"], key[0] if most_us >= want.total() / 2 else "not known", f"seed {seed}")
            kinds[answer["kind"]] += 1
        named = ("interrupt", "no software", "softirq", "thread", "own code", "not known", "wait")
        self.assertGreater(min(kinds[kind] for kind in named), 5, kinds)

    def test_recorded_delays_are_named(self):
        run = subprocess.run([sys.executable, "-B", LATE / "tact-jitter-late", "--from", TRACES], capture_output=True, text=True)
        said = run.stdout.splitlines()
        names = ("thread delay-thread (pid 424, real-time 90)", "interrupt local_timer (hrtimer_wakeup)",
                 "softirq HRTIMER (timerfd_tmrproc) in ktimers/0 (pid 15, real-time 95)", "page fault", "no software (SMI, ")
        for name, message, (thread, usual_us, about, lines) in zip(names, said, read_trace(TRACES), strict=True):
            self.assertIn(f" us late: {name}", message)
            tick = Tick(**about)
            self.assertGreater(explain(lines, tick, thread, usual_us).answer()["explains"], 0.9)
            found = []
            watching = LoopMonitor(thread, 50, lambda *late, to=found: to.append(late[1]), 1_000_000)
            watching.usual_us, watching.due_ns = usual_us, round(tick.due_us * 1000) - 1_000_000
            for line in lines:
                watching.feed(line)
            self.assertEqual(found, [tick])
        self.assertEqual(run.returncode, 1)

    def test_what_was_lost_is_not_known(self):
        trace, tick, usual_us, _ = random_tick(random.Random(1))
        for at in range(0, len(trace.lines), 7):
            reason = explain([*trace.lines[:at], None, *trace.lines[at:]], tick, 50, usual_us)
            self.assertEqual((reason.answer()["kind"], "lost" in reason.answer()["why"]), ("not known", True))


class Kinds(unittest.TestCase):
    def tick(self, before="", inside="", spend_us=400, wake_us=5):
        trace = Trace(random.Random(0))
        if before:
            trace.say(*before)
        trace.spend(300)
        due_us = trace.us
        trace.spend(wake_us)
        trace.say("sched_waking", "comm=tact-loop pid=50 prio=19 target_cpu=000")
        trace.switch(LOOP)
        woke_us = trace.us
        trace.spend(10)
        if inside:
            trace.say(*inside)
        trace.spend(spend_us)
        tick = Tick(due_us, woke_us, trace.us, 0, 0)
        trace.switch(IDLE)
        return trace.lines, tick

    def named(self, evidence=Evidence(), latency_us=(), **about):
        return explain(*self.tick(**about), 50, 20, evidence, latency_us).answer()

    def test_own_code_a_fault_a_frequency_or_a_counted_stall(self):
        fault = ("page_fault_user", "address=0x7f00 ip=0x5500 error_code=0x7")
        self.assertEqual(self.named(inside=fault)["kind"], "page fault")
        self.assertEqual(self.named(inside=fault)["address"], "0x7f00")
        answer = self.named(inside=("cpu_frequency", "state=800000 cpu_id=0"))
        self.assertEqual((answer["kind"], answer["kHz"]), ("frequency change", 800000))
        self.assertEqual(self.named(inside=("cpu_frequency", "state=800000 cpu_id=1"))["kind"], "own code")
        self.assertEqual(self.named(evidence=Evidence(smi=1))["kind"], "no software")
        self.assertEqual(self.named(evidence=Evidence(smi=0, steal_ms=10))["kind"], "no software")
        self.assertEqual(self.named()["kind"], "own code")

    def test_a_sleep_state_only_as_long_as_it_takes(self):
        sleeps = ("cpu_idle", "state=2 cpu_id=0")
        for wake_us, kind in ((180, "sleep state"), (400, "no software")):
            answer = self.named(before=sleeps, spend_us=10, wake_us=wake_us, latency_us=(0, 2, 100))
            self.assertEqual(answer["kind"], kind)
        awake = ("cpu_idle", "state=4294967295 cpu_id=0")
        self.assertEqual(self.named(before=awake, spend_us=10, wake_us=180, latency_us=(0, 2, 100))["kind"], "no software")

    def test_a_wake_up_by_another_cpu_or_by_none(self):
        """With nohz_full the timer of a loop may run on another CPU: before its wake-up that one is late, after it who
        has the loop's own."""
        for waking_us, kind in ((390, "another CPU"), (10, "thread")):
            trace = Trace(random.Random(0), thread=OTHERS[0])
            trace.say("sched_waking", "comm=x pid=3 prio=9 target_cpu=000")
            due_us = trace.us + 10
            trace.spend(400)
            trace.switch(LOOP, "R")
            tick = Tick(due_us, trace.us, trace.us + 10, 0, 0)
            trace.spend(10)
            trace.switch(IDLE)
            at_us = due_us + waking_us
            waking = (f"{'swapper/2':>16}-0       [002] d..h1.. {at_us // 10**6:5}.{at_us % 10**6:06}: sched_waking: "
                      "comm=tact-loop pid=50 prio=19 target_cpu=000")
            self.assertEqual(explain(trace.lines, tick, 50, 20, anywhere=[waking]).answer()["kind"], kind)
            answer = explain(trace.lines, tick, 50, 20).answer()
            self.assertEqual((answer["kind"], answer["why"]), ("not known", "the wake-up of the loop was not seen"))

    def test_an_interrupt_without_an_end_ends_at_the_switch(self):
        lines, tick = self.tick(inside=("reschedule_entry", "vector=253"))
        trace = Trace(random.Random(0), tick.end_us)
        trace.spend(5)
        trace.switch(LOOP)
        trace.spend(2000)
        trace.switch(IDLE)
        answer = explain(lines + trace.lines, tick._replace(end_us=trace.us), 50, 20).answer()
        self.assertEqual((answer["kind"], answer["others"][0]["name"]), ("own code", "interrupt reschedule"))

    def test_an_nmi_is_reported_at_its_end(self):
        trace = Trace(random.Random(0))
        due_us = trace.us + 10
        trace.say("sched_waking", "comm=x pid=3 prio=9 target_cpu=000")
        trace.spend(250)
        trace.say("nmi_handler", "perf_event_nmi_handler() delta_ns: 240000 handled: 1")
        trace.say("sched_waking", "comm=tact-loop pid=50 prio=19 target_cpu=000")
        trace.switch(LOOP)
        tick = Tick(due_us, trace.us, trace.us + 10, 0, 0)
        trace.spend(10)
        trace.switch(IDLE)
        answer = explain(trace.lines, tick, 50, 20).answer()
        self.assertEqual((answer["name"], answer["explains_us"]), ("NMI perf_event_nmi_handler", 240))


class Deadlines(unittest.TestCase):
    def test_late_ticks_are_those_of_the_grid(self):
        """Sleeps that are broken by signals and timers of other calls are no ticks; too long ticks skip periods."""
        unslept = 0
        for seed in range(40):
            chosen = random.Random(seed)
            trace, want, have = Trace(chosen), [], []
            due_us = 5_001_000
            trace.thread = LOOP
            for k in range(300):
                trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={due_us}000 mode=ABS|HARD")
                late_us = chosen.choice((3, 3, 3, 3, 300, 2500)) if k > 150 else 3
                run_us = chosen.choice((40,) * 8 + (500, 995)) if k > 150 else 40
                if trace.us == due_us - 2 and chosen.random() < 0.5:  # its sleep ends before it begins
                    unslept, late_us = unslept + 1, 0
                else:
                    trace.switch(IDLE)
                    if chosen.random() < 0.1:  # a signal
                        trace.spend(max(0, due_us - trace.us - 100))
                        trace.switch(LOOP)
                        trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={due_us}000 mode=ABS|HARD")
                        trace.switch(IDLE)
                trace.spend(due_us + late_us - trace.us)
                if trace.thread is IDLE:
                    trace.switch(LOOP)
                if chosen.random() < 0.2:  # a call that waits for a device
                    trace.say("hrtimer_start", f"hrtimer=2 function=hrtimer_wakeup expires={due_us + 333}123 mode=ABS")
                    trace.switch(IDLE)
                    trace.spend(20)
                    trace.switch(LOOP)
                    run_us -= 20
                trace.spend(run_us)
                if k > 150 and late_us + max(0, run_us - 20) > 130:
                    want.append(due_us)
                due_us += ((trace.us - due_us) // PERIOD_US + 1) * PERIOD_US
            trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={due_us}000 mode=ABS|HARD")
            trace.switch(IDLE)
            watching = LoopMonitor(50, 100, lambda lines, tick, usual_us: have.append(tick.due_us))
            for line in trace.lines:
                watching.feed(line)
            self.assertEqual((watching.period_ns, have), (1_000_000, want), f"seed {seed}")
            self.assertGreater(len(want), 20)
            self.assertLess(len(watching.lines) + len(watching.before), 40)
        self.assertGreater(unslept, 20)

    def test_the_usual_waiting_of_a_device_is_not_late(self):
        trace, due_us, have = Trace(random.Random(0)), 5_001_000, []
        trace.thread = LOOP
        for k in range(300):
            trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={due_us}000 mode=ABS|HARD")
            trace.switch(IDLE)
            trace.spend(due_us - trace.us)
            trace.say("sched_waking", "comm=tact-loop pid=50 prio=19 target_cpu=000")
            trace.switch(OTHERS[0])
            trace.spend(150 if k == 200 else 3)
            trace.switch(LOOP)
            trace.spend(20)
            trace.switch(IDLE)  # 200 us for a device, once 500
            trace.spend(500 if k == 250 else 200)
            trace.say("sched_waking", "comm=tact-loop pid=50 prio=19 target_cpu=000")
            trace.switch(LOOP)
            trace.spend(20)
            due_us += PERIOD_US
        watching = LoopMonitor(50, 100, lambda *late: have.append(explain(*late[:2], 50, late[2]).answer()))
        for line in trace.lines:
            watching.feed(line)
        self.assertEqual([(one["due_ns"], one["kind"], one["explains_us"]) for one in have],
                         [(5_201_000_000, "thread", 150), (5_251_000_000, "wait", 300)])

    def test_a_period_is_found_between_other_timers(self):
        chosen = random.Random(3)
        deadlines = []
        for k in range(20):
            deadlines += [k * 333_333] + [k * 333_333 + chosen.randrange(333_333) for _ in range(chosen.randrange(2))]
        self.assertEqual(period_of(deadlines), 333_333)

    def test_a_period_is_found_when_ticks_are_skipped(self):
        for seed in range(200):
            chosen = random.Random(seed)
            deadlines = [7_000_300]
            while len(deadlines) < 32:
                deadlines.append(deadlines[-1] + 1_000_000 * chosen.choice((1, 2, 3, 4, 4, 4, 4, 4, 5)))
            self.assertEqual(period_of(deadlines), 1_000_000, f"seed {seed}")

    def test_a_period_that_seemed_longer_is_corrected(self):
        trace, due_us = Trace(random.Random(0)), 5_004_000
        trace.thread = LOOP
        for k in range(300):
            trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={due_us}000 mode=ABS|HARD")
            trace.switch(IDLE)
            trace.spend(due_us + 3 - trace.us)
            trace.switch(LOOP)
            trace.spend(40)
            due_us += 4000 if k < 70 else 1000
        watching = LoopMonitor(50, 100, lambda *late: self.fail("none is late"))
        for line in trace.lines:
            watching.feed(line)
        self.assertEqual(watching.period_ns, 1_000_000)
        self.assertGreater(watching.ticks, 200)


class Reading(unittest.TestCase):
    def test_a_name_of_any_bytes_is_a_name(self):
        for comm in ("a b", "x-1 [000] d..", " prev_pid=7 ", "[LOST]", "", "é" * 15):
            event = parse(f"{comm:>16}-42      [003] d..h1..    12.000034: sched_switch: prev_comm={comm} prev_pid=42 "
                          f"prev_prio=9 prev_state=R+ ==> next_comm={comm} next_pid=7 next_prio=120")
            self.assertEqual((event.us, event.cpu, event.pid), (12_000_034, 3, 42), comm)
            before, state, after = switch_of(event.text)
            self.assertEqual((before.comm, before.pid, state, after.comm, after.pid), (comm, 42, "R+", comm, 7))

    def test_priorities_and_masks_are_the_kernels(self):
        self.assertEqual([priority_of(prio) for prio in (-1, 0, 19, 98, 99, 120, 100, 139, None)],
                         ["deadline", "real-time 99", "real-time 80", "real-time 1", "real-time 0", "nice 0", "nice -20",
                          "nice 19", "priority not seen"])
        self.assertEqual(mask_of(cpus_of("0-2,33")), "00000002,00000007")

    def test_says_what_is_missing_and_the_remedy(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            said = self.run_late(root)
            self.assertRegex(said.stderr, "no tactd runs; start it first")
            for process in (7, 8):
                task = root / f"proc/{process}/task/{process + 1}"
                task.mkdir(parents=True)
                (root / f"proc/{process}/comm").write_text("tactd\n")
                (task / "comm").write_text("tact-loop\n")
                (task / "status").write_text("Name:\ttact-loop\nCpus_allowed_list:\t3\n")
            (root / "proc/stat").write_text("cpu3 1 2 3 4 5 6 7 11 0\n")
            self.assertRegex(self.run_late(root).stderr, "2 loops run, of 7, 8; name one by --pid")
            self.assertEqual(find_loop(root, 8)[:3], (8, 9, {3}))
            self.assertRegex(self.run_late(root, "--pid", "7").stderr, "is not there, so no cause can be named; sudo mount")
            self.assertRegex(self.run_late(root, "--hwlat", "1").stderr, "hwlat would hold its CPU")
            self.assertEqual(Counters(root, 3).read()[0], None)
            with self.assertRaises(Wrong):
                find_loop(root, 12)

    def run_late(self, root, *options):
        run = subprocess.run([sys.executable, "-B", LATE / "tact-jitter-late", "--root", root, *options], capture_output=True,
                             text=True)
        self.assertEqual(run.returncode, 2)
        return run


if __name__ == "__main__":
    unittest.main()
