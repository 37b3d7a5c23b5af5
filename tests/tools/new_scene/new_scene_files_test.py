#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What tact-lab new-scene writes: all files or none, and numbers that a scene needs of its organ.

    python3 tests/tools/new_scene/new_scene_files_test.py
"""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools/new_scene"))

import new_scene  # noqa: E402
import run  # noqa: E402


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def path(self, name):
        return str(self.folder / name)

    def made(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_none_appears_where_one_cannot(self):
        with self.assertRaisesRegex(run.Failure, "none/mine.b: cannot be written: No such file or directory"):
            new_scene.write_all([(self.path("mine.a"), b"first"), (self.path("none/mine.b"), b"second")], False)
        self.assertEqual(self.made(), [])
        new_scene.write_all([(self.path("mine.a"), b"first"), (self.path("mine.b"), b"second")], False)
        self.assertEqual(self.made(), ["mine.a", "mine.b"])

    def test_one_that_appears_during_the_work_is_kept(self):
        # Two files of one name: when the second comes to its place, the first is there.
        with self.assertRaisesRegex(run.Failure, "mine.b: exists already and is never overwritten"):
            new_scene.write_all([(self.path(name), b"same") for name in ("mine.a", "mine.b", "mine.b")], False)
        self.assertEqual(self.made(), [], "none of ours stays")
        theirs = self.folder / "mine.c"
        theirs.write_text("theirs")
        files = [(self.path("mine.a"), b"a"), (str(theirs), b"ours")]
        with self.assertRaises(run.Failure):
            new_scene.write_all(files, False)
        self.assertEqual((theirs.read_text(), self.made()), ("theirs", ["mine.c"]))
        new_scene.write_all(files, True)
        self.assertEqual((theirs.read_text(), self.made()), ("ours", ["mine.a", "mine.c"]))

    def test_one_behind_a_link_is_replaced_there(self):
        real, link = self.folder / "real", self.folder / "link"
        real.write_text("old")
        link.symlink_to(real)
        new_scene.write_all([(str(link), b"new")], True)
        self.assertEqual((link.is_symlink(), real.read_text()), (True, "new"))


class Placement(unittest.TestCase):
    ORGAN = {"low_m": [-0.05, -0.04, 0.98], "high_m": [0.05, 0.04, 1.02], "unit_m": 0.001, "colors": True,
             "top": {"vertex": 7, "point_m": [0.01, 0.0, 1.02]}}
    JOB = {"source": "an \"organ\".obj", "is_sound": True, "poisson_ratio": 0.45, "youngs_modulus_Pa": 5000.0,
           "names": {"name": "mine", "map": "a/mine.compliance", "tool": "a/mine_tool.obj", "organ": "a/mine.obj"}}

    def test_holds_the_lowest_tenth_and_presses_no_deeper_than_a_fifth(self):
        # 0.98 to 1.02 m high: a tenth is 4 mm, a fifth 8 mm.
        low_m, high_m = new_scene.held_box(self.ORGAN)
        self.assertAlmostEqual(high_m[2], 0.984, delta=1e-12)
        self.assertLess(low_m[2], 0.98)
        self.assertAlmostEqual(new_scene.working_depth_m(self.ORGAN), 0.008, delta=1e-12)

    def test_becomes_values_of_toml(self):
        text = new_scene.text_of(self.JOB, self.ORGAN, "auto")
        self.assertEqual((text["organ"], text["position_m"], text["vertex_colors"], text["vertex"], text["map"]),
                         ('"an \\"organ\\".obj"', "[-0.01, 0.0, -1.02]", "true", 7, '"mine.compliance"'))
        self.assertEqual((text["press_m"], text["grip_m"], text["pull_N_per_m"]), (0.0064, 0.0032, "50.3"))
        self.assertTrue(text["mesh"].endswith('/an \\"organ\\".obj"'))
        self.assertEqual(new_scene.text_of(self.JOB | {"is_sound": False}, self.ORGAN, "auto")["mesh"], '"mine.obj"')

    def test_gives_a_thin_organ_a_tear_that_its_press_reaches(self):
        # An organ of a tenth of the height presses to a tenth of the depth, and pulls to a tenth of the force.
        thick, thin = (new_scene.text_of(self.JOB, self.ORGAN | {"high_m": [0.05, 0.04, 0.98 + height_m]}, "auto")
                       for height_m in (0.06, 0.006))
        self.assertEqual((thick["tear_force_N"], thin["tear_force_N"]), ("0.4", "0.04"))


if __name__ == "__main__":
    unittest.main()
