# SPDX-License-Identifier: Apache-2.0
"""What the tests of tact-metrics share: stations, and what an exporter answers."""
import pathlib
import subprocess
import sys
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/tools"))
sys.dont_write_bytecode = True
from processes import ProcessCase  # noqa: E402

METRICS = ROOT / "tools/metrics"
LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
SLOW = ("--set", "rate_Hz=300", "--set", "telemetry.frame_rate_Hz=20", "--set", "limits.energy_J=0.2")  # for a busy machine
UP = r"tact_up\{.*\} 1\.0"


def get(url, accept="text/plain"):
    with urllib.request.urlopen(urllib.request.Request(url, headers={"Accept": accept}), timeout=60) as answer:
        return answer.read().decode(), answer.headers["Content-Type"]


class Case(ProcessCase):
    def start(self, *arguments, **options):
        return super().start(*arguments, **{"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True, **options})

    def tactd(self, number, *arguments):
        return self.start_tactd(BUILD, LIVER, self.folder / f"{number}.sock", *arguments, stdout=subprocess.PIPE)

    def exporter(self, *arguments):
        """The process, and the address that it answers."""
        process = self.start(BUILD / "tact-metrics", *arguments, "--listen", "127.0.0.1:0")
        return process, process.stdout.readline().strip()
