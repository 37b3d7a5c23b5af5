#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-jitter history reads what a tactd wrote, files made here by the format's description, and damaged ones.

    python3 tests/tools/jitter/history_test.py build
"""
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPT = ROOT / "tools/jitter/report/tact-jitter-history"
COUNT, SIZE, HEAD = 105120, 19, 24


def checked(body):
    value = 14695981039346656037
    for byte in body:
        value = ((value ^ byte) * 1099511628211) & (1 << 64) - 1
    return body + struct.pack("<H", (value ^ value >> 16 ^ value >> 32 ^ value >> 48) & 0xFFFF)


def history(records):
    """{interval: (wake, tick, force in 0.1 us, skipped, late, limits, fault)} as the bytes of a file."""
    data = bytearray(struct.pack("<8sIIII", b"tacthist", 1, 300, COUNT, SIZE))
    for interval, values in records.items():
        at = HEAD + interval % COUNT * SIZE
        data.extend(bytes(max(0, at + SIZE - len(data))))
        data[at:at + SIZE] = checked(struct.pack("<IHHHHHHB", interval + 1, *values))
    return bytes(data)


class History(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name, "year.tacthistory")
        self.addCleanup(self.folder.cleanup)

    def said(self, *arguments, **environment):
        return subprocess.run([SCRIPT, *arguments], capture_output=True, text=True, env={**os.environ, **environment})

    def test_prints_the_largest_and_the_sums_of_each_day(self):
        day = 20000 * 288  # 2024-10-04
        self.path.write_bytes(history({day: (45, 30, 60, 1, 2, 1 << 5, 0), day + 287: (40, 31, 59, 3, 0, 1 << 12, 105),
                                       day + 288: (65535, 1, 65535, 0, 0, 0, 0)}))
        lines = self.said(self.path).stdout.splitlines()
        self.assertEqual(lines[1].split(), ["2024-10-04", "4.5", "3.1", "6.0", "4", "2", "continuous", "force,", "force;",
                                            "fault", "105"])
        self.assertEqual(lines[2].split(), ["2024-10-05", ">6554", "0.1", ">6554", "0", "0", "-"])
        self.assertEqual(len(self.said(self.path, "--days", "1").stdout.splitlines()), 2)

    def test_says_who_made_ticks_late(self):
        day = 20000 * 288
        self.path.write_bytes(history({day: (45, 30, 60, 1, 2, 0, 0), day + 288: (40, 31, 59, 3, 0, 0, 0)}))
        causes = self.path.with_name("late.json")
        causes.write_text('{"2024-10-04": {"page fault": 2, "thread hog": 30}, "2024-10-09": {"x": 1}}')
        lines = self.said(self.path).stdout.splitlines()
        self.assertRegex(lines[1], "; late by thread hog 30, page fault 2$")
        self.assertNotIn("late by", lines[2])
        for text in ("[", "[1]", '{"2024-10-04": 3}', '{"2024-10-04": {"x": "y"}}'):
            causes.write_text(text)
            run = self.said(self.path)
            self.assertEqual((run.returncode, "late.json: " in run.stderr), (2, True), text)

    def test_any_damaged_byte_loses_one_record_at_most(self):
        day = 20000 * 288
        whole = history({day + 288 * k: (45, 30, 60, 1, 2, 0, 0) for k in range(3)})
        chosen = random.Random(1)
        for _ in range(25):
            at = HEAD + (day + 288) % COUNT * SIZE + chosen.randrange(SIZE)
            data = bytearray(whole)
            data[at] ^= 1 << chosen.randrange(8)
            self.path.write_bytes(data)
            run = self.said(self.path)
            self.assertEqual((run.returncode, len(run.stdout.splitlines())), (1, 3), run.stderr)
            self.assertIn("1 records are torn", run.stderr)

    def test_refuses_another_file_with_a_remedy(self):
        for content in (b"", b"x" * 100, whole_head_of(0), None):
            if content is None:
                self.path.unlink()
            else:
                self.path.write_bytes(content)
            run = self.said(self.path)
            self.assertEqual(run.returncode, 2, content)
            self.assertRegex(run.stderr, f"^tact-jitter: {self.path}: .*(name|move|tactd)")

    def test_draws_a_picture(self):
        self.path.write_bytes(history({20000 * 288 + k: (45, 30, 60, k % 7 == 0, 0, 0, 0) for k in range(0, 80000, 500)}))
        picture = self.path.with_suffix(".svg")
        run = self.said(self.path, "--out", picture)
        self.assertEqual(run.returncode, 0, run.stderr)
        for words in ("last day", "last 30 days", "last 365 days", "periods skipped"):
            self.assertTrue(f"<!-- {words} -->" in picture.read_text(), words)

    def test_reads_what_tactd_wrote(self):
        build = pathlib.Path(BUILD)
        subprocess.run([build / "tactd", ROOT / "model/scenes/liver.toml", "--seconds", "0.3", "--no-telemetry", "--set",
                        'device.kind="sim-delta"'], env={**os.environ, "XDG_STATE_HOME": self.folder.name}, check=True,
                       capture_output=True)
        run = subprocess.run([build / "tact-jitter", "history"], env={**os.environ, "XDG_STATE_HOME": self.folder.name},
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout.splitlines()[1], r"^\d{4}-\d\d-\d\d +>?[\d.]+ +[\d.]+ +>?[\d.]+ +\d+ +\d+  ")


def whole_head_of(interval_s):
    return struct.pack("<8sIIII", b"tacthist", 1, interval_s, COUNT, SIZE)


if __name__ == "__main__":
    BUILD = sys.argv.pop(1)
    unittest.main()
