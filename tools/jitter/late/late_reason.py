# SPDX-License-Identifier: Apache-2.0
"""Who made a tick late: the loop's deadlines found in its trace, and what ran between a deadline and the end of its tick.

Late is: the wake-up after the deadline, what others took while the tick ran, and own code and own waiting beyond their usual
time. Who has the largest part is named, if it is half or more; else it is not known.
"""
import collections
import math

from late_trace import IDLE_ENDS, LOST, Timeline, fields, number_in, parse, priority_of, switch_of

MOST_LINES = 50_000  # of one tick: what is more is not kept
LEARNED = 64  # ticks that the usual duration is the median of
MIN_PART = 0.5
SHORTEST_NS = 50_000  # period of a loop
# usual_wait_us: that its own calls wait for a device
Tick = collections.namedtuple("Tick", "due_us woke_us end_us cpu skipped usual_wait_us", defaults=(0.0,))
Evidence = collections.namedtuple("Evidence", "smi steal_ms", defaults=(None, 0))  # counted meanwhile; None: not readable
KINDS = {"interrupt": "interrupt {name}", "nmi": "NMI {name}", "softirq": "softirq {name}", "thread": "thread {name}",
         "page fault": "page fault", "frequency change": "frequency change", "sleep state": "sleep state {name} of the CPU",
         "no software": "no software", "another CPU": "CPU {name}",
         "wait": "a call of the loop that waits", "own code": "the loop's own code, or a stall in it",
         "not known": "not known"}


class Reason:
    """One late tick, with parts {(kind, name, pid): us}."""

    def __init__(self, tick, usual_us):
        self.tick, self.usual_us = tick, usual_us
        self.parts, self.about, self.timers = collections.Counter(), {}, {}
        self.why, self.waking_us, self.slices = "", tick.woke_us, []  # why: nothing can be known

    def charge(self, us, kind, name="", pid=0, timer="", **about):
        if us > 0:
            self.parts[kind, name, pid] += us
            self.about.setdefault((kind, name, pid), {}).update(
                {key: value for key, value in about.items() if value not in ("", None)})
            if timer:
                self.timers.setdefault((kind, name, pid), collections.Counter())[timer] += us

    @property
    def late_us(self):
        return sum(self.parts.values())

    def answer(self):
        """What is printed and kept of it."""
        late_us, ranking = self.late_us, self.parts.most_common()
        key = ranking[0][0] if ranking and ranking[0][1] >= MIN_PART * late_us and not self.why else ("not known", "", 0)
        us = self.parts.get(key, 0.0)
        out = {"due_ns": round(self.tick.due_us * 1000), "wake_up_us": round(self.tick.woke_us - self.tick.due_us, 1),
               "late_us": round(late_us, 1), "skipped": self.tick.skipped, "kind": key[0],
               "name": KINDS[key[0]].format(name=key[1]), "pid": key[2] or None, **self.about.get(key, {}),
               "explains_us": round(us, 1), "explains": round(us / late_us, 3) if late_us else 0.0}
        if key[0] in ("interrupt", "nmi", "softirq", "thread"):
            out["duration_us"] = round(self.episode_us(key), 1)
        if key in self.timers:
            out["timer"] = max(self.timers[key], key=self.timers[key].get)
        if self.why:
            out["why"] = self.why
        out["others"] = [{"kind": kind, "name": KINDS[kind].format(name=name), "us": round(part_us, 1)}
                         for (kind, name, pid), part_us in ranking if (kind, name, pid) != key][:3]
        return out

    def episode_us(self, key):
        """How long it ran: before the deadline, too, without a pause but for interrupts."""
        first = next((k for k, one in enumerate(self.slices) if one.end_us > self.tick.due_us and key_of(one) == key), 0)
        while first > 0 and (key_of(self.slices[first - 1]) == key or self.slices[first - 1].kind in ("interrupt", "nmi")):
            first -= 1
        return sum(one.end_us - one.start_us for one in self.slices[first:] if key_of(one) == key)


