# SPDX-License-Identifier: Apache-2.0
"""How a test starts programs, waits for what they do, and ends them."""
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

MAX_WAIT_S = 300.0  # against a test that hangs


def until(ask, what):
    """Its first answer that is true. An event is waited for; the bound is for a test that hangs."""
    end = time.monotonic() + MAX_WAIT_S
    while time.monotonic() < end:
        answer = ask()
        if answer:
            return answer
        time.sleep(0.02)
    raise AssertionError(f"not seen within {MAX_WAIT_S:g} s: {what}")


class ProcessCase(unittest.TestCase):
    """Has a folder, which goes when it ends, and processes, which end before."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def start(self, *arguments, **options):
        process = subprocess.Popen(list(map(str, arguments)), **options)

        def end():
            for number in (signal.SIGCONT, signal.SIGTERM):
                process.send_signal(number)
            try:
                process.wait(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            for pipe in filter(None, (process.stdin, process.stdout)):
                pipe.close()
        self.addCleanup(end)
        return process

    def start_tactd(self, build, scene, socket, *arguments, **options):
        return self.start(build / "tactd", scene, "--socket", socket, "--no-black-box", *arguments,
                          **{"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **options})
