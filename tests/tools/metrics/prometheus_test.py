#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Debian's Prometheus scrapes eight tactd of BUILD_DIR by tact-metrics; an alert fires; promtool accepts metrics and rules.

    python3 tests/tools/metrics/prometheus_test.py BUILD_DIR

Needs prometheus, python3-prometheus-client and python3-numpy. Exit status 0 or 1.
"""
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time
import unittest
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from stations import METRICS, ROOT, SLOW, UP, Case, get  # noqa: E402
from processes import until  # noqa: E402

sys.path.insert(0, str(ROOT / "tools/client"))
import tact  # noqa: E402

STATIONS, SCRAPE_S = 8, 2
CONFIG = """
global: {{scrape_interval: {scrape}s, scrape_timeout: {scrape}s, evaluation_interval: 500ms}}
rule_files: [{rules}]
scrape_configs: [{{job_name: tact, static_configs: [{{targets: {targets}}}]}}]
"""


def promtool(*arguments, text=None):
    return subprocess.run(["promtool", *map(str, arguments)], input=text, capture_output=True, text=True)


class Fleet(Case):
    def test_prometheus_scrapes_eight_and_alerts(self):
        victim, *others = [self.tactd(number, *SLOW) for number in range(STATIONS)]
        ends = [self.exporter(self.folder / f"{number}.sock")[1] for number in range(STATIONS)]
        for url in ends:
            until(lambda: re.search(UP, get(url)[0]) or self.assertIsNone(victim.poll(), "tactd has ended"), f"frames at {url}")
        self.check_metrics(ends[0])
        base = self.prometheus(ends)
        until(lambda: len(self.ask(base, "tact_ticks_total > 0")) == STATIONS, "eight stations in Prometheus")
        self.check_dashboard(base)
        self.check_alert(base, victim, urllib.parse.urlparse(ends[0]).netloc)
        self.assertEqual([other.poll() for other in others], [None] * len(others))

    def check_metrics(self, url):
        text, _ = get(url)
        checked = promtool("check", "metrics", text=text)
        self.assertEqual((checked.returncode, checked.stderr + checked.stdout), (0, ""))
        asked = "".join((METRICS / name).read_text() for name in ("tact.rules.yml", "tact.dashboard.json"))
        for name in set(re.findall(r"\btact_\w+", asked)):
            if name not in ("tact_limit_frames_total", "tact_temperature_celsius"):  # limits that act, drives that report
                self.assertIn("\n" + name.replace("_bucket", ""), text.replace("_bucket", ""), name)
        openmetrics, kind = get(url, "application/openmetrics-text; version=1.0.0")
        self.assertIn("application/openmetrics-text", kind)
        self.assertTrue(openmetrics.endswith("# EOF\n"))

    def prometheus(self, urls):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        config = self.folder / "prometheus.yml"
        config.write_text(CONFIG.format(scrape=SCRAPE_S, rules=METRICS / "tact.rules.yml",
                                        targets=json.dumps([urllib.parse.urlparse(url).netloc for url in urls])))
        self.start("prometheus", f"--config.file={config}", f"--storage.tsdb.path={self.folder / 'data'}",
                   f"--web.listen-address=127.0.0.1:{port}")
        return f"http://127.0.0.1:{port}"

    def ask(self, base, query):
        try:
            answer = json.loads(get(f"{base}/api/v1/query?{urllib.parse.urlencode({'query': query})}")[0])
        except OSError:  # it starts
            return []
        self.assertEqual(answer["status"], "success", query)
        return answer["data"]["result"]

    def check_dashboard(self, base):
        """Each query is one of Prometheus, and finds something where something must be."""
        panels = json.loads((METRICS / "tact.dashboard.json").read_text())["panels"]
        for query in (target["expr"] for panel in panels for target in panel["targets"]):
            found = self.ask(base, query)
            if not re.search(r"rate\(|fault|temperature", query):
                self.assertTrue(found, query)

    def check_alert(self, base, victim, instance):
        own = tact.live(self.folder / "0.sock", timeout_s=60.0, newest=True)
        self.assertEqual(next(own)["fault"], 0)
        victim.send_signal(signal.SIGSTOP)
        time.sleep(2.5)  # more periods than a stall may last; what follows is waited for
        victim.send_signal(signal.SIGCONT)
        frame = next(frame for frame in own if frame["fault"])
        began_s = 1e-9 * float(frame["due_ns"] + frame["utc_offset_ns"])
        mine = f'instance="{instance}"'
        fired = until(lambda: self.ask(base, f'ALERTS{{alertname="TactFault",alertstate="firing",{mine}}}[10m]'), "the alert")
        own.close()
        fired_s = float(fired[0]["values"][0][0])
        scraped_s = [float(at_s) for at_s, _ in self.ask(base, f"tact_fault_code{{{mine}}}[10m]")[0]["values"]]
        scrapes = sum(began_s < at_s <= fired_s for at_s in scraped_s)
        self.assertIn(scrapes, (1, 2), f"fault at {began_s}, alert at {fired_s}, scrapes {scraped_s}")
        self.assertNotEqual(fired[0]["metric"]["fault"], "none")
        self.assertFalse(fired[0]["metric"]["fault"].isdigit(), "a fault has its name")


class Rules(Case):
    def test_rules_are_those_of_promtool(self):
        checked = promtool("check", "rules", METRICS / "tact.rules.yml")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        cases = self.folder / "cases.yml"
        cases.write_text((ROOT / "tests/tools/metrics/alerts.yml").read_text().replace("RULES", str(METRICS / "tact.rules.yml")))
        tried = promtool("test", "rules", cases)
        self.assertEqual(tried.returncode, 0, tried.stdout + tried.stderr)
        named = set(re.findall(r"alert: (\w+)", (METRICS / "tact.rules.yml").read_text()))
        self.assertEqual(named, set(re.findall(r"alertname: (\w+)", cases.read_text())))


if __name__ == "__main__":
    unittest.main()
