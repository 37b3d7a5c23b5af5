# SPDX-License-Identifier: Apache-2.0
"""What the tests of tact-metrics share: stations, and how an event is waited for."""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[3]
METRICS = ROOT / "tools/metrics"
LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
MAX_WAIT_S = 240.0
UP = r"tact_up\{.*\} 1\.0"


def get(url, accept="text/plain"):
    with urllib.request.urlopen(urllib.request.Request(url, headers={"Accept": accept}), timeout=60) as answer:
        return answer.read().decode(), answer.headers["Content-Type"]


def until(ask, what):
    """Its first answer that is true. An event is waited for; the bound is for a test that hangs."""
    end = time.monotonic() + MAX_WAIT_S
    while time.monotonic() < end:
        answer = ask()
        if answer:
            return answer
        time.sleep(0.1)
    raise AssertionError(f"not seen within {MAX_WAIT_S:g} s: {what}")


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def start(self, *arguments, **options):
        options.setdefault("stderr", subprocess.DEVNULL)
        process = subprocess.Popen(list(map(str, arguments)), stdout=subprocess.PIPE, text=True, **options)

        def end():
            for name in (signal.SIGCONT, signal.SIGTERM):
                process.send_signal(name)
            try:
                process.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
        self.addCleanup(end)
        return process

    def tactd(self, number, *arguments):
        return self.start(BUILD / "tactd", LIVER, "--socket", self.folder / f"{number}.sock", "--no-black-box", *arguments)

    def exporter(self, *arguments):
        """The process, and the address that it answers."""
        process = self.start(BUILD / "tact-metrics", *arguments, "--listen", "127.0.0.1:0")
        return process, process.stdout.readline().strip()
