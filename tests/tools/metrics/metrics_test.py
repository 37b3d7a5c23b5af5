#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-metrics of BUILD_DIR by itself: a stuck scraper costs no tick, the text file is whole, bad usage has a message.

    python3 tests/tools/metrics/metrics_test.py BUILD_DIR

Needs python3-prometheus-client and python3-numpy. prometheus_test.py asks Prometheus. Exit status 0 or 1.
"""
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import unittest
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from stations import BUILD, UP, Case, get  # noqa: E402
from processes import MAX_WAIT_S, until  # noqa: E402

FREE_RUN_TICKS = 200000


class Stuck(Case):
    """In simulated time telemetry runs in the thread of the loop: what could delay it would do so here."""

    def free_run(self, *arguments):
        report = self.folder / "report.json"
        process = self.tactd("free", "--free-run", "--ticks", FREE_RUN_TICKS, "--json", report, *arguments)

        def ended():
            self.assertEqual(process.wait(MAX_WAIT_S), 0)
            found = json.loads(report.read_text())
            return {key: found[key] for key in ("force_hash", "late", "skipped", "ticks")}, found["dropped_frames"]
        return process, ended

    def test_stuck_scraper_costs_no_tick(self):
        alone, _ = self.free_run("--no-telemetry")[1]()
        exporter, url = self.exporter(self.folder / "free.sock")
        process, ended = self.free_run()
        until(lambda: re.search(UP, get(url)[0]), "frames of the free run")
        exporter.send_signal(signal.SIGSTOP)
        self.assertIsNone(process.poll(), "the run ended before the scraper was stuck")
        stuck, dropped = ended()
        self.assertEqual(stuck, alone)
        self.assertGreater(dropped, 0)

    def test_clients_that_do_not_read_stop_no_other(self):
        _, url = self.exporter(self.folder / "none.sock")
        at = urllib.parse.urlparse(url)
        for i in range(50):
            client = self.enterContext(socket.create_connection((at.hostname, at.port)))
            client.sendall(b"GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n" if i % 2 else b"GET /met")
        self.assertIn("tact_up{", get(url)[0])


class Files(Case):
    def test_text_file_is_whole_and_of_promtool(self):
        out = self.folder / "tact.prom"
        self.start(BUILD / "tact-metrics", self.folder / "none.sock", "--listen", "none", "--textfile", out, "--every", 0.1)
        text = until(lambda: out.exists() and out.read_text(), "the text file")
        self.assertIn(f'tact_up{{socket="{self.folder / "none.sock"}"}} 0.0\n', text)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.suffix == ".prom"], ["tact.prom"])

    def test_bad_usage_says_what_to_write(self):
        for arguments, said in ((["--listen", "0.0.0.0:9464"], "--open"), (["--listen", "x"], "127.0.0.1:9464"),
                                (["--textfile", "a.txt"], "FILE.prom"), (["--listen", "none"], "--textfile"),
                                (["--every", "0"], "0.1 to 3600"), (["--listen", "127.0.0.1:70000"], "0 to 65535")):
            done = subprocess.run([BUILD / "tact-metrics", *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(said, done.stderr)

    def test_a_port_in_use_is_a_message(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            done = subprocess.run([BUILD / "tact-metrics", "--listen", f"127.0.0.1:{taken.getsockname()[1]}"],
                                  capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^tact-metrics: 127\.0\.0\.1:\d+: Address already in use; choose another")


if __name__ == "__main__":
    unittest.main()
