# SPDX-License-Identifier: Apache-2.0
"""A PC in QEMU, as a person has it: a disk, power, and a serial console.

No KVM, so the numbers are those of emulation: two cores, of which the image isolates one, on
with any share of this host. Source: QEMU documentation, "System Emulation".
"""
import os
import pathlib
import re
import select
import shutil
import subprocess
import time

QEMU = "qemu-system-x86_64"
OVMF = pathlib.Path("/usr/share/OVMF")
MACHINE = ["-accel", "tcg,thread=multi", "-machine", "q35", "-cpu", "max", "-smp", "2", "-m", "2048",
           "-nodefaults", "-display", "none", "-no-reboot", "-nic", "user,model=virtio-net-pci"]
BOOT_LIMIT_S, COMMAND_LIMIT_S = 600, 120
USER, PASSWORD = "lab", "haptics-Pc-7"


class Trouble(Exception):
    """One sentence, and the end of the console."""


def must(condition, message):
    if not condition:
        raise Trouble(message)


class Pc:
    """Switched on when made. `firmware` is "bios" or "uefi"."""

    def __init__(self, disk, firmware, folder, stick=None):
        options = ["-drive", f"file={disk},if=ide,format=raw", "-serial", "stdio"]
        if stick:  # its blocks are the file's; virtio would have interrupts on core 1
            options += ["-drive", f"file={stick},if=ide,format=raw"]
        if firmware == "uefi":
            variables = folder / "uefi.fd"
            shutil.copy(OVMF / "OVMF_VARS_4M.fd", variables)
            options += ["-drive", f"if=pflash,format=raw,readonly=on,file={OVMF}/OVMF_CODE_4M.fd",
                        "-drive", f"if=pflash,format=raw,file={variables}"]
        self.console = (folder / f"console-{firmware}").open("wb")
        self.said, self.read_to = "", 0
        self.switched_on = time.monotonic()
        self.qemu = subprocess.Popen([QEMU, *MACHINE, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                     stderr=(folder / f"qemu-{firmware}").open("wb"))

    def on_s(self):
        """Seconds since power-on, of this host."""
        return time.monotonic() - self.switched_on

    def hear(self, limit_s):
        """What the console says within limit_s joins what it has said; False: it is closed."""
        if not select.select([self.qemu.stdout], [], [], limit_s)[0]:
            return True
        heard = os.read(self.qemu.stdout.fileno(), 65536)
        self.console.write(heard)
        self.console.flush()
        self.said += heard.decode(errors="replace").replace("\r", "")
        return bool(heard)

    def wait_for(self, pattern, limit_s):
        """The next match on the console; the text before it is read, too."""
        end = time.monotonic() + limit_s
        while True:
            found = re.compile(pattern).search(self.said, self.read_to)
            if found:
                self.before, self.read_to = self.said[self.read_to:found.start()], found.end()
                return found
            if time.monotonic() > end or not self.hear(1):
                raise Trouble(f"the console does not say {pattern!r} in {limit_s} s: ...{self.said[-800:]}")

    def type(self, line):
        self.qemu.stdin.write((line + "\n").encode())
        self.qemu.stdin.flush()

    def log_in(self, first_password=""):
        """The first login asks for the image's own password, twice, and for a new one, twice."""
        self.wait_for(r"haptics-pc login: ", BOOT_LIMIT_S)
        login_s = self.on_s()
        self.type(USER)
        for password in [first_password] * 2 + [PASSWORD] * 2 if first_password else [PASSWORD]:
            self.wait_for(r"(?i)password: ", COMMAND_LIMIT_S)
            self.type(password)
        self.wait_for(r"\$ ", COMMAND_LIMIT_S)
        self.type("stty -echo cols 400; PS1=; PS2=; bind 'set enable-bracketed-paste off'; echo quiet $((1 + 1))")
        self.wait_for(r"quiet 2\n", COMMAND_LIMIT_S)
        self.command(f"echo {PASSWORD} | sudo -S -p '' -v")
        return login_s

    def command(self, text, limit_s=COMMAND_LIMIT_S, may_fail=False):
        """Typed by the operator; returns what it prints."""
        self.type(f'{text}; echo "[$?]"')
        status = int(self.wait_for(r"\[(\d+)\]\n", limit_s)[1])
        if status and not may_fail:
            raise Trouble(f"{text}\nends with {status}: {self.before[-800:]}")
        return self.before

    def until(self, text, limit_s=COMMAND_LIMIT_S):
        """Repeats a command until it succeeds; returns what it prints."""
        return self.command(f"for i in $(seq {limit_s}); do {text} && break; sleep 1; [ $i != {limit_s} ]; done",
                            2 * limit_s + COMMAND_LIMIT_S)

    def cut_power(self):
        self.qemu.kill()
        self.qemu.wait()

    def shut_down(self):
        self.type("sudo systemctl poweroff")
        end = time.monotonic() + BOOT_LIMIT_S
        while self.hear(1) and time.monotonic() < end:
            pass
        try:
            self.qemu.wait(10)
        except subprocess.TimeoutExpired:
            raise Trouble(f"the PC does not switch itself off: ...{self.said[-800:]}") from None