def key_of(one):
    return one.kind, one.name, one.thread.pid if one.kind in ("softirq", "thread") else 0


def explain(lines, tick, loop_pid, usual_us=0.0, evidence=Evidence(), latency_us=(), anywhere=()):
    """A Reason. `lines`: from a period before the deadline to the end of the tick, None where some were lost; `latency_us`:
    of the CPU's sleep states; `anywhere`: lines of other CPUs, as when they wake the loop."""
    reason, timeline, events = Reason(tick, usual_us), Timeline(), []
    for line in lines:
        event = parse(line) if line is not None else None
        if line is None:
            reason.why = "events were lost: another tracer, or a buffer too small"
            timeline.lost()
        elif event is not None:
            events.append(event)
            if event.cpu == tick.cpu:
                timeline.add(event)
    reason.slices = timeline.slices
    events = sorted(events + [event for event in map(parse, anywhere) if event], key=lambda event: event.us)
    wakings = [event for event in events if event.name == "sched_waking" and fields(event.text).get("pid") == str(loop_pid)]
    waking = next((event for event in wakings if tick.due_us - 1 <= event.us <= tick.woke_us), None)
    reason.waking_us = waking.us if waking else tick.woke_us
    if waking is None and tick.woke_us > tick.due_us + 1:
        reason.why = reason.why or "the wake-up of the loop was not seen"  # was the interrupt late, or the loop after it?
    charge_wake_up(reason, loop_pid, waking.cpu if waking else tick.cpu, sleep_state(events, tick), latency_us)
    charge_run(reason, events, loop_pid, [event.us for event in wakings], evidence)
    return reason


def clipped(slices, start_us, end_us):
    for one in slices:
        if one.end_us > start_us and one.start_us < end_us:
            yield one._replace(start_us=max(one.start_us, start_us), end_us=min(one.end_us, end_us))


def charge_slice(reason, one):
    if one.kind in ("softirq", "thread"):
        reason.charge(one.end_us - one.start_us, one.kind, one.name, one.thread.pid, priority=priority_of(one.thread.prio),
                      thread=one.thread.comm if one.kind == "softirq" else "", timer=one.detail)
    else:
        reason.charge(one.end_us - one.start_us, one.kind, one.name, timer=one.detail)


def charge_wake_up(reason, loop_pid, timer_cpu, state, latency_us):
    """No thread can hold up the timer's interrupt, so what lies before it is another interrupt or no software."""
    tick = reason.tick
    silent_us, beside = 0.0, ""
    for one in clipped(reason.slices, tick.due_us, tick.woke_us):
        if one.kind in ("interrupt", "nmi"):
            charge_slice(reason, one)
            continue
        before_us = min(one.end_us, reason.waking_us) - one.start_us
        if before_us > 0:
            silent_us += before_us
            beside = beside or ("the CPU was idle" if one.thread.pid == 0 else f"{one.name} ran")
        if one.thread.pid == loop_pid or one.thread.pid == 0:  # the switch itself
            reason.charge(one.end_us - max(one.start_us, reason.waking_us), "own code")
        else:
            charge_slice(reason, one._replace(start_us=max(one.start_us, reason.waking_us)))
    if timer_cpu != tick.cpu:
        reason.charge(silent_us, "another CPU", str(timer_cpu), meaning="the loop's timer was its own, and came late")
    elif state is not None and 0 <= state < len(latency_us) and silent_us <= 2 * latency_us[state] + 5:
        reason.charge(silent_us, "sleep state", str(state), wakes_in_us=latency_us[state])
    else:
        reason.charge(silent_us, "no software", meaning="SMI, hypervisor, or interrupts held off", meanwhile=beside)


