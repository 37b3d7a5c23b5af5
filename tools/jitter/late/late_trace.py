# SPDX-License-Identifier: Apache-2.0
"""From lines of ftrace to who had the CPU when: slices of time, each with the innermost context that ran.

Interrupts nest on the CPU; a softirq belongs to a thread, which PREEMPT_RT may switch out in the middle of it. Times are
CLOCK_MONOTONIC, us. Source: Documentation/trace/ftrace.rst and events.rst, include/trace/events/{irq,sched,timer,power}.h.
"""
import collections
import re

# comm is 16 columns wide and has 15 bytes at most: with any bytes in a name, the rest stays where it is.
LINE = re.compile(r"(.{16})-(\d+) +\[(\d+)\] (?:\S+ +)?(\d+)\.(\d{6}): (\w+): ?(.*)")
LOST = re.compile(r"CPU:\d+ \[LOST \d+ EVENTS\]")
SWITCH = re.compile(r"prev_comm=(.*) prev_pid=(\d+) prev_prio=(-?\d+) prev_state=(\S+) ==> "
                    r"next_comm=(.*) next_pid=(\d+) next_prio=(-?\d+)", re.DOTALL)
FIELD = re.compile(r"(\w+)=(\S+)")
NMI = re.compile(r"(\w+)\(\) delta_ns: (\d+)")
IDLE_ENDS = 4294967295

Event = collections.namedtuple("Event", "us cpu pid comm name text")
Thread = collections.namedtuple("Thread", "pid comm prio")  # prio: the kernel's; None: not seen yet
# kind: interrupt, nmi, softirq or thread. detail: of an interrupt the function of the timer that it runs.
Slice = collections.namedtuple("Slice", "start_us end_us kind name thread detail")


def parse(line):
    """An Event, or None for what is none: a header, a lost line, a name with a line feed."""
    found = LINE.match(line)
    if not found:
        return None
    comm, pid, cpu, seconds, micros, name, text = found.groups()
    return Event(int(seconds) * 1_000_000 + int(micros), int(cpu), int(pid), comm.strip(), name, text)


def fields(text):
    return dict(FIELD.findall(text))


def number_in(text, key):
    """None where it is garbled."""
    value = fields(text).get(key, "")
    return int(value) if value.isascii() and value.isdigit() else None


def switch_of(text):
    """(the thread that leaves, its state, the one that comes) of a sched_switch; None if it is garbled."""
    found = SWITCH.match(text)
    if not found:
        return None
    comm, pid, prio, state, next_comm, next_pid, next_prio = found.groups()
    return Thread(int(pid), comm, int(prio)), state, Thread(int(next_pid), next_comm, int(next_prio))


class Timeline:
    """Events of one CPU in the order of time become slices without gaps."""

    def __init__(self):
        self.slices = []
        self.interrupts, self.softirqs, self.timers = [], {}, []
        self.thread, self.at_us = None, None

    def lost(self):
        self.interrupts, self.softirqs, self.timers = [], {}, []

    def add(self, event):
        if self.thread is None or self.thread.pid != event.pid:  # the first, or after a loss
            self.thread = Thread(event.pid, event.comm, None)
        if self.at_us is not None and event.us > self.at_us:
            self.slices.append(Slice(self.at_us, event.us, *self.context()))
        self.at_us = max(event.us, self.at_us or 0)
        self.step(event)

    def context(self):
        """Who has the CPU now: kind, name, thread, detail."""
        timer = self.timers[-1] if self.timers else ""
        if self.interrupts:
            return "interrupt", self.interrupts[-1], self.thread, timer
        if self.softirqs.get(self.thread.pid):
            return "softirq", self.softirqs[self.thread.pid][-1], self.thread, timer
        return "thread", self.thread.comm, self.thread, ""

    def step(self, event):
        name, text = event.name, event.text
        if name == "sched_switch":
            switch = switch_of(text)
            if switch:
                self.interrupts, self.timers, self.thread = [], [], switch[2]
        elif name == "irq_handler_entry":
            irq, _, handler = text.partition(" name=")
            self.interrupts.append(f"{irq.removeprefix('irq=')} {handler}")
        elif name == "irq_handler_exit":
            self.leave(self.interrupts, fields(text).get("irq", "") + " ")
        elif name in ("softirq_entry", "softirq_exit"):
            of_thread = self.softirqs.setdefault(event.pid, [])
            action = text.partition("action=")[2].rstrip("]") or fields(text).get("vec", "?")
            if name.endswith("entry"):
                of_thread.append(action)
            else:
                self.leave(of_thread, action)
        elif name == "hrtimer_expire_entry":
            self.timers.append(fields(text).get("function", "?"))
        elif name == "hrtimer_expire_exit":
            del self.timers[-1:]
        elif name == "nmi_handler":
            self.relabel_nmi(text)
        elif name.endswith("_entry"):  # irq_vectors: local_timer, reschedule, call_function, irq_work, ...
            self.interrupts.append(name.removesuffix("_entry"))
        elif name.endswith("_exit"):
            self.leave(self.interrupts, name.removesuffix("_exit"))

    @staticmethod
    def leave(stack, beginning):
        """Out of the innermost with this name, and of what is above it: its own exit was lost."""
        for depth in range(len(stack) - 1, -1, -1):
            if stack[depth].startswith(beginning):
                del stack[depth:]
                return

    def relabel_nmi(self, text):
        """Reported at its end, with how long it took."""
        found = NMI.match(text)
        if not found or not self.slices:
            return
        last, since_us = self.slices[-1], self.at_us - int(found[2]) / 1000
        if last.end_us != self.at_us or since_us >= last.end_us:
            return
        self.slices.pop()
        if last.start_us < since_us:
            self.slices.append(last._replace(end_us=since_us))
        self.slices.append(Slice(max(last.start_us, since_us), self.at_us, "nmi", found[1], self.thread, ""))


def priority_of(prio):
    """As chrt and ps call it."""
    if prio is None:
        return "priority not seen"
    if prio < 0:
        return "deadline"
    return f"real-time {99 - prio}" if prio < 100 else f"nice {prio - 120}"
