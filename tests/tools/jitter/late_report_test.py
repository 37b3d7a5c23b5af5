#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What tact-jitter late keeps: the trace gives the same answers again, JSON by its schema, sums of each day.

    python3 tests/tools/jitter/late_report_test.py
"""
import collections
import json
import pathlib
import random
import sys
import tempfile
import unittest

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[3]
TRACES = pathlib.Path(__file__).with_name("late_traces.txt")
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools/jitter/late"))
from late_oracle import random_tick  # noqa: E402
from late_reason import LoopMonitor, Tick, explain  # noqa: E402
from late_report import Report, add_to_history, read_trace  # noqa: E402
from late_tracefs import Wrong  # noqa: E402


class Kept(unittest.TestCase):
    def setUp(self):
        self.report, self.lines = Report(quiet=True), []
        for seed in range(30):
            trace, tick, usual_us, _ = random_tick(random.Random(seed))
            lines = [*trace.lines[:5], None, *trace.lines[5:]] if seed == 7 else trace.lines
            self.report.add(explain(lines, tick, 50, usual_us).answer(), tick, usual_us, lines)

    def test_a_kept_trace_gives_the_same_answers(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "late.trace")
            path.write_text("".join(self.report.trace(50)), encoding="latin-1")
            again = [explain(lines, Tick(**about), thread, usual_us).answer()
                     for thread, usual_us, about, lines in read_trace(path)]
        self.assertEqual(again, list(self.report.ticks))
        self.assertEqual(again[7]["kind"], "not known")

    def test_a_damaged_trace_is_refused_or_read(self):
        """Never a traceback: a line of events is read as far as it goes."""
        whole, chosen = TRACES.read_bytes(), random.Random(1)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "late.trace")
            for _ in range(300):
                data = bytearray(whole)
                for _ in range(chosen.randrange(1, 30)):
                    data[chosen.randrange(len(data))] = chosen.randrange(256)
                path.write_bytes(data[:chosen.randrange(len(data))])
                try:
                    for thread, usual_us, about, lines in read_trace(path):
                        explain(lines, Tick(**about), thread, usual_us).answer()
                        watching = LoopMonitor(thread, 50, lambda *_: None, 1_000_000)
                        watching.due_ns = round(about["due_us"] * 1000) - 1_000_000
                        for line in lines:
                            watching.feed(line or "CPU:0 [LOST 3 EVENTS]")
                except Wrong as wrong:
                    self.assertIn("name a file that --trace wrote", str(wrong))

    def test_the_json_is_what_its_schema_says(self):
        schema = json.loads((ROOT / "tools/schema/tact-jitter-late.schema.json").read_text())
        watching = LoopMonitor(50, 50, None, 1_000_000)
        watching.period_ns, watching.ticks = 1_000_000, 900
        for thread, usual_us, about, lines in read_trace(TRACES):
            self.report.add(explain(lines, Tick(**about), thread, usual_us).answer(), Tick(**about), usual_us, lines)
        document = json.loads(json.dumps(self.report.to_json("tactd", 50.0, watching, ["nmi/nmi_handler"])))
        jsonschema.validate(document, schema)
        self.assertEqual(sum(row["ticks"] for row in document["names"].values()), 35)
        for wrong in ({"version": 2}, {"format": "x"}, {"more": 1}):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate({**document, **wrong}, schema)

    def test_history_adds_up_and_is_bounded(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "late.json")
            path.write_text(json.dumps({f"{1000 + k}-01-01": {"x": 1} for k in range(500)}))
            want = self.report.new = collections.Counter({"thread a": 3, "softirq b": 4})
            want = want.copy()
            add_to_history(path, self.report)
            add_to_history(path, self.report)  # nothing is new
            self.report.new.update(want)
            add_to_history(path, self.report)
            days = json.loads(path.read_text())
            self.assertEqual((len(days), sum(days[max(days)].values())), (366, 2 * sum(want.values())))
            self.report.new.update({f"name {k}": 100 + k for k in range(50)})
            add_to_history(path, self.report)
            self.assertEqual(len(json.loads(path.read_text())[max(days)]), 8)
            for text in ("{", "[1]", '{"2026-11-30": 3}'):
                path.write_text(text.replace("2026-11-30", max(days)))
                self.report.new.update(x=1)
                with self.assertRaisesRegex(Wrong, "remove it, or name another"):
                    add_to_history(path, self.report)


if __name__ == "__main__":
    unittest.main()
