# SPDX-License-Identifier: Apache-2.0
"""The kernel's trace of the loop's CPU, in an instance of its own, which other tracing does not see; and what else is counted.

The events are those that every kernel with ftrace has. Those of osnoise are not needed: they are made of the same ones, and
before Linux 6.2 come with a thread that spins on the CPU.
"""
import collections
import errno
import os
import pathlib
import time

TRACING = "sys/kernel/tracing"
BUFFER_KB = 4096  # about a second of a busy CPU; it is read each 50 ms
SMI_COUNT = 0x34  # Intel SDM volume 4
NEEDED = ("sched/sched_switch", "timer/hrtimer_start")
Loop = collections.namedtuple("Loop", "process thread cpus program")


class Wrong(Exception):
    """A message: what, where, the remedy."""


def loops(root, process=None):
    """[(process, thread)] of all threads named tact-loop."""
    found = []
    for comm in pathlib.Path(root, "proc").glob(f"{process or '[0-9]*'}/task/[0-9]*/comm"):
        try:
            if comm.read_text(errors="replace") == "tact-loop\n":
                found.append((int(comm.parts[-4]), int(comm.parts[-2])))
        except (OSError, ValueError):
            pass  # gone meanwhile
    return sorted(found)


def find_loop(root, process=None):
    """The only one, or that of the process."""
    found = loops(root, process)
    if len(found) != 1:
        raise Wrong("no tactd runs; start it first" if not found else
                    f"{len(found)} loops run, of {', '.join(str(one) for one, _ in found)}; name one by --pid")
    of, thread = found[0]
    status = pathlib.Path(root, f"proc/{of}/task/{thread}/status").read_text(errors="replace")
    allowed = next(line.split()[1] for line in status.splitlines() if line.startswith("Cpus_allowed_list:"))
    return Loop(of, thread, cpus_of(allowed), pathlib.Path(root, f"proc/{of}/comm").read_text(errors="replace").strip())


def cpus_of(listed):
    """{1, 2, 3, 8} of 1-3,8"""
    out = set()
    for part in listed.split(","):
        low, _, high = part.partition("-")
        out.update(range(int(low), int(high or low) + 1))
    return out


def mask_of(cpus):
    """As the kernel reads it: hexadecimal, 32 CPUs a word."""
    bits = sum(1 << cpu for cpu in cpus)
    words = []
    while bits or not words:
        words.append(f"{bits & 0xffffffff:08x}")
        bits >>= 32
    return ",".join(reversed(words))


class Instance:
    """A trace of its own, of these CPUs or all, gone with `close`. `filters` {event: filter or ""}."""

    def __init__(self, root, name, filters, cpus=None):
        tracing = pathlib.Path(root, TRACING)
        self.folder, self.pipe, self.part, self.missing = tracing / f"instances/{name}-{os.getpid()}", None, "", []
        self.remove_old(tracing, name)
        try:
            self.folder.mkdir()
        except OSError as error:
            raise Wrong(refusal(tracing, error)) from None
        try:
            self.set_up(filters, cpus)
        except OSError as error:
            self.close()
            raise Wrong(refusal(pathlib.Path(error.filename or self.folder), error)) from None
        except Wrong:
            self.close()
            raise

    def set_up(self, filters, cpus):
        for name, value in (("tracing_on", "0"), ("trace_clock", "mono"), ("buffer_size_kb", str(BUFFER_KB if cpus else 512))):
            self.write(name, value)
        if cpus:
            self.write("tracing_cpumask", mask_of(cpus))
            filters = {**filters, **self.vectors()}
        for event, text in filters.items():
            if (self.folder / "events" / event).is_dir():
                if text:
                    self.write(f"events/{event}/filter", text)
                self.write(f"events/{event}/enable", "1")
            elif event in NEEDED:
                raise Wrong(f"this kernel has no trace event {event}, which shows the loop's wake-up; take Debian's kernel")
            else:
                self.missing.append(event)
        self.pipe = os.open(self.folder / "trace_pipe", os.O_RDONLY | os.O_NONBLOCK)
        self.write("tracing_on", "1")

    def vectors(self):
        """Interrupts that are no device's: local timer, call from another CPU, ..."""
        return {f"irq_vectors/{one.name}": "" for one in (self.folder / "events/irq_vectors").glob("*_e[nx]*")
                if one.name.endswith(("_entry", "_exit"))}

    def write(self, name, value):
        (self.folder / name).write_text(value)

    @staticmethod
    def remove_old(tracing, name):
        """Of a run that was killed."""
        for old in tracing.glob(f"instances/{name}-[0-9]*"):
            if not pathlib.Path("/proc", old.name.rpartition("-")[2]).exists():
                try:
                    old.rmdir()
                except OSError:
                    pass  # another user's, or in use

    def lines(self):
        """Whole lines that have come, without waiting: a reader that waits is woken by interrupts of the CPU it watches."""
        while True:
            try:
                data = os.read(self.pipe, 65536)
            except OSError as error:
                if error.errno not in (errno.EAGAIN, errno.EINTR):
                    raise
                return
            if not data:
                return
            *whole, self.part = (self.part + data.decode("latin-1")).split("\n")  # a byte is a column
            yield from whole

    def close(self):
        if self.pipe is not None:
            os.close(self.pipe)
            self.pipe = None
        try:
            self.folder.rmdir()
        except OSError:
            pass


