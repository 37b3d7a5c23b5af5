# SPDX-License-Identifier: Apache-2.0
"""Random traces of one CPU, and beside them who had each microsecond: what late_test.py holds the parts of a late tick against.

The count is by single microseconds and shares no code with tools/jitter/late.
"""
import collections

from late_reason import Tick

LOOP, IDLE = (50, "tact-loop", 19), (0, "swapper/0", 120)
OTHERS = ((60, "hog one", 9), (61, "ktimers/0", 98), (62, "a-1 [000] x", 120), (63, "kworker/0:1", 120))
PERIOD_US = 1000


class Trace:
    """Writes a trace of one CPU, and beside it who had each microsecond."""

    def __init__(self, chosen, at_us=5_000_000, thread=IDLE):
        self.random, self.us, self.thread = chosen, at_us, thread
        self.lines, self.owner, self.softirqs, self.interrupts = [], {}, collections.defaultdict(list), []
        self.few = chosen.sample((IDLE, *OTHERS), chosen.choice((1, 1, 2, 4)))
        self.often = chosen.choice((0.0, 0.01, 0.03, 0.2))  # interrupts
        self.soft = chosen.choice((0.02, 0.5))  # beginnings of softirqs

    def say(self, event, text):
        pid, comm, _ = self.thread
        self.lines.append(f"{comm:>16}-{pid:<7} [000] d..h1.. {self.us // 10**6:5}.{self.us % 10**6:06}: {event}: {text}")

    def spend(self, us):
        label = (("interrupt", self.interrupts[-1], 0) if self.interrupts else
                 ("softirq", self.softirqs[self.thread[0]][-1], self.thread[0]) if self.softirqs[self.thread[0]] else
                 ("thread", self.thread[1], self.thread[0]))
        for k in range(us):
            self.owner[self.us + k] = label
        self.us += us

    def switch(self, to, state="S"):
        pid, comm, prio = self.thread
        self.say("sched_switch", f"prev_comm={comm} prev_pid={pid} prev_prio={prio} prev_state={state} ==> "
                                 f"next_comm={to[1]} next_pid={to[0]} next_prio={to[2]}")
        self.thread = to

    def interrupt(self, inside=None, depth=0):
        number = self.random.randrange(10, 13)
        device = depth > 0 or self.random.random() < 0.5
        name = f"{number} dev ice{number}" if device else "local_timer"
        self.say("irq_handler_entry" if device else "local_timer_entry",
                 f"irq={number} name=dev ice{number}" if device else "vector=236")
        self.interrupts.append(name)
        self.spend(self.random.randrange(0, self.random.choice((5, 5, 30, 500))))
        if not device:
            self.say("hrtimer_expire_entry", "hrtimer=00ff function=tick_sched_timer now=1")
            self.spend(self.random.randrange(0, 30))
            self.say("hrtimer_expire_exit", "hrtimer=00ff")
        if inside:
            inside()
        if depth == 0 and self.random.random() < 0.2:
            self.interrupt(depth=1)
        self.spend(self.random.randrange(0, 10))
        self.say("irq_handler_exit" if device else "local_timer_exit", f"irq={number} ret=handled" if device else "vector=236")
        self.interrupts.pop()

    def work(self, us):
        """Of the thread that has the CPU, with interrupts and softirqs."""
        end_us = self.us + us
        while self.us < end_us:
            act, softirqs = self.random.random(), self.softirqs[self.thread[0]]
            if act < self.often:
                self.interrupt()
            elif act < self.often + self.soft and self.thread[0] and not softirqs:
                softirqs.append(self.random.choice(("NET_RX", "TIMER")))
                self.say("softirq_entry", f"vec=3 [action={softirqs[-1]}]")
            elif act < self.often + 0.04 and softirqs:
                self.say("softirq_exit", f"vec=3 [action={softirqs.pop()}]")
            else:
                self.spend(self.random.randrange(1, 40))

    def others(self, us):
        """Threads that are not the loop."""
        end_us = self.us + us
        while self.us < end_us:
            self.switch(self.random.choice(self.few), "R")
            self.work(self.random.randrange(1, 120))

    def wake_loop(self):
        out = []

        def waking():
            self.say("sched_waking", "comm=tact-loop pid=50 prio=19 target_cpu=000")
            out.append(self.us)
        self.interrupt(waking)
        return out[0]


def random_tick(chosen):
    """A trace, its Tick, and the parts of its lateness, by each microsecond."""
    trace = Trace(chosen)
    trace.others(200)
    due_us = trace.us + chosen.randrange(0, 60)
    trace.others(due_us - trace.us + chosen.randrange(0, 300))
    waking_us = trace.wake_loop()
    if chosen.random() < 0.5:
        trace.others(chosen.randrange(1, 900))
    trace.switch(LOOP, "R+")
    woke_us, asleep = trace.us, []
    for _ in range(chosen.randrange(1, 4)):
        trace.work(chosen.randrange(1, 100))
        act = chosen.random()
        if act < 0.3:  # a higher thread takes the CPU
            trace.switch(OTHERS[0], "R")
            trace.work(chosen.randrange(1, 100))
            trace.switch(LOOP, "S")
        elif act < 0.5:  # it waits for a device
            start_us = trace.us
            trace.switch(IDLE, "D")
            trace.others(chosen.randrange(1, 600))
            asleep.append((start_us, trace.wake_loop()))
            trace.others(chosen.randrange(1, 30))
            trace.switch(LOOP, "R")
    trace.say("hrtimer_start", f"hrtimer=1 function=hrtimer_wakeup expires={(due_us + 1000) * 1000}")
    tick = Tick(due_us, woke_us, trace.us, 0, 0, chosen.choice((0, 0, 50)))
    trace.switch(IDLE)
    usual_us = chosen.randrange(0, 120)
    parts, own_us, wait_us = collections.Counter(), 0, 0
    for us in range(due_us, trace.us):
        owner = trace.owner[us]
        if us < woke_us:
            if owner[0] == "interrupt":
                parts[owner] += 1
            elif us < waking_us:
                parts["no software", "", 0] += 1
            else:
                parts[("own code", "", 0) if owner[0] == "thread" and owner[2] in (0, 50) else owner] += 1
        elif owner == ("thread", "tact-loop", 50):
            own_us += 1
        elif any(start <= us < end for start, end in asleep) or owner[2] == 0 and owner[0] == "thread":
            wait_us += 1
        else:
            parts[owner] += 1
    parts["own code", "", 0] += max(0, own_us - usual_us)
    parts["wait", "", 0] += max(0, wait_us - tick.usual_wait_us)
    return trace, tick, usual_us, +parts
