#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A picture by gnuplot: SVG and PNG of a table, its script kept beside it; those of tact-lab fit and sweep.

    python3 tests/tools/report/picture_test.py BUILD_DIR

Needs gnuplot. Exit status 0 or 1.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(BUILD / "report"))
import page  # noqa: E402

SIZE = {"width_px": 600, "height_px": 400}
PLAIN = ROOT / "tests/data/scenes/plain.toml"


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tact's pictures ")  # a quote and a space, as people have them
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def lab(self, *arguments, **more):
        return subprocess.run([BUILD / "tact-lab", *arguments], capture_output=True, text=True, check=False, timeout=300, **more)


class Draw(Folder):
    def draw(self, script, name="curve", **variables):
        (self.folder / "own.gp").write_text(script + "\n")
        (self.folder / "curve.csv").write_text("job,x_m,force_N\n0,0,0\n1,0.1,0.3\n2,0.2,1.2\n")
        return page.draw(self.folder, name, self.folder / "own.gp", **SIZE, **variables)

    def test_makes_svg_and_png_of_a_table_and_keeps_the_script(self):
        svg = self.draw("set xlabel 'depth, m'\nplot 'curve.csv' using 2:3 with points title 'force'")
        self.assertIn("<svg", svg)
        self.assertIn("depth, m", svg)
        self.assertEqual((self.folder / "curve.png").read_bytes()[1:4], b"PNG")
        (self.folder / "curve.svg").unlink()
        subprocess.run(["gnuplot", "curve.gp"], cwd=self.folder, check=True)
        self.assertEqual((self.folder / "curve.svg").read_text(), svg, "anyone can draw it again")

    def test_a_script_reads_texts_numbers_lists_and_blocks(self):
        svg = self.draw("set xlabel caption\n"
                        "plot for [i=1:words(list)] $block using 1:($2*factor) with lines title word(list, i)", name="tact's",
                        caption="50 N/m, the liver's", factor=0.5, list=["two words", "gum's"],
                        **{"$block": "x,y\n0,1\n1,2\n"})
        for said in ("50 N/m, the liver's", ">two words<", ">gum's<"):
            self.assertIn(said, svg)

    def test_the_same_script_gives_the_same_bytes(self):
        def bytes_of():
            self.draw("plot 'curve.csv' using 2:3 with lines")
            return [(self.folder / f"curve.{kind}").read_bytes() for kind in ("svg", "png")]
        self.assertEqual(bytes_of(), bytes_of())

    def test_a_broken_script_is_a_failure_that_quotes_gnuplot(self):
        with self.assertRaisesRegex(page.Failure, r"gnuplot drew no .*; its script is .*curve\.gp: (.|\n)*No data"):
            self.draw("plot 'none.csv' using")

    def test_without_gnuplot_it_says_what_to_install(self):
        with unittest.mock.patch.dict(os.environ, {"PATH": str(self.folder)}):
            with self.assertRaisesRegex(page.Failure, "apt install gnuplot-nox"):
                self.draw("plot x")


class Lab(Folder):
    SWEEP = ("sweep", PLAIN, "--vertices", "40", "--depth-m", "0.002", "--json")

    def fit(self):
        rows = "".join(f"{1e-3 * i:g},{0.05 * i:g}\n" for i in range(1, 6))
        (self.folder / "press.csv").write_text("depth_m,force_N\n" + rows)
        return ("fit", PLAIN, "--law", "rhombus", "--data", self.folder / "press.csv", "--picture", self.folder / "fit.svg")

    def test_sweep_names_the_pictures_that_it_has_drawn(self):
        done = self.lab(*self.SWEEP, "--out", self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = json.loads(done.stdout)
        self.assertEqual(report["files"], [f"{self.folder}/presses.{kind}" for kind in ("csv", "json", "svg", "png")])
        self.assertEqual(report["flawed"], [])
        self.assertIn("largest slope", (self.folder / "presses.svg").read_text())
        self.assertEqual((self.folder / "presses.png").read_bytes()[1:4], b"PNG")

    def test_sweep_with_a_failed_check_has_status_one(self):
        done = self.lab(*self.SWEEP, "--out", self.folder, "--limit-N-per-m", "1")
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        self.assertTrue((self.folder / "presses.svg").is_file())

    def test_fit_draws_data_and_laws(self):
        done = self.lab(*self.fit())
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertIn("rhombus", done.stdout)
        svg = (self.folder / "fit.svg").read_text()
        for said in ("data, held out", "rhombus chain, energy form"):
            self.assertIn(said, svg)

    def test_without_gnuplot_both_say_what_to_install(self):
        for words in (self.fit(), (*self.SWEEP, "--out", self.folder)):
            done = self.lab(*words, env={"PATH": "/nonexistent"})
            self.assertEqual((done.returncode, done.stdout), (2, ""), words)
            self.assertEqual(done.stderr, f"tact-lab {words[0]}: gnuplot is not installed; apt install gnuplot-nox\n")


if __name__ == "__main__":
    unittest.main()
