#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each n-th system call of tactd, tactctl and tact-view fails once: no abort, no hang, no silent end, the force is off.

    python3 tests/system/failing_calls.py BUILD_DIR     (tactd, tactctl, tact-view, libtact-stub-dhd.so)

The n-th call of a start fails, and then that of 200 armed ticks with a fault and its black box. Of a call that is made
more often than MOST times, so many are tried, spread; TACT_EXTENT=long tries all. About 60 s. Prints each breach, then
"N passed, M failed"; exit status 0 or 1.
"""
import collections
import concurrent.futures
import contextlib
import functools
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from failing_call import Supervisor

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build").resolve()
SCENE = ROOT / "model/scenes/skin.toml"
IS_LONG = os.environ.get("TACT_EXTENT") == "long"
MOST, PROCESSES, LIMIT_S = 1000 if IS_LONG else 7, 8, 20
# What fails, and how.
ERRORS = dict(openat="EMFILE", read="EIO", write="ENOSPC", fsync="EIO", socket="EMFILE", bind="EADDRINUSE", listen="EIO",
              accept4="EMFILE", connect="ECONNREFUSED", sendto="ENOBUFS", recvfrom="ECONNRESET", sendmsg="ENOBUFS",
              recvmsg="ECONNRESET", mmap="ENOMEM", mprotect="ENOMEM", munmap="ENOMEM", clone3="EAGAIN",
              memfd_create="EMFILE", ftruncate="ENOSPC", rename="EACCES", unlink="EACCES", mkdir="EACCES", chmod="EPERM",
              fchmod="EPERM", newfstatat="EACCES", getdents64="EIO", lseek="EIO", ioctl="EIO", fcntl="EMFILE",
              eventfd2="EMFILE", signalfd4="EMFILE", timerfd_create="EMFILE", epoll_create1="EMFILE", epoll_ctl="ENOSPC",
              pipe2="EMFILE", prlimit64="EPERM", prctl="EPERM", mlockall="ENOMEM", sched_setaffinity="EPERM",
              sched_setscheduler="EPERM", getrandom="EAGAIN", statx="EACCES", ppoll="EINTR",
              madvise="EINVAL", sendmmsg="ENOBUFS")
LIBRARY_WORDS = re.compile(r"terminate called|std::|\*\*\* |what\(\)|Assertion|Segmentation")
Outcome = collections.namedtuple("Outcome", "status text device")


def breach(outcome, usual):
    """What is wrong with an end, or nothing. `usual`: what the program says when no call fails."""
    if outcome.status is None:
        return f"hangs for {LIMIT_S} s"
    if outcome.status == 127 and "error while loading shared libraries" in outcome.text:
        return ""  # by the loader, before main()
    if outcome.status not in (0, 1, 2):
        return f"ends with status {outcome.status}"
    if outcome.status != 0 and not set(outcome.text.splitlines()) - usual:
        return f"ends with status {outcome.status} and no word"
    if found := LIBRARY_WORDS.search(outcome.text):
        return f"says {found.group()!r}"
    regular = outcome.device or "limits " not in outcome.text or "does not come back" in outcome.text
    if "force on" in outcome.device or not regular:
        return "the device is left with its force on"
    return ""


class Program:
    """One of the programs in a folder of its own, under a supervisor or none."""

    def __init__(self, folder, supervisor, name, *arguments):
        self.folder, (read, write) = folder, os.pipe()
        self.device = os.fdopen(read)
        with open(folder / "text", "w") as text:
            self.process = subprocess.Popen(
                [BUILD / name, *map(str, arguments)], stdout=text, stderr=text, stdin=subprocess.DEVNULL, cwd=folder,
                pass_fds=[write], preexec_fn=supervisor.enter if supervisor else None,
                env=dict(os.environ, XDG_RUNTIME_DIR=str(folder), XDG_STATE_HOME=str(folder), TACT_STUB_DHD_END=str(write),
                         TACT_STUB_DHD_NO_WATCHDOG="1",
                         OPENBLAS_NUM_THREADS="1"))  # its threads would end the program before main() where one is refused
        os.close(write)

    def text(self):
        return (self.folder / "text").read_text(errors="replace")

    def wait_for(self, words, longest_s=10):
        until_s = time.monotonic() + longest_s
        while words not in self.text() and self.process.poll() is None and time.monotonic() < until_s:
            time.sleep(0.01)
        return words in self.text()

    def signal(self, number):
        with contextlib.suppress(ProcessLookupError):
            self.process.send_signal(number)

    def end(self):
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(LIMIT_S)
        status = self.process.poll()
        self.process.kill()
        self.process.wait()
        with self.device as device:
            return Outcome(status, self.text(), device.read() if status is not None else "")


TACTD = ("tactd", SCENE, "--seconds", "5", "--no-seccomp", "--trust-library", "--set", "limits.energy_J=0.2",
         "--set", "rate_Hz=500", "--set", 'device.kind="force-dimension"',
         "--set", f'device.force_dimension.library="{BUILD}/libtact-stub-dhd.so"', "--arm", "--record", "log")


def begun(folder, supervisor):
    """A start; then 200 ticks with force, a question of tactctl, and a fault."""
    program = Program(folder, supervisor, *TACTD)
    if program.wait_for("limits "):
        if supervisor:
            supervisor.go()
        subprocess.run([BUILD / "tactctl", SCENE, "status"], env=dict(os.environ, XDG_RUNTIME_DIR=str(folder)),
                       capture_output=True, timeout=LIMIT_S)
        time.sleep(0.4)
        program.signal(signal.SIGXCPU)
    return program.end()


running = functools.partial(begun)  # counted from the first tick on
running.__name__ = "running"


def asked(folder, supervisor):
    """tactctl asks a tactd that runs beside it."""
    return Program(folder, supervisor, "tactctl", SCENE, "status", "--folder", BESIDE / "tact").end()


def viewed(folder, supervisor):
    """A viewer of that tactd, until Ctrl-C."""
    program = Program(folder, supervisor, "tact-view", "--socket", BESIDE / "s", "--port", "0", "--json", "--page", BESIDE,
                      "--record", "r.tact")
    program.wait_for('"token"')
    time.sleep(0.3)
    program.signal(signal.SIGINT)
    return program.end()


def exported(folder, supervisor):
    return Program(folder, supervisor, "tact-view", "--open", BESIDE / "r.tact", "--export", "x.csv").end()


def calls_of(act):
    """(call, n) of all that can fail, and what is said where none does."""
    supervisor = Supervisor(ERRORS, by_hand=act is running)
    with scratch() as folder:
        outcome = act(folder, supervisor)
    if (wrong := breach(outcome, set())) or outcome.status not in (0, 1) or not supervisor.counts:
        raise RuntimeError(f"{act.__name__}: no call has failed, and it {wrong or outcome}")
    pairs = []
    for call, last in supervisor.counts.items():
        step = max(1.0, last / MOST)
        pairs += [(call, int(i * step) + 1) for i in range(int(last / step))]
    return pairs, set(outcome.text.splitlines())


@contextlib.contextmanager
def scratch():
    folder = Path(tempfile.mkdtemp(prefix="tact-failing-"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def tried(act, call, number, usual):
    supervisor = Supervisor([call], number, ERRORS[call], act is running)
    with scratch() as folder:
        outcome = act(folder, supervisor)
    wrong = breach(outcome, usual)
    return wrong and f"{act.__name__}: {call} number {number}: {ERRORS[call]}: {wrong}: {outcome.text[-400:]!r}"


def blind():
    """An end of each kind that must be seen."""
    return [outcome for outcome in (Outcome(None, "", ""), Outcome(-6, "", ""), Outcome(1, "usual", ""),
                                    Outcome(0, "terminate called", ""), Outcome(0, "", "force on\n"),
                                    Outcome(0, "limits x", "")) if not breach(outcome, {"usual"})]


def main():
    failed, passed = [f"an end is not seen: {outcome}" for outcome in blind()], 0
    (BESIDE / "index.html").write_text("<html>")
    beside = Program(BESIDE, None, "tactd", SCENE, "--socket", BESIDE / "s", "--no-black-box")
    try:
        if not beside.wait_for("limits "):
            raise RuntimeError(f"tactd does not run: {beside.text()}")
        for act in (begun, running, asked, viewed, exported):
            if act is viewed:
                viewed(BESIDE, None)  # a recording for the next one
            begun_s, (pairs, usual) = time.monotonic(), calls_of(act)
            with concurrent.futures.ThreadPoolExecutor(PROCESSES) as pool:
                wrongs = list(pool.map(lambda pair: tried(act, *pair, usual), pairs))
            failed += filter(None, wrongs)
            passed += wrongs.count("")
            print(f"{act.__name__}: {len(pairs)} calls of {len({call for call, _ in pairs})} kinds "
                  f"({time.monotonic() - begun_s:.1f} s)", flush=True)
    finally:
        beside.signal(signal.SIGINT)
        beside.end()
    print(*failed, sep="\n", end="\n" if failed else "")
    print(f"{passed} passed, {len(failed)} failed")
    return 1 if failed else 0


with scratch() as BESIDE:
    sys.exit(main())
