# SPDX-License-Identifier: Apache-2.0
"""What must be true after a run: each check takes a Run and returns complaints, one sentence each."""
import functools
import json
import subprocess

from bench.back_ends import TORQUE_LIMIT_NM


def hard_real_time(run):
    """tactd took the kernel for what it is, and lost neither a tick nor a page nor a heap call."""
    report = run.report
    if not report:
        return ["tactd left no report: " + run.text("tactd.log")[-300:].strip()]
    wrong = []
    if report["non_rt"] or not report["environment"]["realtime_kernel"]:
        wrong.append(f"tactd found no hard real time: {report['shortfalls']}")
    for key in ("allocations", "minor_page_faults", "major_page_faults"):
        if report["thread"][key] != 0:
            wrong.append(f"{report['thread'][key]} {key.replace('_', ' ')} in the loop, not 0")
    return wrong


def no_late_tick(run):
    report = run.report
    late, skipped = report.get("late"), report.get("skipped")
    return [] if late == 0 and skipped == 0 else [f"{late} late ticks, {skipped} skipped, not 0"]


def no_fault(run):
    name = run.report.get("fault", {}).get("name")
    return [] if name == "none" and run.text("tactd.status").strip() == "0" else [
        f"fault '{name}', exit status {run.text('tactd.status').strip()}: nothing should have stopped it"]


def whole_run(run):
    """Every tick of the asked time took place and every record reached the log."""
    want = round(run.case.seconds * 1000)
    have, dropped = run.ticks.get("ticks", 0), run.report.get("dropped_records")
    return [] if have == want and dropped == 0 else [
        f"{have} of {want} ticks in the log, {dropped} records dropped"]


def touched(run):
    """A run without force proves nothing."""
    force_N = run.report.get("force_max_N", 0.0)
    return [] if force_N > 0.1 else [f"largest force {force_N:.3f} N: the tissue gave no force"]


def torque_at_its_limit(run):
    torque_Nm = run.report.get("torque_max_Nm", 0.0)
    return [] if abs(torque_Nm / TORQUE_LIMIT_NM - 1) < 1e-9 else [
        f"largest torque {torque_Nm:.9f} N m, not its limit of {TORQUE_LIMIT_NM}"]


