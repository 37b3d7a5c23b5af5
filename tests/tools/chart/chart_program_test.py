#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-lab chart and plan as a person meets them, and their picture; tables and choice in chart_report_test.py beside this.

    python3 tests/tools/chart/chart_program_test.py BUILD_DIR

Times are never asserted. Needs python3-matplotlib. Exit status 0 or 1.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from chart_report_test import JOB, RESULTS, ROOT, row  # noqa: E402  it finds the modules of tools/chart

import picture  # noqa: E402
import scenes  # noqa: E402
import tables  # noqa: E402

BUILD = pathlib.Path(sys.argv[1]).resolve()
SCENES, REFERENCES = ROOT / "model/scenes", ROOT / "tests/data/reference"


class Picture(unittest.TestCase):
    FINITE = json.loads((RESULTS / "finite_strain.json").read_text())["values"]
    SHIPPED = json.loads((RESULTS / "scenes.json").read_text())["values"]

    def test_takes_finite_strain_where_there_is_a_result(self):
        shipped = scenes.shipped_of(self.SHIPPED, self.FINITE)
        self.assertEqual({name for name, s in shipped.items() if s.error.reference == scenes.FINITE}, {"liver"})
        self.assertAlmostEqual(abs(shipped["liver"].error.percent), self.FINITE["worst_percent"])
        self.assertEqual(shipped["heart"].error.percent, self.SHIPPED["heart"]["own_percent"])
        self.assertEqual(scenes.shipped_of(self.SHIPPED, {})["liver"].error.percent, self.SHIPPED["liver"]["own_percent"])

    def test_has_the_committed_figures_of_every_law_from_light_touch_on(self):
        found = scenes.errors_of(SCENES, self.FINITE)
        self.assertEqual(set(found), set(self.SHIPPED))
        for name, value in self.SHIPPED.items():
            self.assertIn(value["law"], found[name])
        self.assertAlmostEqual(found["gum"]["spring_patch"].percent, self.SHIPPED["gum"]["own_percent"], places=1)
        self.assertEqual(found["liver"]["hex_sheet"].reference, scenes.LINEAR)
        self.assertEqual(found["liver"]["compliance"].reference, scenes.FINITE)

    def drawn(self, folder, **more):
        peers = tables.read_rows(json.loads((RESULTS / "peers.json").read_text())["rows"], "peers.json")
        rows = [row(us, error, family=law) for law, us, error in
                (("rhombus", 3.9, 0.09), ("compliance", 1.6, 0.081), ("hex_sheet", 3.8, 0.45), ("spring_patch", 15.0, 0.081))]
        job = {**JOB, "out": folder, "scene": {"name": "liver", "path": str(SCENES / "liver.toml"), "law": "rhombus"},
               "scenes": str(RESULTS / "scenes.json"), **more}
        return picture.draw(rows + peers, job)

    def test_shows_laws_scenes_peers_and_units(self):
        with tempfile.TemporaryDirectory() as folder:
            svg, png = self.drawn(folder)
            text = svg.read_text()
            self.assertGreater(png.stat().st_size, 20_000)
            for word in ("rhombus", "peer: bullet volume", "shipped scene, finite strain", "median, us", "% of the force there",
                         *self.SHIPPED, "AMD EPYC"):
                self.assertIn(f"{word}", text)
            self.assertIn("8667 %", text, "what lies above has its number")

    def test_shows_laws_alone_without_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            text = self.drawn(folder, scenes="")[0].read_text()
            self.assertIn("compliance", text)
            self.assertNotIn("heart", text)

    def test_no_name_covers_another_or_a_mark(self):
        plot = picture.pyplot()
        figure, axes = plot.subplots(dpi=100)
        axes.set(xscale="log", yscale="log", xlim=(0.1, 100), ylim=(1, 500))
        points = [(1.1 + 0.6 * i, 4 + 0.8 * i, f"scene {i}") for i in range(4)]
        picture.place_names(figure, axes, points, [(2.0, 4.0)])
        boxes = [text.get_window_extent(figure.canvas.get_renderer()) for text in axes.texts]
        self.assertEqual(len(boxes), 4)
        marks = [axes.transData.transform(point[:2]) for point in points]
        for i, box in enumerate(boxes):
            self.assertFalse(any(box.overlaps(other) for other in boxes[:i]))
            self.assertFalse(any(box.contains(*mark) for mark in marks))
        plot.close(figure)


class Program(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def ran(self, program, *arguments, status=0):
        done = subprocess.run([BUILD / program, *arguments], capture_output=True, text=True,
                              env={**os.environ, "XDG_CACHE_HOME": str(self.folder)})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def lab(self, *arguments, status=0):
        return self.ran("tact-lab", *arguments, status=status)

    def test_says_what_is_missing(self):
        liver, out = SCENES / "liver.toml", self.folder / "out"
        self.assertIn("give --reference FILE", self.lab("plan", liver, status=2))
        self.assertIn("--tool-reference", self.lab("chart", liver, "--out", out, status=2))
        self.assertIn("tact-lab reference", self.lab("chart", liver, "--out", out, "--reference", "none.json", status=2))
        # A figure is of the scene's own laws.
        self.lab("chart", liver, "--out", out, "--reference", "a", "--tool-reference", "b", "--accuracy", "c", status=2)
        bad = self.folder / "bad.json"
        bad.write_text('{"format": "tact-chart", "version": 4, "rows": [{}]}')
        self.assertIn("bad.json: a row has no kind; make it again", self.lab("plan", liver, "--chart", bad, status=2))

    def test_tactd_takes_the_plan_of_a_chart(self):
        liver, out = SCENES / "liver.toml", self.folder / "out"
        said = self.lab("chart", liver, "--reference", REFERENCES / "liver.json", "--quick", "--laws", "rhombus,disc_stack",
                        "--out", out, "--peers", RESULTS / "peers.json", "--scenes", RESULTS / "scenes.json")
        for name in ("chart.csv", "chart.json", "chart.svg", "chart.png"):
            self.assertIn(f"{out}/{name}\n", said)
            self.assertTrue((out / name).stat().st_size > 0)
        said = self.lab("plan", liver, "--chart", out / "chart.json")
        law = said.split()[0]
        written = said.splitlines()[-1]
        self.assertIn(f'law = "{law}"', pathlib.Path(written).read_text())
        said = self.ran("tactd", liver, "--set", "law=auto", "--check")
        self.assertRegex(said, rf'law "auto" is --set law={law}')
        self.assertNotIn("no plan of this machine", said)

    def test_tactd_reports_the_accuracy_that_was_measured(self):
        scene = self.folder / "heart.toml"
        for path in [SCENES / "heart.toml", *SCENES.glob("heart.*")]:
            (self.folder / path.name).write_bytes(path.read_bytes())
        (self.folder / "meshes").symlink_to(SCENES / "meshes")
        accuracy = self.folder / "heart.accuracy"
        committed = accuracy.read_text()
        self.lab("chart", scene, "--tool-reference", REFERENCES / "heart_tool.json", "--quick", "--laws", "rhombus", "--out",
                 self.folder, "--accuracy", accuracy)

        def figures(text):
            return re.sub(r"date = .*\n", "", text[text.index("[rhombus]"):].split("\n\n")[0]).strip()
        self.assertEqual(figures(accuracy.read_text()), figures(committed))
        self.assertIn("force of the whole tool: 0.4 % of the peak off", self.ran("tactd", scene, "--check"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
