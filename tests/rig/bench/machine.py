# SPDX-License-Identifier: Apache-2.0
"""QEMU as a machine that counts time in instructions: boot once, load the programs, run cases from there.

-icount shift=0,sleep=off: one instruction is one nanosecond and idle time is skipped; one CPU, one
clock, seeded random numbers, input by fw_cfg (read without interrupts), no disk and no network. The
same snapshot, files and seed give the same nanoseconds on any host under any load.
Source: QEMU documentation, "TCG Instruction Counting" and "fw_cfg".
"""
import io
import os
import pathlib
import subprocess
import tarfile
import tempfile
import time

from bench.guest_image import RigError, digest

QEMU = "qemu-system-x86_64"
READY, LOADED, DONE = b"TACT-READY", b"TACT-LOADED", b"TACT-DONE"
KERNEL_ARGUMENTS = ("console=ttyS0 quiet panic=-1 nokaslr norandmaps tsc=reliable mitigations=off "
                    "no_timer_check noirqdebug nowatchdog")
MEMORY_MB = 768
MACHINE = ["-accel", "tcg,thread=single,tb-size=256", "-icount", "shift=0,sleep=off",
           "-rtc", "base=2024-01-01,clock=vm", "-cpu", "max", "-smp", "1", "-m", str(MEMORY_MB),
           "-nodefaults", "-display", "none", "-no-reboot", "-name", "tact,debug-threads=on",
           "-global", "migration.store-global-state=off"]
BOOT_LIMIT_S = 180


class Machine:
    """A kernel, an initramfs and a folder for the snapshot of the booted guest."""

    def __init__(self, vmlinuz, initramfs, preload, folder):
        self.vmlinuz, self.initramfs = vmlinuz, initramfs
        self.environment = {**os.environ, "LD_PRELOAD": str(preload)}  # see patient_poll.cc
        version = subprocess.run([QEMU, "--version"], capture_output=True, text=True, check=True)
        key = digest(version.stdout, MACHINE, KERNEL_ARGUMENTS, str(initramfs.parent.name))
        self.booted, self.loaded = folder / f"booted-{key}", None

    def boot(self):
        """Makes the snapshot of the booted guest if there is none."""
        if not self.booted.exists():
            self.booted.parent.mkdir(parents=True, exist_ok=True)
            self.take_snapshot(self.booted, "WAIT", b"", READY)

    def load(self, files_tar):
        """Brings the files of a tar into the guest that all later runs start from. Kept like the booted
        one: the moment at which a snapshot is taken is this host's, and a replay needs the same."""
        self.loaded = self.booted.with_name(f"loaded-{digest(self.booted.name, files_tar)}")
        if not self.loaded.exists():
            for old in sorted(self.booted.parent.glob("loaded-*"), key=os.path.getmtime)[:-1]:
                old.unlink()
            self.take_snapshot(self.loaded, "LOAD", files_tar, LOADED,
                               ["-incoming", f"exec:cat {self.booted}"])

    def take_snapshot(self, target, word, files_tar, until, options=()):
        with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
            work = pathlib.Path(scratch)
            console = work / "console"
            console.touch()
            write_input(work, word, files_tar)
            said = (work / "qemu").open("wb")
            qemu = subprocess.Popen(
                [*self.arguments(work, seed=1), *options, "-serial", f"file:{console}", "-serial", "null",
                 "-monitor", "stdio"], stdin=subprocess.PIPE, stdout=said, stderr=said,
                env=self.environment)
            try:
                wait_for_word(qemu, console, work / "qemu", until)
                orders = f'migrate "exec:cat >{work}/state"\nquit\n'
                qemu.communicate(orders.encode(), timeout=BOOT_LIMIT_S)
            except subprocess.TimeoutExpired:
                raise RigError("QEMU's snapshot of the guest took too long; is the disk full?")
            finally:
                qemu.kill()
                qemu.wait()
                said.close()
            if not (work / "state").exists() or (work / "state").stat().st_size < 1 << 20:
                raise RigError(f"QEMU wrote no snapshot: {(work / 'qemu').read_text()[-500:]}")
            (work / "state").rename(target)

    def run(self, script, seed, limit_s, files=()):
        """Runs the bash text `script` in the loaded guest, with (host file, name in the guest) beside it; returns an
        Outcome."""
        with tempfile.TemporaryDirectory() as scratch:
            work = pathlib.Path(scratch)
            write_input(work, "GO", tar_of_case(script, files))
            start = time.monotonic()
            with (work / "said").open("wb") as said:
                command = [*self.arguments(work, seed), "-incoming", f"exec:cat {self.loaded}",
                           "-serial", f"file:{work}/console", "-serial", f"file:{work}/results"]
                qemu = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said,
                                        stderr=subprocess.STDOUT, env=self.environment)
                in_time = wait_for_end(qemu, work / "console", start + limit_s)
            results = (work / "results").read_bytes() if (work / "results").exists() else b""
            console = (work / "said").read_bytes() + (
                (work / "console").read_bytes() if (work / "console").exists() else b"")
            return Outcome(results, console, not in_time, time.monotonic() - start)

    def arguments(self, work, seed):
        return [QEMU, *MACHINE, "-seed", str(seed), "-kernel", str(self.vmlinuz),
                "-initrd", str(self.initramfs), "-append", KERNEL_ARGUMENTS,
                "-fw_cfg", f"name=opt/tact/go,file={work}/go",
                "-fw_cfg", f"name=opt/tact/files,file={work}/files"]