class SameForcesAs:
    """The forces are those of the same scene in simulated time on the host, bit for bit."""

    root = build = None  # folders, set before the first run

    def __call__(self, run):
        want = self.reference(run.case.back_end.scene, run.case.settings, run.case.seconds)
        have = run.report.get("force_hash")
        return [] if have == want else [
            f"force hash {have}, but {want} in simulated time on the host: something moved a force"]

    @functools.cache
    def reference(self, scene, settings, seconds):
        options = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run(
            [self.build / "tactd", self.root / scene, *options, "--free-run", "--seconds",
             str(seconds), "--no-telemetry", "--json", "-"], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["force_hash"]


same_forces = SameForcesAs()


def threads_as_listed(run):
    """Every FIFO thread makes the listed system calls and no others, per tick; it takes no page fault,
    never changes its CPU, and leaves it for its own calls and those of its device's thread alone."""
    allowed = run.case.back_end.system_calls
    counts = run.threads
    ticks = counts.get(("tact-loop", "sys_clock_nanosleep"), 0)
    if ticks < 1000:
        return [f"the tracing saw {ticks} ticks of the loop: it proves nothing"]
    wrong = []
    for (thread, what), n in counts.items():
        if what.startswith("sys_"):
            most = allowed.get((thread, what), 0)
            if n > most * ticks * 1.001 + 2 * (most > 0):
                wrong.append(f"{thread} calls {what} {n / ticks:.3f} times a tick, {most} are listed")
        elif what == "switch":  # counted right after the calls, for about as long
            calls = sum(k for (_, call), k in counts.items() if call.startswith("sys_"))
            if thread == "tact-loop" and not 0.8 * ticks <= n <= 1.2 * calls:
                wrong.append(f"{thread} left the CPU {n} times in {ticks} ticks with {calls} calls")
        elif n != 0:
            wrong.append(f"{thread}: {n} times {what}, not 0")
    return wrong


def peer_undisturbed(limit_ns):
    """The other FIFO loop of this guest never woke later than limit_ns."""
    def check(run):
        totals = [line for line in run.text("peer.txt").splitlines() if line.startswith("# Max")]
        worst = int(totals[0].split()[-1]) if totals else None
        return [] if worst is not None and worst <= limit_ns else [
            f"a FIFO loop beside tactd woke {worst} ns late, {limit_ns} allowed"]
    return check


def permission_gone(run):
    """After a fault the enable line is low, as the chip itself says."""
    level = run.text("enable.txt").strip()
    return [] if level == "0" else [f"the enable line is '{level}' after the fault, not 0"]


def lines_alive(run):
    """Enable waits for 100 ms of heartbeat, and the heartbeat beats."""
    wrong = []
    if run.text("enable_early.txt").strip() != "0":
        wrong.append("enable was up before 100 ms of heartbeat")
    if run.text("enable.txt").strip() != "1":
        wrong.append("enable is not up")
    beats = run.text("heartbeat.txt").split()
    if len(beats) < 20 or not 0.2 < beats.count("1") / len(beats) < 0.8:
        wrong.append(f"no heartbeat: {''.join(beats)}")
    return wrong


def no_more_edges(run):
    beats = run.text("heartbeat.txt").split()
    return [] if len(beats) == 20 and len(set(beats)) == 1 else [
        f"the heartbeat went on after the end of tactd: {''.join(beats)}"]


def reported(*words):
    """The report says behind the fault what a person needs to know."""
    def check(run):
        trouble = run.report.get("fault", {}).get("trouble", "")
        return [f"'{word}' is not in '{trouble}'" for word in words if word not in trouble]
    return check


def let_go_within(limit_ms):
    """The motors had no torque so soon after the injection, and none since."""
    def check(run):
        zero_ns, since_ns = run.emulator.get("torque_zero_since_ns"), run.ticks.get("injected_ns", 0)
        if not zero_ns:
            return ["the motors kept their force, or never had one"]
        took_ms = (zero_ns - since_ns) / 1e6
        return [] if 0.0 < took_ms <= limit_ms else [
            f"the motors let go {took_ms:.1f} ms after the injection, bound {limit_ms} ms"]
    return check


def armed_again(run):
    """Stopped, and armed again by the last order alone, some 2.4 s before the end."""
    ticks = run.ticks
    wrong = []
    if (ticks.get("detected") or {}).get("fault") != "emergency stop":
        wrong.append(f"the e-stop was not seen: {ticks.get('detected')}")
    if ticks.get("end_state") != "armed":
        wrong.append(f"ended {ticks.get('end_state')}, not armed")
    if not 2000 < ticks.get("armed_ticks_after", 0) < 2450:
        wrong.append(f"armed for {ticks.get('armed_ticks_after')} ticks after the stop: too early or too late")
    return wrong


def proved(*words):
    """The harm was done: the script of the case has shown each of these."""
    def check(run):
        shown = run.text("proofs.txt").splitlines()
        return [f"not shown: {one}" for one in words if one not in shown]
    return check


MOST_TO_TAKE_APART_ms = 100.0


def pulled(run):
    """The foot switch closed the jaws for a while, and what they held pulled down as the hand lifted."""
    gripped, pull_N = run.ticks.get("gripped_ticks", 0), run.ticks.get("most_pull_N", 0.0)
    return [] if gripped > 100 and pull_N > 0.05 else [
        f"{gripped} ticks with closed jaws, at most {pull_N:.3f} N downwards: more than 100 and 0.05 N are due"]


def clutched(run):
    """One clutch, no contact lost; released inside the organ, the tool has no force until it has been outside."""
    wrong = [] if run.report.get("clutches") == 1 else [f"{run.report.get('clutches')} clutches, not 1"]
    wrong += [] if run.report.get("inside_ticks", 0) > 0 else ["the tool was never inside the organ"]
    zero = run.ticks.get("zero")
    return wrong + ([] if zero else ["the force came again after the clutch, or never went"])


def device_gone(run):
    """The kernel itself could take the device apart within 100 ms: no thread of ours starved it."""
    pulled_ns = (run.emulator.get("faults") or [{}])[0].get("injected_ns")
    gone_ns = run.text("unplugged.txt").strip()
    if not pulled_ns or not gone_ns:
        return ["the kernel still has the device at the end" if pulled_ns else "nothing was pulled"]
    took_ms = (int(gone_ns) - pulled_ns) / 1e6
    return [] if 0.0 < took_ms <= MOST_TO_TAKE_APART_ms else [
        f"the kernel had taken the device apart {took_ms:.0f} ms after it was pulled"]


def pressed_by_hand(run):
    """The other side of the bus agrees: the hand went into the tissue and got what was commanded."""
    drives, commanded_N = run.emulator, run.report.get("force_max_N", 0.0)
    wrong = []
    if drives.get("lowest_z_m", 1.0) > -0.005:
        wrong.append(f"the hand came down to z = {drives.get('lowest_z_m')} m only")
    if drives.get("largest_hand_force_N", 0.0) < 0.95 * commanded_N:
        wrong.append(f"tactd wrote up to {commanded_N:.3f} N, the motors made {drives.get('largest_hand_force_N')} N")
    if drives.get("watchdog_trips") != 0:
        wrong.append(f"{drives.get('watchdog_trips')} watchdogs tripped in a run without faults")
    return wrong


def refused(*words):
    """tactd left before its loop, with exit status 2 and a sentence that holds these words."""
    def check(run):
        said, status = run.text("tactd.log"), run.text("tactd.status").strip()
        wrong = [] if status == "2" else [f"exit status {status}, not 2"]
        return wrong + [f"'{word}' is not in: {said.strip()[-300:]}" for word in words if word not in said]
    return check


def frames_of(run):
    """What candump -L wrote: time in s, identifier, data in hexadecimal."""
    for line in run.text("candump.txt").splitlines():
        time, _, frame = line.split()
        identifier, _, data = frame.partition("#")
        yield float(time[1:-1]), int(identifier, 16), data


def per_second(frames, identifier):
    """By the median of the gaps: what comes once at the end does not count."""
    times = [time for time, sent, _ in frames if sent == identifier]
    gaps = sorted(after - before for before, after in zip(times, times[1:]))
    return 1.0 / gaps[len(gaps) // 2] if len(gaps) > 500 else 0.0


def about(rate, want):
    return 0.98 * want <= rate <= 1.02 * want


CLOSED_LOOP = "0800000000000000"


def bus_of_odrives(run):
    """Identifier = node << 5 | command: 1000 estimates and 1000 torques a second and axis, and closed
    loop (state 8) only after a torque of zero."""
    frames, wrong = list(frames_of(run)), []
    running = closed_loop_onwards(frames, 0x07, CLOSED_LOOP)
    for node in (1, 2, 3):
        for command, what in ((0x09, "estimates"), (0x0E, "torques")):
            rate = per_second(running, node << 5 | command)
            if not about(rate, 1000.0):
                wrong.append(f"{rate:.1f} {what} a second of node {node}, not 1000")
        of_node = [(identifier & 0x1F, data) for _, identifier, data in frames if identifier >> 5 == node]
        closed = of_node.index((0x07, CLOSED_LOOP)) if (0x07, CLOSED_LOOP) in of_node else None
        before = [data for command, data in of_node[:closed] if command == 0x0E]
        if closed is None or not before or set("".join(before)) != {"0"}:
            wrong.append(f"node {node} was closed without a torque of zero before: {before[-3:]}")
    return wrong


def closed_loop_onwards(frames, command, data):
    """The frames after the last axis was asked for closed loop, but for the last 50 ms of the run."""
    asked = [time for time, identifier, sent in frames if identifier & 0x1F == command and sent == data]
    last = max(time for time, identifier, _ in frames if identifier & 0x1F == 0x0E) if asked else 0.0
    return [frame for frame in frames if asked and asked[-1] + 0.2 < frame[0] < last - 0.05]


def bus_of_cia402(run):
    """One SYNC a millisecond, behind the commands of its tick; a state each, in order, with no torque."""
    frames, wrong = list(frames_of(run)), []
    enabled = next((time for time, _, data in frames if data[:4] == "0F00"), 0.0)
    running = [frame for frame in frames if frame[0] >= enabled]
    syncs = [time for time, identifier, _ in running if identifier == 0x080]
    if not about(per_second(running, 0x080), 1000.0):
        wrong.append(f"{len(syncs)} SYNC, {per_second(running, 0x080):.1f} a second, not 1000")
    for node in (1, 2, 3):
        commands = [data for _, identifier, data in frames if identifier == 0x200 + node]
        words = [data[:4] for data in commands]
        order = [word for i, word in enumerate(words) if i == 0 or word != words[i - 1]]
        if order[:3] != ["0600", "0700", "0F00"] and order[:4] != ["0000", "0600", "0700", "0F00"]:
            wrong.append(f"controlwords of node {node} in the order {order[:5]}")
        if any(data[4:8] != "0000" for data in commands if data[:4] != "0F00"):
            wrong.append(f"node {node} got a torque before it was enabled")
    order = [identifier for _, identifier, _ in running if identifier in (0x080, 0x201, 0x202, 0x203)]
    batches = sum(order[i:i + 4] == [0x201, 0x202, 0x203, 0x080] for i in range(len(order)))
    if batches < 0.99 * len(syncs):
        wrong.append(f"{batches} of {len(syncs)} SYNC came right behind the three commands")
    return wrong