def sleep_state(events, tick):
    """That the CPU was in at the deadline; None: it was awake, or the kernel does not say."""
    state = None
    for event in events:
        if event.name == "cpu_idle" and event.us <= tick.due_us:
            if number_in(event.text, "cpu_id") == tick.cpu:
                state = number_in(event.text, "state")
    return None if state == IDLE_ENDS else state


def charge_run(reason, events, loop_pid, wakings, evidence):
    tick = reason.tick
    in_run = [event for event in events if tick.woke_us <= event.us < tick.end_us]
    own_us = wait_us = 0.0
    asleep = list(sleeps(in_run, loop_pid, wakings))
    for one in clipped(reason.slices, tick.woke_us, tick.end_us):
        if one.kind == "thread" and one.thread.pid == loop_pid:
            own_us += one.end_us - one.start_us
            continue
        waits_us = sum(max(0, min(one.end_us, end) - max(one.start_us, start)) for start, end in asleep)
        if one.kind == "thread" and one.thread.pid == 0:  # woken, but not yet out of its sleep state
            waits_us = one.end_us - one.start_us
        wait_us += waits_us
        charge_slice(reason, one._replace(start_us=min(one.start_us + waits_us, one.end_us)))
    over_us, wait_us = max(0.0, own_us - reason.usual_us), max(0.0, wait_us - tick.usual_wait_us)
    faults = [event for event in in_run if event.name.startswith("page_fault_") and event.pid == loop_pid]
    changes = [event for event in events if event.name == "cpu_frequency" and fields(event.text).get("cpu_id") == str(tick.cpu)]
    if faults:
        reason.charge(over_us + wait_us, "page fault", faults=len(faults), address=fields(faults[-1].text).get("address"),
                      code_at=fields(faults[-1].text).get("ip"))
        return
    reason.charge(wait_us, "wait")
    if changes:
        reason.charge(over_us, "frequency change", kHz=number_in(changes[-1].text, "state"))
    elif evidence.smi or evidence.steal_ms:
        reason.charge(over_us, "no software", meaning=f"SMI {evidence.smi or 0}, hypervisor {evidence.steal_ms} ms, as counted")
    else:
        reason.charge(over_us, "own code")


def sleeps(events, loop_pid, wakings):
    """(start, end) in the tick in which the loop waits: it left the CPU by itself, and nothing has woken it yet."""
    for event in events:
        switch = switch_of(event.text) if event.name == "sched_switch" else None
        if switch and switch[0].pid == loop_pid and not switch[1].startswith("R"):
            yield event.us, next((us for us in wakings if us >= event.us), float("inf"))


