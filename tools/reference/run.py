# SPDX-License-Identifier: Apache-2.0
"""Programs and jobs in processes of their own: Ctrl-C ends all of them at once and leaves no file behind."""
import contextlib
import ctypes
import enum
import json
import multiprocessing
import multiprocessing.connection
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
LAST_LINES = 12
LONG_S = 10.0  # chosen: work whose cost is reported

run_folder: pathlib.Path | None = None  # of everything that is written on the way, gone at the end


class Code(enum.Enum):
    """What kind of failure it is: its text is not compared."""
    OTHER = 0
    PROGRAM_ENDED = 1  # with a status above 0, or by a signal
    NO_SOLUTION = 2  # the solver ran and gave up


class Failure(Exception):
    """One sentence that says what, where and the remedy."""

    def __init__(self, message: str, code: Code = Code.OTHER):
        super().__init__(message, code)
        self.message, self.code = message, code


def watch_signals():
    """From here on the first Ctrl-C, SIGTERM or closed terminal is a KeyboardInterrupt; later ones do nothing."""
    def interrupt(*_):
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:  # nohup
            signal.signal(number, interrupt)


@contextlib.contextmanager
def folder_of_run():
    """Holds every Scratch of this process and of its jobs."""
    global run_folder
    try:
        run_folder = pathlib.Path(tempfile.mkdtemp(prefix="tact-reference-"))
    except OSError:
        raise Failure(f"no folder {tempfile.gettempdir()}/tact-reference-XXXXXX can be made; check that TMPDIR exists and has "
                      "room") from None
    try:
        yield
    finally:
        shutil.rmtree(run_folder, ignore_errors=True)


class Scratch:
    """A new empty folder, gone at the end of its `with`."""

    def __init__(self, name: str):
        self.name, self.path = name, pathlib.Path(tempfile.mkdtemp(prefix=name + "-", dir=run_folder))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.path.is_relative_to(run_folder):
            shutil.rmtree(self.path, ignore_errors=True)

    def keep(self):
        """Moves it out of the folder of the run, for a person to look into."""
        kept = tempfile.mkdtemp(prefix=self.name + "-")
        self.path = self.path.rename(kept)  # takes the place of the empty folder


def end_with_parent() -> None:
    """In a new process: the kernel ends it when its parent ends, however that ends."""
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def run_program(words: list[str], scratch: Scratch, package: str, time_limit_s: float, any_status: bool = False) -> str:
    """What the program printed, if it ended with status 0; else a Failure, and the scratch folder is kept. It runs there."""
    program = words[0]
    log = f"{program}.log"
    with open(scratch.path / log, "wb") as out:
        # One core a solve: --jobs runs several.
        one_core = {"OMP_NUM_THREADS": "1", "CCX_NPROC_STIFFNESS": "1"}
        try:
            child = subprocess.Popen(words, cwd=scratch.path, env=os.environ | one_core, stdin=subprocess.DEVNULL, stdout=out,
                                     stderr=subprocess.STDOUT, preexec_fn=end_with_parent)
        except FileNotFoundError:
            raise Failure(f"{program} is not installed; apt install {package}") from None
        except OSError as error:
            raise Failure(f"{program} does not start: {error.strerror}") from None
        try:
            status = child.wait(time_limit_s)
        except subprocess.TimeoutExpired:
            scratch.keep()
            raise Failure(f"{program} took longer than {time_limit_s:g} s and was ended; what it printed is in "
                          f"{scratch.path / log}") from None
        finally:
            if child.poll() is None:
                child.kill()
                child.wait()
    text = (scratch.path / log).read_text(errors="replace")
    if status == 0 or (any_status and status > 0):
        return text
    scratch.keep()
    how = f"status {status}" if status > 0 else f"signal {-status}"
    tail = "\n".join(["", *text.splitlines()[-LAST_LINES:]])
    raise Failure(f"{program} ended with {how}; all it printed is in {scratch.path / log}, at the end:{tail}",
                  Code.PROGRAM_ENDED)


def write(path: pathlib.Path, content: str | bytes):
    """Whole or not at all; a pipe or a device is written straight."""
    path, data = path.resolve(), content.encode() if isinstance(content, str) else content
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with open(handle, "wb") as file:
                file.write(data)
            os.chmod(name, 0o644)
            os.replace(name, path)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise Failure(f"{path}: cannot be written: {error.strerror}; check the folder, who may write there and the free "
                      "space") from None


