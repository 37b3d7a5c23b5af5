#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page of tact-limits claims what limits.json says and no more, and a page that fails leaves all results and a message.

    python3 tests/tools/limits/page_test.py build
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
import limits_page  # noqa: E402

NOT_OPENED = "set in software: the contact was not opened"


def run(folder, *arguments):
    return subprocess.run([BUILD / "tact-limits", ROOT / "model/scenes/liver.toml", "--out", folder, "--no-pictures", *arguments],
                          capture_output=True, text=True, check=False, timeout=120)


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.done = run(cls.folder, "--plan", "step,e-stop,device-fault,power,continuous", "--json", "--location",
                       "room <1> & {{tester}}")
        cls.kept = json.loads((cls.folder / "limits.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        self.data = copy.deepcopy(self.kept)

    def page(self, pictures=None):
        return limits_page.html_of(self.data, pictures)

    def test_of_the_program_is_that_of_its_json(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        self.assertEqual(json.loads(self.done.stdout), self.kept)
        self.assertEqual((self.folder / "limits.html").read_text(), self.page())

    def test_text_from_outside_stays_text(self):
        page = self.page()
        self.assertIn("<td>room &lt;1&gt; &amp; {{tester}}</td>", page)
        self.assertEqual(page.count("{{"), 2, "of place and command")

    def test_each_limit_has_its_criterion_and_its_three_values(self):
        for key, value in (("scene_value", 3.0), ("value", 2.0), ("on_this_pc", 0.5)):
            self.data["limits"][0][key] = value
        page = self.page()
        self.assertIn("<td class=n>3 N</td><td class=n>2 N</td><td class=n>0.5 N</td>", page)
        self.assertEqual(page.count("at most the limit; zero unless armed, and from a latched fault on"), 2)
        self.assertEqual(page.count("made tighter in power"), 1)
        self.assertEqual(page.count(" Here at most "), 2)
        self.assertIn(" Here at most 4 N RMS over 0.5 s.", page)
        self.assertEqual(page.count(" at the largest speed"), 2, "where 20 W and 0.1 J come from")

    def test_each_case_says_what_it_asked(self):
        page = self.page()
        self.assertEqual(page.count("Asked besides every limit: the stage "), 5)
        self.assertIn("the fault &quot;device failed&quot; latched; zero ", page)
        self.assertIn("; <b>device failed</b></td>", page)

    def test_a_part_of_the_plan_is_not_green_and_names_the_rest(self):
        page = self.page()
        self.assertEqual(page.count('class="verdict part sim"'), 1)
        self.assertEqual(page.count(".verdict.sim{background:#"), 1)
        for out in self.data["not_run"]:
            self.assertIn(out["case"], page)
        self.data["not_run"] = []
        self.assertIn('class="verdict pass sim"', self.page())

    def test_a_failed_case_is_red_and_says_why(self):
        self.data["cases"][0]["passed"] = False
        self.data["cases"][0]["checks"][0] = {"holds": False, "sentence": "9 N of 8 N"}
        page = self.page()
        self.assertIn("FAIL: 1 of 5 cases", page)
        self.assertIn("<li class=bad>9 N of 8 N</li>", page)
        self.assertNotIn("verdict p", page)

    def test_a_run_of_nothing_is_red(self):
        self.data["cases"], self.data["cases_played"] = [], 0
        self.assertIn("FAIL: no case was played", self.page())

    def test_a_real_device_says_that_no_contact_was_opened(self):
        self.assertNotIn("set in software", self.page())
        self.data["simulated"] = False
        self.data["cases"][1]["cause"] = NOT_OPENED
        page = self.page()
        self.assertEqual(page.count(NOT_OPENED), 1)
        self.assertIn("Nor that a contact of the emergency stop", page)
        self.assertNotIn("SIMULATED", page)

    def test_annex_a_has_result_date_and_revision(self):
        test = self.data["hazard_table"]["tests"][0]
        test.update(result="pass", date="2026-11-30", revision="1a2b3c")
        self.assertIn("<td class=keep><span class=ok>pass</span></td><td class=keep>2026-11-30<br>1a2b3c", self.page())

    def test_pictures_stand_within_the_page(self):
        drawn = limits_page.pictures_of(self.data, self.folder)
        page = self.page(drawn)
        self.assertIn("<svg", page)
        self.assertNotIn("<?xml", page)
        for loaded in (" src=", "<link", "<script", "@import"):
            self.assertNotIn(loaded, page)

    def test_a_page_that_fails_is_one_message_and_status_two(self):
        script = BUILD / "report/limits_page.py"
        for text in ("{}", "no JSON"):
            with tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "limits.json").write_text(text)
                done = subprocess.run([sys.executable, "-I", script, folder, "--no-pictures"], capture_output=True, text=True,
                                      check=False)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(f"tact-limits: {folder}/limits.html is not written: limits.json is not as expected", done.stderr)
                self.assertNotIn("Traceback", done.stderr)

    def test_a_folder_in_the_place_of_the_page_keeps_the_results(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "limits.html").mkdir()
            done = run(folder, "--plan", "step")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("limits.html is not written: ", done.stderr)
            self.assertTrue(json.loads((pathlib.Path(folder) / "limits.json").read_text())["passed"])

    def test_without_gnuplot_there_is_a_page_without_pictures(self):
        done = subprocess.run([sys.executable, "-I", BUILD / "report/limits_page.py", self.folder, "--status", "1"],
                              capture_output=True, text=True, check=False, env={"PATH": "/nonexistent"})
        self.assertEqual(done.returncode, 1)
        self.assertIn("no pictures: gnuplot is not installed; apt install gnuplot-nox", done.stderr)
        self.assertEqual((self.folder / "limits.html").read_text(), self.page())


if __name__ == "__main__":
    unittest.main()
