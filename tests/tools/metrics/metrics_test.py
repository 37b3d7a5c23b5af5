#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-metrics of BUILD_DIR by itself: a stuck scraper costs no tick, the text file is whole, bad usage has a message.

    python3 tests/tools/metrics/metrics_test.py BUILD_DIR

Needs python3-prometheus-client and python3-numpy. prometheus_test.py asks Prometheus. Exit status 0 or 1.
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import unittest
import urllib.parse

import prometheus_client.core

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from stations import BUILD, METRICS, ROOT, SLOW, UP, Case, get  # noqa: E402
from processes import MAX_WAIT_S, until  # noqa: E402

sys.path.insert(0, str(ROOT / "tools/client"))
import tact  # noqa: E402

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


class Histograms(Case):
    def test_histograms_count_each_tick_of_the_log(self):
        log = self.folder / "run.tactlog"
        station = self.tactd("log", *SLOW, "--record", log)
        _, url = self.exporter(self.folder / "log.sock")
        until(lambda: re.search(r"tact_ticks_total\{.*\} [1-9]\d\d", get(url)[0]) or
              self.assertIsNone(station.poll(), "tactd has ended"), "a hundred ticks")
        text, _ = get(url)
        station.terminate()
        self.assertEqual(station.wait(MAX_WAIT_S), 0)
        value = dict(re.findall(r"^(tact_\w+)\{socket=[^,}]*\} (\S+)$", text, re.M))
        self.assertEqual(float(value["tact_dropped_records_total"]), 0.0)
        ticks = tact.read_ticks(log).ticks
        ticks = ticks[ticks["tick"] <= float(value["tact_ticks_total"])]
        for name, phase, first in (("tact_wake_seconds", 0, 0), ("tact_tick_seconds", -1, 1)):
            took_s = 1e-9 * ticks["phase_ns"][first:, phase]
            buckets = re.findall(rf'^{name}_bucket{{le="([^"]+)",.*}} (\S+)$', text, re.M)
            self.assertEqual([float(count) for _, count in buckets],
                             [float((took_s <= float(bound) + 1e-12).sum()) for bound, _ in buckets])
            self.assertEqual(float(value[f"{name}_count"]), len(took_s))
            self.assertAlmostEqual(float(value[f"{name}_sum"]), took_s.sum(), places=9)

    def test_a_temperature_is_there_where_a_device_has_one(self):
        """No simulated device reports one: the frame of a run is given one here."""
        station = self.tactd("warm", *SLOW)
        until(lambda: (self.folder / "warm.sock").exists() or self.assertIsNone(station.poll(), "tactd has ended"), "the socket")
        module = exporter_module()
        source = module.Source(self.folder / "warm.sock")
        source.run = tact.live(self.folder / "warm.sock", timeout_s=60.0)
        self.addCleanup(source.run.close)
        for given, seen in ((float("nan"), []), (41.5, [41.5])):
            frame = next(source.run).copy()
            frame["temperature_C"] = given
            source._add(frame)
            found = {family.name: family for family in module.Metrics([source], {}).collect()}
            self.assertEqual([sample.value for sample in found["tact_temperature_celsius"].samples], seen)


def exporter_module():
    path = METRICS / "tact-metrics"
    loader = importlib.machinery.SourceFileLoader("tact_metrics", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("tact_metrics", loader))
    loader.exec_module(module)
    module.core, module.tact = prometheus_client.core, tact  # which it imports as a program
    return module


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
