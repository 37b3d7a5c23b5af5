#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page and the histogram of tact-jitter show what jitter.json says, all of it and nothing else.

    python3 tests/tools/jitter/page_test.py build
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(BUILD / "report"))
sys.dont_write_bytecode = True
import jitter_page  # noqa: E402


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.done = subprocess.run([BUILD / "tact-jitter", ROOT / "model/scenes/liver.toml", "--duration", "0.3", "--out",
                                   cls.folder], capture_output=True, text=True, check=False, timeout=120)
        cls.kept = json.loads((cls.folder / "jitter.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        self.data = copy.deepcopy(self.kept)

    def page(self, picture=None):
        return jitter_page.html_of(self.data, picture)

    def test_of_the_program_is_that_of_its_json(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        self.assertEqual((self.folder / "report.html").read_text(), self.page((self.folder / "histogram.svg").read_text()))
        self.assertIn("<svg", (self.folder / "report.html").read_text())

    def test_needs_nothing_but_itself(self):
        self.data["subject"], self.data["command"] = "bare <loop> & 'friends'", "tact-jitter <x>"
        page = self.page("<?xml head?><svg id='a'>picture</svg>")
        for outside in ("http://", "https://", " src=", "<link", "<script", "@import", "<?xml"):
            self.assertNotIn(outside, page)
        self.assertIn("<svg id='d0_a'>picture</svg>", page)
        self.assertIn("bare &lt;loop&gt; &amp; &#x27;friends&#x27;", page)
        self.assertIn("tact-jitter &lt;x&gt;", page)

    def test_begins_with_the_outcome(self):
        for verdict in ("pass", "fail", "part"):
            self.data.update(outcome_verdict=verdict, outcome=f"of {verdict}")
            page = self.page()
            self.assertLess(page.index(f'<p class="verdict {verdict}">of {verdict}</p>'), page.index("<h1>"))

    def test_durations_are_in_the_order_of_a_tick(self):
        self.data["series"]["wake"].update(samples=1000, max_tick=999, max_at_s=0.999, max_ns=2000000)
        self.data["series"]["wake"].update({"p99.9_ns": 5432, "p99.99_ns": None, "p99.999_ns": None})
        page = self.page()
        self.assertIn("<td class=n>5.43</td><td class=n>-</td><td class=n>-</td><td class=n>2000</td><td class=n>0.999</td>"
                      "<td class=n>999</td></tr>", page)
        titles = ("wake-up", "every wake-up", "read", "tick", "deadline to force")
        places = [page.index(f"<tr><td>{title}</td>") for title in titles]
        self.assertEqual(places, sorted(places))
        self.assertIn("it bounds nothing", page)
        self.assertNotIn("worst case", page)

    def test_the_peer_and_its_gate_stand_where_they_ran(self):
        self.assertNotIn("peer gate", self.page())
        self.data["compared_with_peer"] = "wake-up p99.9 is 1.10 of cyclictest's"
        self.assertIn("<b>wake-up p99.9 is 1.10 of cyclictest&#x27;s</b>", self.page())
        for passed, color in ((True, "green"), (False, "red"), (None, "unknown")):
            self.data["peer_gate"] = {"most": 1.2, "passed": passed, "sentence": "S"}
            self.assertIn(f"<span class='stamp {color}'>peer gate</span> S", self.page())

    def test_late_ticks_and_the_pc_are_part_of_the_evidence(self):
        late = {"tick": 7, "at_s": 0.5, "due_ns": 1, "deadline_to_force_ns": 123456, "skipped_before": 2,
                "phases_ns": {"wake": 1234}, "kernel_counted": "2 of LOC"}
        self.data.update(late_ticks=[late] * 30, non_rt=True)
        self.data["pc"][0].update(verdict="red", remedy="boot another")
        page = self.page()
        row = ("<tr><td>2 of LOC</td><td class=n>0.500</td><td class=n>7</td><td class=n>123</td><td class=n>1.23</td>"
               "<td class=n>2</td></tr>")
        self.assertEqual(page.count(row), 20)
        self.assertIn("<code>boot another</code>", page)
        self.assertIn("non-rt", page)
        self.data["kernel"]["smi"] = None
        self.assertIn("<td>system management interrupts</td><td class=n>not readable here</td>", self.page())

    def test_the_picture_has_every_sample(self):
        keys = ["wake", "total"]
        head, *rows = jitter_page.histogram_csv(self.data["series"], keys).splitlines()
        self.assertEqual(head, "from_us,wake,total")
        for column, key in enumerate(keys, 1):
            samples = [int(row.split(",")[column]) for row in rows]
            self.assertEqual(sum(samples), self.data["series"][key]["samples"])
            self.assertEqual(samples[-1], 0, "steps end there")

    def test_a_value_on_an_edge_belongs_to_the_bucket_above(self):
        rows = jitter_page.histogram_csv({"wake": {"buckets_ns": [[1000, 1000, 3], [40, 60, 2]]}}, ["wake"]).splitlines()
        self.assertEqual([row for row in rows[1:] if not row.endswith(",0")], ["0.1,2", "1,3"])


if __name__ == "__main__":
    unittest.main()