def answer(pipe, work, job):
    """A job's own process, which leads the group of the programs that it starts."""
    os.setpgid(0, 0)
    end_with_parent()  # without the parent the output has no reader
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)  # a terminal signals the parent, which ends this group
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    try:
        pipe.send((work(job), None))
    except Failure as failure:
        pipe.send((None, failure))


class Jobs:
    """Processes at work, by the pipe through which each answers."""

    def __init__(self, work):
        self.work, self.running = work, {}

    def start(self, number: int, job):
        here, there = multiprocessing.Pipe(duplex=False)
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)  # a Ctrl-C must know of every process
        process = multiprocessing.get_context("fork").Process(target=answer, args=(there, self.work, job))
        process.start()
        with contextlib.suppress(OSError):  # a race: the process may have done it, or have ended
            os.setpgid(process.pid, process.pid)
        self.running[here] = (number, process)
        there.close()
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)

    def answers(self, seconds: float):
        """Those that come within some seconds, each (number, result, failure)."""
        for pipe in multiprocessing.connection.wait(list(self.running), seconds):
            number, process = self.running[pipe]
            try:
                result, failure = pipe.recv()
            except EOFError:
                result, failure = None, Failure("a job ended without an answer, as for want of memory; use fewer --jobs")
            del self.running[pipe]
            process.join()
            yield number, result, failure

    def kill(self):
        for _, process in self.running.values():
            with contextlib.suppress(OSError):
                os.killpg(process.pid, signal.SIGKILL)
            process.join()


@contextlib.contextmanager
def phase(name: str, expected_s: float):
    """One step of long work, reported on standard error: what it takes about, and has taken. On a terminal both are one line."""
    begun_s, again = time.monotonic(), "\r\033[K" if sys.stderr.isatty() else ""
    print(f"{name}: about {expected_s:.0f} s", end="" if again else "\n", file=sys.stderr, flush=True)
    try:
        yield
    finally:
        print(again, end="", file=sys.stderr, flush=True)
    print(f"{name}: {time.monotonic() - begun_s:.0f} s", file=sys.stderr, flush=True)


def show_progress(label: str, done: int, count: int, begun_s: float):
    """One line that is written over itself, on a terminal and with a label."""
    left = f"about {(time.monotonic() - begun_s) * (count - done) / done:.0f} s left " if done else ""
    text = f"{label}: {done} of {count} ({100 * done // count} %) {left}" if done < count else ""
    if label and sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def run_jobs(work, jobs: list, processes: int, label: str) -> list:
    """[work(job) for job in jobs], each in a process of its own. After a Failure no other job begins."""
    results, first_failure, waiting, begun_s = [None] * len(jobs), None, list(enumerate(jobs)), time.monotonic()
    at_work, done = Jobs(work), 0
    try:
        while at_work.running or (waiting and not first_failure):
            while waiting and not first_failure and len(at_work.running) < processes:
                at_work.start(*waiting.pop(0))
            show_progress(label, done, len(jobs), begun_s)
            for number, results[number], failure in at_work.answers(seconds=0.2):
                done, first_failure = done + 1, first_failure or failure
    finally:
        at_work.kill()
        show_progress(label, 1, 1, begun_s)
    if first_failure:
        raise first_failure
    return results


def print_cost(label: str):
    """What long work cost, with the programs that it ran."""
    own, others = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime
    if cpu_s >= LONG_S:
        print(f"{label}: {cpu_s:.0f} CPU s on up to {os.cpu_count()} cores, "
              f"{1.024e-6 * max(own.ru_maxrss, others.ru_maxrss):.2g} GB at most", file=sys.stderr, flush=True)


def main(label: str, act, kept: str) -> int:
    """The exit status of act(job), where sys.argv names the job's file; an error is one line. `kept`: what Ctrl-C leaves."""
    watch_signals()  # the first Ctrl-C may come while numpy is read
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # one core a job
    try:
        status = act(json.loads(pathlib.Path(sys.argv[1]).read_text())) or 0
        print_cost(label)
        return status
    except Failure as failure:
        message, status = failure.message, 2
    except ImportError as missing:
        message, status = f"{missing.name} is missing in Debian's python3; apt install python3-numpy python3-scipy", 2
    except MemoryError:
        message, status = "no memory is left; take larger elements, or close programs", 2
    except OSError as error:  # every other file is looked after where it is used
        message, status = f"standard output cannot be written: {error.strerror}; check where it goes", 2
    except KeyboardInterrupt:
        message, status = f"interrupted; {kept}", 1
    print(f"{label}: {message}", file=sys.stderr, flush=True)
    os._exit(status)  # what cannot be written is not tried again