class LoopMonitor:
    """Lines of a trace in; calls late(lines, tick, usual_us) for each tick that is late by more than the threshold, with None
    for lines that were lost. Keeps the lines of two ticks alone."""

    def __init__(self, pid, threshold_us, late, period_ns=None):
        self.pid, self.threshold_us, self.late, self.period_ns = pid, threshold_us, late, period_ns
        self.before, self.lines, self.ticks = [], [], 0
        self.due_ns = self.next_ns = self.woke = self.armed = None  # the last two are Events
        self.newest, self.armings = collections.deque(maxlen=32), 0
        self.runs, self.rate_ns = collections.deque(maxlen=LEARNED), period_ns
        self.usual_us, self.usual_wait_us = None, 0.0
        self.left_us, self.away_us = None, 0.0  # in this tick, by itself
        self.comes, self.goes = f" next_pid={pid} ", f" prev_pid={pid} "

    def feed(self, line):
        if len(self.lines) == MOST_LINES:
            self.before, self.lines = [], [None]
        if "LOST" in line and LOST.match(line):
            self.lines.append(None)
            return
        self.lines.append(line)
        if " sched_switch: " in line:
            if self.comes in line:
                self.comes_back(line)
            elif self.goes in line and (self.woke or self.next_ns) is not None:
                self.leaves(line)
        elif " hrtimer_start: " in line and "function=hrtimer_wakeup" in line:
            self.arms(line)

    def arms(self, line):
        event = parse(line)
        expires_ns = number_in(event.text, "expires") if event and event.pid == self.pid else None
        if expires_ns is None:
            return
        self.newest.append(expires_ns)
        self.armings += 1
        known = self.due_ns is not None
        if not known or self.armings % LEARNED == 0:
            self.learn()
        if not known:
            return
        off_ns = (expires_ns - self.due_ns) % self.period_ns
        if min(off_ns, self.period_ns - off_ns) > 1000:  # of a call that waits, not of the grid
            return
        if self.next_ns not in (None, expires_ns):  # the tick was so long that its sleep ended before it began
            self.end_tick(self.armed)
            self.due_ns = self.next_ns
            self.woke = self.armed._replace(us=max(self.armed.us, self.due_ns // 1000))
        self.next_ns, self.armed = expires_ns, event

    def learn(self):
        """The grid, and again: where ticks were skipped all the time, its period seemed to be a multiple."""
        if len(self.newest) < self.newest.maxlen:
            return
        period_ns = self.rate_ns or period_of(self.newest)
        if self.due_ns is None or period_ns != self.period_ns:
            self.period_ns, self.due_ns, self.next_ns, self.woke = period_ns, newest_of_grid(self.newest, period_ns), None, None

    def comes_back(self, line):
        event = parse(line)
        if event and self.left_us is not None:
            self.away_us, self.left_us = self.away_us + event.us - self.left_us, None
        if self.woke is None and self.due_ns is not None and event and event.us * 1000 >= self.due_ns - 1000:
            self.woke = event

    def leaves(self, line):
        event = parse(line)
        switch = switch_of(event.text) if event else None
        if switch is None or switch[1].startswith("R"):  # another takes the CPU
            return
        if self.next_ns is None:  # a call that waits
            self.left_us = event.us
            return
        self.end_tick(event)
        self.due_ns, self.next_ns, self.woke = self.next_ns, None, None
        self.left_us, self.away_us = None, 0.0
        self.before, self.lines = self.lines, []

    def end_tick(self, event):
        if self.woke is None or self.next_ns <= self.due_ns:
            return
        skipped = round((self.next_ns - self.due_ns) / self.period_ns) - 1
        run_us, away_us = event.us - self.woke.us, self.away_us
        usual_us = run_us if self.usual_us is None else self.usual_us
        tick = Tick(self.due_ns / 1000, self.woke.us, event.us, self.woke.cpu, skipped, self.usual_wait_us)
        self.ticks += 1
        if tick.woke_us - tick.due_us + max(0.0, run_us - usual_us - self.usual_wait_us) > self.threshold_us:
            self.late(self.before + self.lines, tick, usual_us)
        self.runs.append((run_us - away_us, away_us))
        if self.usual_us is None and len(self.runs) == LEARNED or self.ticks % LEARNED == 0:
            self.usual_us, self.usual_wait_us = (sorted(part)[len(self.runs) // 2] for part in zip(*self.runs))


def period_of(deadlines_ns):
    """Of a grid with gaps; with other timers in between the longest distance that occurs twice and on whose grid most lie."""
    common = math.gcd(*(one - deadlines_ns[0] for one in deadlines_ns))
    if common >= SHORTEST_NS:
        return common
    distances = collections.Counter(
        later - one for lag in (1, 2, 3) for one, later in zip(deadlines_ns, list(deadlines_ns)[lag:]) if later > one)
    often = [ns for ns, times in distances.items() if times > 1] or [1]
    return max(often, key=lambda ns: (max(collections.Counter(one % ns for one in deadlines_ns).values()), ns))


def newest_of_grid(deadlines_ns, period_ns):
    phases = collections.Counter(one % period_ns for one in deadlines_ns)
    phase_ns = max(phases, key=phases.get)
    return max(one for one in deadlines_ns if one % period_ns == phase_ns)