class Outcome:
    """What a guest left: its result files by name, its console, and why it ended."""

    def __init__(self, results, console, timed_out, wall_s):
        self.file, self.trouble, self.wall_s = {}, "", wall_s
        self.console = console.decode(errors="replace").replace("\r", "")
        try:
            with tarfile.open(fileobj=io.BytesIO(results)) as tar:
                self.file = {m.name.removeprefix("./"): tar.extractfile(m).read().decode(errors="replace")
                             for m in tar if m.isreg()}
        except (tarfile.TarError, EOFError, OSError):
            self.trouble = "the guest's results are torn"
        if timed_out:
            self.trouble = (f"the guest did not end within {wall_s:.0f} s of this host's time: a "
                            "thread that spins at FIFO priority stops everything, or the host is slow")
        elif DONE not in console:
            self.trouble = "the guest died: " + self.console[-600:]
        self.status = int(self.file.get("status", "-1"))


def write_input(work, word, files):
    (work / "go").write_text(f"{word:<16}")
    (work / "files").write_bytes(files or b"\0" * 1024)


def tar_of_case(script, files=()):
    buffer = io.BytesIO(make_tar(files) if files else b"")
    with tarfile.open(fileobj=buffer, mode="a" if files else "w") as tar:
        entry = tarfile.TarInfo("case")
        data = script.encode()
        entry.size = len(data)
        tar.addfile(entry, io.BytesIO(data))
    return buffer.getvalue()


def make_tar(entries):
    """A tar of (host file or folder, name in the guest), without times and owners."""
    buffer = io.BytesIO()

    def plain(member):
        member.mtime = member.uid = member.gid = 0
        member.uname = member.gname = ""
        return member

    with tarfile.open(fileobj=buffer, mode="w") as tar:
        for source, name in entries:
            paths = [source] if source.is_file() else sorted(p for p in source.rglob("*") if p.is_file())
            for path in paths:
                inside = name if source.is_file() else f"{name}/{path.relative_to(source)}"
                tar.add(path, inside, filter=plain)
    return buffer.getvalue()


def wait_for_word(qemu, console, said, word):
    deadline = time.monotonic() + BOOT_LIMIT_S
    while word not in console.read_bytes():
        if qemu.poll() is not None or time.monotonic() > deadline:
            raise RigError("the guest does not boot: " + said.read_text(errors="replace")[-500:] +
                           console.read_text(errors="replace")[-500:])
        time.sleep(0.1)


def wait_for_end(qemu, console, deadline):
    """False if the deadline came first. The results are written before DONE is said, so the guest need not
    switch itself off."""
    try:
        while qemu.poll() is None and time.monotonic() < deadline:
            if console.exists() and DONE in console.read_bytes():
                return True
            time.sleep(0.02)
        return qemu.poll() is not None
    finally:
        qemu.kill()
        qemu.wait()