def refusal(path, error):
    if error.errno == errno.ENOENT:
        return f"{path}: is not there, so no cause can be named; sudo mount -t tracefs tracefs /sys/kernel/tracing, on the host"
    if error.errno in (errno.EACCES, errno.EPERM):
        locked = pathlib.Path("/sys/kernel/security/lockdown")
        if os.geteuid() == 0 and locked.exists() and "[none]" not in locked.read_text():
            return f"{path}: the kernel is locked down (Secure Boot), so no cause can be named; boot without Secure Boot"
        return f"{path}: {error.strerror}, so no cause can be named; run it by sudo, in a container on the host"
    return f"{path}: {error.strerror}; is tracefs mounted there, and its kernel one with ftrace?"


def trace_loop(root, loop):
    """(what any CPU does to the loop: its timer may be another's; all that runs on its own). In that order, so that each tick
    has its wake-up."""
    of_loop = f"common_pid == {loop.thread}"
    here = {"sched/sched_switch": "", "timer/hrtimer_start": of_loop, "timer/hrtimer_expire_entry": "",
            "timer/hrtimer_expire_exit": "", "irq/irq_handler_entry": "", "irq/irq_handler_exit": "", "irq/softirq_entry": "",
            "irq/softirq_exit": "", "nmi/nmi_handler": "", "power/cpu_idle": "", "exceptions/page_fault_user": of_loop,
            "exceptions/page_fault_kernel": of_loop}
    anywhere = {"sched/sched_waking": f"pid == {loop.thread}",
                "power/cpu_frequency": " || ".join(f"cpu_id == {cpu}" for cpu in sorted(loop.cpus))}
    first = Instance(root, "tact-late-any", anywhere)
    try:
        return first, Instance(root, "tact-late", here, loop.cpus)
    except Wrong:
        first.close()
        raise


class Counters:
    """SMIs and time taken by a hypervisor, of the loop's CPU, since the last call."""

    def __init__(self, root, cpu):
        self.root, self.cpu = root, cpu
        self.last = self.read()

    def read(self):
        smi = None
        try:
            msr = os.open(pathlib.Path(self.root, f"dev/cpu/{self.cpu}/msr"), os.O_RDONLY)
            try:
                smi = int.from_bytes(os.pread(msr, 8, SMI_COUNT)[:4], "little")
            finally:
                os.close(msr)
        except OSError:
            pass  # no module msr, or another CPU than Intel's
        stat = pathlib.Path(self.root, "proc/stat").read_text()
        words = next((line.split() for line in stat.splitlines() if line.startswith(f"cpu{self.cpu} ")), [])
        steal_ms = int(words[8]) * 1000 // os.sysconf("SC_CLK_TCK") if len(words) > 8 else 0
        return smi, steal_ms

    def since(self):
        before, self.last = self.last, self.read()
        smi = None if None in (before[0], self.last[0]) else self.last[0] - before[0]
        return smi, self.last[1] - before[1]


def sleep_latencies(root, cpu):
    """us to wake from each sleep state, as the kernel knows them."""
    folder, out = pathlib.Path(root, f"sys/devices/system/cpu/cpu{cpu}/cpuidle"), []
    while (folder / f"state{len(out)}/latency").exists():
        out.append(int((folder / f"state{len(out)}/latency").read_text()))
    return out


def run_hwlat(root, seconds, threshold_us):
    """Lines of the kernel's hwlat tracer: it holds a CPU with interrupts off, and looks for gaps in the clock."""
    folder = pathlib.Path(root, TRACING, f"instances/tact-hwlat-{os.getpid()}")
    threshold = pathlib.Path(root, TRACING, "tracing_thresh")
    try:
        before = threshold.read_text()
        folder.mkdir()
    except OSError as error:
        raise Wrong(refusal(pathlib.Path(root, TRACING), error)) from None
    try:
        if "hwlat" not in (folder / "available_tracers").read_text().split():
            raise Wrong("this kernel has no tracer hwlat; take Debian's own kernel, which has it")
        threshold.write_text(str(threshold_us))
        (folder / "current_tracer").write_text("hwlat")
        time.sleep(seconds)
        (folder / "tracing_on").write_text("0")
        return [line for line in (folder / "trace").read_text().splitlines() if "inner/outer" in line]
    finally:
        (folder / "current_tracer").write_text("nop")
        threshold.write_text(before)
        folder.rmdir()
