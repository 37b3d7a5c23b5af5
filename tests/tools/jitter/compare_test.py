#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What tact-jitter compare judges, and what it only shows. Its exit status: jitter_report_test.cc.

    python3 tests/tools/jitter/compare_test.py
"""
import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[3] / "tools/jitter/report/tact-jitter-compare"
sys.dont_write_bytecode = True
LOADER = importlib.machinery.SourceFileLoader("jitter_compare", str(SCRIPT))
subject = importlib.util.module_from_spec(importlib.util.spec_from_loader("jitter_compare", LOADER))
LOADER.exec_module(subject)


def result_with(p99_ns):
    return {"format": "tact-jitter", "version": 2, "rate_Hz": 1000,
            "series": {"wake": {"p50_ns": 5000, "p99_ns": p99_ns, "p99.9_ns": None, "max_ns": p99_ns * 9},
                       "read": {"p99_ns": p99_ns}}}


def is_worse(before_ns, after_ns, gate_ratio=0.1):
    return subject.compare(result_with(before_ns), result_with(after_ns), gate_ratio)["worse"]


class Compare(unittest.TestCase):
    def test_fails_on_what_grew_by_more_than_the_gate(self):
        self.assertFalse(is_worse(20_000, 21_900))
        self.assertTrue(is_worse(20_000, 22_100))
        self.assertFalse(is_worse(22_100, 20_000), "better is good")
        self.assertFalse(is_worse(20_000, 90_000, None), "no gate")
        self.assertFalse(is_worse(2_000, 2_900), "below a microsecond nothing is distinguished")

    def test_judges_neither_the_largest_nor_a_percentile_of_too_few_samples(self):
        for value in subject.compare(result_with(20_000), result_with(90_000), 0.1)["values"]:
            self.assertEqual(value["judged"], value["series"] == "wake" and value["share"] in ("p50", "p99"), value)
            self.assertNotEqual(value["share"], "p99.9", "there is none")

    def test_reads_results_of_the_first_version(self):
        old = {"format": "tact-jitter 1", "series": {}}
        self.assertTrue(subject.is_result(old))
        self.assertFalse(subject.is_result({**old, "format": "tact-limits"}))
        self.assertFalse(subject.is_result({}), "no result at all")

    def test_reports_which_conditions_differ(self):
        other = {**result_with(20_000), "rate_Hz": 2000, "environment": {"kernel_release": "6.1.0-rt"}}
        comparison = subject.compare(result_with(20_000), other, 0.1)
        self.assertEqual(comparison["unlike"], ["rate_Hz 1000 and 2000", 'kernel_release null and "6.1.0-rt"'])
        self.assertIn("not alike: rate_Hz 1000 and 2000", subject.text_of(comparison))


if __name__ == "__main__":
    unittest.main()
