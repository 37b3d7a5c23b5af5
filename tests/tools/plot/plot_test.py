#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What tact-plot of BUILD_DIR draws is what the CSV of the same log says.

    python3 tests/tools/plot/plot_test.py BUILD_DIR

Needs python3-numpy and python3-matplotlib. Exit status 0 or 1.
"""
import csv
import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools/client"), str(ROOT / "tests/tools/client")]
sys.dont_write_bytecode = True
import tact  # noqa: E402
from recorded_run import LIVER, RecordedRun  # noqa: E402
from run_bytes import byte_of_tick  # noqa: E402

BUILD = pathlib.Path(".")


def tact_plot(*arguments):
    """Status, standard output, standard error."""
    done = subprocess.run([str(BUILD / "tact-plot"), *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def module():
    """tact-plot as a module, to ask it for its lines."""
    loader = importlib.machinery.SourceFileLoader("tact_plot", str(BUILD / "tact-plot"))
    out = importlib.util.module_from_spec(importlib.util.spec_from_loader("tact_plot", loader))
    out.np, out.tact = np, tact
    loader.exec_module(out)
    return out


class Plot(RecordedRun):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        table = cls.folder / "run.csv"
        cls.tactd("--replay", cls.log, "--csv", table)
        lines = [line for line in table.read_text().splitlines() if not line.startswith("#")]
        cls.rows = list(csv.DictReader(lines))

    def test_depth_is_of_the_sphere_that_presses_most_and_has_gaps(self):
        run = module().Run(self.log)
        _, depth_mm = run.quantity("depth", 0, 0)
        _, force_N = run.quantity("force", 0, 0)
        spheres = len([name for name in self.rows[0] if re.fullmatch(r"contact\d+_depth_m", name)])
        self.assertEqual(spheres, len(run.header["spheres"]))
        in_contact = 0
        for row, depth, force in zip(self.rows, depth_mm, force_N):
            deep = [1e3 * float(row[f"contact{i}_depth_m"]) for i in range(1, spheres + 1)
                    if row[f"contact{i}_state_name"] in ("contact", "held")]
            self.assertEqual(bool(deep), not np.isnan(depth))
            if deep:
                in_contact += 1
                self.assertAlmostEqual(depth, max(deep, key=abs), places=4)
            self.assertAlmostEqual(force, np.linalg.norm([float(row[f"force_{axis}_N"]) for axis in "xyz"]), places=9)
        self.assertTrue(100 < in_contact < len(self.rows))
        self.assertGreater(np.nanmax(depth_mm), 5.0)

    def test_its_columns_are_those_of_the_table(self):
        status, out, _ = tact_plot(self.log, "--list")
        self.assertEqual(status, 0)
        names = [line.split()[0] for line in out.splitlines()]
        self.assertEqual(names, [name for name in self.rows[0] if not name.endswith("_name")])
        for name, _, _, values in module().Run(self.log).columns():
            text = self.rows[-1][name]
            if text != "nan":
                self.assertEqual(values[-1], text == "1" if values.dtype == bool else values.dtype.type(text), name)
            else:
                self.assertTrue(np.isnan(values[-1]), name)

    def test_a_figure_is_written_in_the_form_of_its_ending_and_with_the_same_bytes(self):
        for ending, magic in (("pdf", b"%PDF"), ("svg", b"<?xml"), ("png", b"\x89PNG")):
            one, two = self.folder / f"one.{ending}", self.folder / f"two.{ending}"
            for out in (one, two):
                status, _, said = tact_plot(self.log, "--x", "depth", "--out", out)
                self.assertEqual((status, said), (0, ""))
            self.assertTrue(one.read_bytes().startswith(magic))
            self.assertEqual(one.read_bytes(), two.read_bytes())
        self.assertEqual(list(self.folder.glob(".*")), [])

    def test_two_runs_lie_over_each_other_by_utc(self):
        out = self.folder / "both.svg"
        status, _, said = tact_plot(self.log, self.log, "--x", "utc", "--y", "depth", "--y", "force", "--out", out)
        self.assertEqual((status, said), (0, ""))
        plot = module()
        first, second = plot.Run(self.log), plot.Run(self.log)
        second.rows = second.rows.copy()
        second.rows["due_ns"] += 5_000_000_000  # a computer that is up for longer: the same moment has another offset
        second.rows["utc_offset_ns"] -= 5_000_000_000
        start_ns = first.utc_ns()[0]
        self.assertTrue((first.quantity("utc", 0, start_ns)[1] == second.quantity("utc", 0, start_ns)[1]).all())

    def test_refuses_with_the_remedy(self):
        out = self.folder / "no.pdf"
        for arguments, words in (((self.log, "--out", self.folder / "no.xyz"), "its ending is none of"),
                                 ((self.log,), "--out is required"),
                                 ((self.log, "--y", "nothing", "--out", out), "has no nothing; tact-plot"),
                                 ((self.log, "--x", "depth", "--to", "0.01", "--out", out), "no contact there"),
                                 ((self.log, "--from", "100", "--out", out), "has no tick between"),
                                 ((self.log, "--x", "depth", "--sphere", "9", "--out", out), "so no sphere 9"),
                                 ((self.folder / "none", "--out", out), "No such file"),
                                 ((LIVER, "--out", out), "is no file of tact"),
                                 ((self.log, "--out", self.folder / "none" / "no.pdf"), "No such file")):
            status, _, said = tact_plot(*arguments)
            self.assertEqual(status, 2, said)
            self.assertIn(words, said)
            self.assertFalse(out.exists())

    def test_of_a_damaged_log_the_good_ticks_are_drawn(self):
        data, broken, out = bytearray(self.log.read_bytes()), self.folder / "broken.tactlog", self.folder / "broken.pdf"
        first, size = byte_of_tick(self.log, 0)
        data[first + 100 * size + 27] ^= 1
        broken.write_bytes(data)
        status, output, said = tact_plot(broken, "--x", "depth", "--out", out)
        self.assertEqual(status, 1)
        self.assertIn("1 of 3000 ticks are damaged", said)
        self.assertIn("2999 of broken.tactlog", output)
        self.assertTrue(out.exists())

    def test_its_help_has_an_example_that_works(self):
        status, out, _ = tact_plot("--help")
        self.assertEqual(status, 0)
        example = re.search(r"^  tact-plot (run.tactlog --x depth --out fig.pdf)", out, re.M)
        done = subprocess.run([str(BUILD / "tact-plot"), *example[1].split()], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    BUILD = RecordedRun.build = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
