#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-lab stability as a person meets it, and each of its findings on a table that breaks it.

    python3 tests/tools/stability/stability_test.py BUILD_DIR

Every map is run on its coarse extent: each finding is a theorem of the method it measures. Exit status 0 or 1.
"""
import copy
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(BUILD / "stability"))
import findings  # noqa: E402

MAPS = ("integrators", "law_limits", "law_lines", "loop", "loop_laws", "loop_delta", "ticks", "loss")
FOUGHT, OUT = {"beyond_the_line": findings.FOUGHT}, {"beyond_the_line": "OUT OF BOUNDS"}
LOOP = {"theory_grow_N_per_m": 1000.0, "theory_safe_N_per_m": 500.0, "largest_without_growth_N_per_m": 1000.0,
        "largest_at_rest_N_per_m": 500.0, **FOUGHT}
LOSS = {"rate_Hz": 1000.0, "hold_gift_J": 2.0, "gate_gift_J": 1.0, "gate_max_step_N": 1.0, "gate_force_N": 0.0}
DELTA = {"controller_over_theory": 1.0, "controller_N_per_m": 900.0, "one_degree_N_per_m": 900.0}
LINES = {"disc_cone": [0.5], "disc_rate": [3.0], "rhombus_snap": [0.5], "hex_ring": [1.0, 1.0, 2.0], "hex_node": [1.0, 1.0, 4.0],
         "hex_sheet": [1.0, 1.0, 1.0]}
GOOD = {  # rows that keep every finding
    "integrators": [{"method": "RK4", "z": 1.0, "zeta": 0.1, "theory_growth_per_step": 1.0, "measured_growth_per_step": 1.0,
                     "theory": "bounded", "measured": "bounded"}],
    "law_limits": [{"depth_ratio": 0.5, "force_N": 1.0, "status": "ok", "gate": "in bounds"},
                   {"depth_ratio": 2.0, "force_N": 1.0, "status": "saturated", "gate": "in bounds"}],
    "law_lines": [{"study": study, "measured": value, "theory": value, "what_happens": "grows to flat"}
                  for study, values in LINES.items() for value in values],
    "loop": [{**LOOP, "hand": "bare", "friction_N": 0.0}, {**LOOP, "hand": "firm", "friction_N": 0.1},
             *({**LOOP, "hand": hand, "friction_N": friction, "largest_without_growth_N_per_m": 1500.0}  # a bound alone
               for hand, friction in (("firm", 0.0), ("bare", 0.1)))],
    "loop_laws": [{"law": "rhombus", "measured_over_theory": 1.0, **FOUGHT},
                  {"law": "nodes", "measured_over_theory": 3.0, **FOUGHT}],
    "loop_delta": [{**DELTA, "beyond_the_line": findings.BOUNCES}, {**DELTA, "beyond_the_line": "comes to rest"}],
    "ticks": [{"measured_over_theory": 1.0, **FOUGHT}],
    "loss": [{**LOSS, "lost_in_a_row": 19.0, "state": "zero"}, {**LOSS, "lost_in_a_row": 20.0, "state": "latched"}],
}
FACTS = {"loop_laws": {"with_memory": ["nodes"]}, "loss": {"slew_N_per_s": 1000.0}}
HEX = len(GOOD["law_lines"]) - 1  # row of the largest sheet
BREAKS = [  # map, finding, row and what it has in place of the good values
    ("integrators", 0, 0, {"measured": "grows"}), ("integrators", 1, 0, {"measured_growth_per_step": 1.002}),
    ("law_limits", 0, 0, {"force_N": None}), ("law_limits", 1, 1, {"status": "ok"}),
    ("law_limits", 2, 0, {"gate": "OUT OF BOUNDS"}),
    ("law_lines", 0, 0, {"measured": 0.502}), ("law_lines", 0, 0, {"what_happens": "snaps through"}),
    ("law_lines", 0, 0, {"measured": -0.5, "theory": -0.5}), ("law_lines", 1, 1, {"measured": 4.0}),
    ("law_lines", 2, 2, {"measured": 0.53}), ("law_lines", 3, HEX - 6, {"measured": 1.6}),
    ("law_lines", 3, HEX - 3, {"measured": 2.8}),
    ("law_lines", 4, HEX, {"measured": 1.002}), ("loop", 0, 1, {"largest_without_growth_N_per_m": 940.0}),
    ("loop", 1, 1, {"largest_at_rest_N_per_m": 470.0}), ("loop", 2, 0, {"largest_without_growth_N_per_m": 1260.0}),
    ("loop", 3, 0, OUT), ("loop_laws", 0, 0, {"measured_over_theory": 1.21}), ("loop_laws", 0, 0, {"measured_over_theory": 0.89}),
    ("loop_laws", 1, 1, {"measured_over_theory": 0.89}), ("loop_laws", 2, 1, OUT),
    ("loop_delta", 0, 0, {"controller_over_theory": 1.31}), ("loop_delta", 0, 1, {"controller_over_theory": 0.84}),
    ("loop_delta", 1, 0, {"controller_N_per_m": 700.0}), ("loop_delta", 1, 0, {"controller_N_per_m": 1200.0}),
    ("loop_delta", 2, 1, OUT), ("loop_delta", 2, 0, {"beyond_the_line": "comes to rest"}),
    ("ticks", 0, 0, {"measured_over_theory": 1.51}), ("ticks", 0, 0, {"measured_over_theory": 0.69}),
    ("ticks", 1, 0, OUT), ("ticks", 1, 0, {"beyond_the_line": "stays below the limits of the gate"}),
    ("loss", 0, 1, {"gate_force_N": 0.1}), ("loss", 1, 0, {"state": "latched"}), ("loss", 1, 1, {"state": "fading"}),
    ("loss", 2, 0, {"gate_gift_J": 2.5}), ("loss", 3, 0, {"gate_max_step_N": 1.01}),
]


def found(name, rows):
    return findings.findings_of(name, rows, FACTS.get(name, {}))


class Findings(unittest.TestCase):
    def test_hold_on_a_good_table(self):
        self.assertEqual(set(GOOD), set(findings.CHECKS))
        for name, rows in GOOD.items():
            for one in found(name, rows):
                self.assertTrue(one["holds"], one["sentence"])

    def test_break_one_by_one(self):
        for name, index, row, values in BREAKS:
            rows = copy.deepcopy(GOOD[name])
            rows[row] |= values
            self.assertEqual([i for i, one in enumerate(found(name, rows)) if not one["holds"]], [index], (name, values))
        for name, rows in GOOD.items():
            self.assertEqual({index for broken, index, *_ in BREAKS if broken == name}, set(range(len(found(name, rows)))), name)

    def test_a_number_that_is_none_breaks_what_reads_it(self):
        for name, index, row, values in BREAKS:
            for column in [key for key, value in values.items() if not isinstance(value, str)]:
                rows = copy.deepcopy(GOOD[name])
                rows[row][column] = None
                self.assertFalse(found(name, rows)[index]["holds"], (name, column))

    def test_have_their_numbers_by_name(self):
        self.assertEqual([one["numbers"] for one in found("loop", GOOD["loop"])], [
            {"below": 0.0, "least_ratio": 1.0}, {}, {"bare": 1.0, "bare_least_ratio": 1.0, "bare_largest_ratio": 1.0},
            {"held": 4.0, "at_the_limits": 4.0}])
        self.assertEqual(found("loop_delta", GOOD["loop_delta"])[0]["numbers"], {"least_ratio": 1.0, "largest_ratio": 1.0})
        self.assertEqual(found("integrators", GOOD["integrators"])[0]["numbers"], {"agree_percent": 100.0})
        self.assertEqual(found("loop_delta", [{**GOOD["loop_delta"][0], "controller_over_theory": None}])[0]["numbers"],
                         {"least_ratio": None, "largest_ratio": None})


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tact's stability ")  # a quote and a space, as people have them
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "maps"

    def run_it(self, *arguments, out=None, **more):
        to = ("--out", out or self.out) if out != "" else ()
        return subprocess.run([BUILD / "tact-lab", "stability", *arguments, *to], capture_output=True, text=True, check=False,
                              **more)

    def test_help_names_every_map(self):
        done = self.run_it("--help", out="")
        self.assertEqual(done.returncode, 0)
        for word in (*MAPS, "Exit status", "--only"):
            self.assertIn(word, done.stdout)

    def test_bad_options_are_one_line_and_status_two(self):
        for bad, out in (([], ""), (["--map", "e"], None), (["--only", "none"], None), (["--nonsense"], None),
                         (["--only", "loss"], "/proc/none")):
            done = self.run_it(*bad, out=out)
            self.assertEqual((done.returncode, done.stdout), (2, ""), bad)
            self.assertRegex(done.stderr, r"\Atact-lab stability: [^\n]+\n\Z")

    def test_every_map_finds_what_it_must_and_has_its_picture(self):
        done = self.run_it("--quick", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        reports = json.loads(done.stdout)["maps"]
        self.assertEqual([report["map"] for report in reports], list(MAPS))
        for report in reports:
            name = report["map"]
            self.assertGreaterEqual(len(report["findings"]), 2, name)
            for one in report["findings"]:
                self.assertTrue(one["holds"], one["sentence"])
            kinds = ("csv", "json") if name == "loop_delta" else ("csv", "json", "svg", "png")
            self.assertEqual(report["files"], [f"{self.out}/{name}.{kind}" for kind in kinds])
            self.assertEqual(report["rows"], len(json.loads((self.out / f"{name}.json").read_text())["rows"]))
            for kind in kinds:
                self.assertGreater((self.out / f"{name}.{kind}").stat().st_size, 300, name)
        again = subprocess.run(["gnuplot", "-e", "kind='svg'", "loss.gp"], cwd=self.out, capture_output=True, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_a_second_run_gives_the_same_bytes(self):
        first, second = self.out / "first", self.out / "second"
        for folder in (first, second):
            for name in ("ticks", "law_limits"):
                self.assertEqual(self.run_it("--quick", "--only", name, out=folder).returncode, 0)
        for file in first.iterdir():
            self.assertEqual(file.read_bytes(), (second / file.name).read_bytes(), file.name)

    def test_without_gnuplot_the_tables_are_judged_all_the_same(self):
        done = self.run_it("--quick", "--only", "loss", env={**os.environ, "PATH": "/nonexistent"})
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "tact-lab stability: gnuplot is not installed; apt install gnuplot-nox\n")
        self.assertIn("  ok    20 lost in a row latch, 19 do not\n", done.stdout)
        self.assertTrue((self.out / "loss.csv").is_file())
        self.assertEqual(self.run_it("--quick", "--only", "loss", "--no-pictures", env={"PATH": "/nonexistent"}).returncode, 0)

    def test_ctrl_c_reports_the_maps_that_were_finished(self):
        with subprocess.Popen([BUILD / "tact-lab", "stability", "--map", "c", "--quick", "--json", "--out", self.out],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
            while not (self.out / "loop.json").is_file():  # then come two others
                self.assertIsNone(child.poll())
                time.sleep(0.01)
            child.send_signal(signal.SIGINT)
            printed, said = child.communicate(timeout=120)
        self.assertEqual(child.returncode, 1, said)
        reports = json.loads(printed)["maps"]
        self.assertIn([report["map"] for report in reports], (["loop"], ["loop", "loop_laws"]))
        self.assertTrue(reports[0]["findings"])
        self.assertIn(f"tact-lab stability: interrupted; {len(reports)} maps are written\n", said)


if __name__ == "__main__":
    unittest.main()
