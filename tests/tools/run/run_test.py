#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/run with a mesh: felt at once by the tip's own law, then by the map that was made meanwhile; Ctrl-C leaves nothing.

    tests/tools/run/run_test.py BUILD_DIR
"""
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()


def ball_stl(rings, sectors):
    """An ellipsoid of 100 x 80 x 60 mm."""
    def point(i, j):
        polar, turn = math.pi * i / rings, 2 * math.pi * (j % sectors) / sectors
        return (50 * math.sin(polar) * math.cos(turn), 40 * math.sin(polar) * math.sin(turn), 30 * math.cos(polar))
    text = "solid organ\n"
    for i in range(rings):
        for j in range(sectors):
            for face in (((i, j), (i + 1, j), (i + 1, j + 1)), ((i, j), (i + 1, j + 1), (i, j + 1))):
                corners = [point(*at) for at in face]
                if len(set(corners)) == 3:
                    text += "facet normal 0 0 0\nouter loop\n"
                    text += "".join("vertex %.6f %.6f %.6f\n" % corner for corner in corners) + "endloop\nendfacet\n"
    return text + "endsolid organ\n"


class Run(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        tree = self.folder / "tree"  # tools/run builds in the tree where it is
        tree.mkdir()
        for name in ("tools", "model", "host"):
            (tree / name).symlink_to(ROOT / name)
        (tree / "build").symlink_to(BUILD)
        (self.folder / "tmp").mkdir()
        self.command = [str(tree / "tools" / "run")]

    def start(self, *arguments):
        return subprocess.Popen(self.command + list(arguments), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, start_new_session=True, env=os.environ | {"TMPDIR": str(self.folder / "tmp")})

    def test_a_mesh_has_force_immediately_and_then_by_its_map(self):
        (self.folder / "organ.stl").write_text(ball_stl(12, 18))
        run = self.start("organ.stl", "--youngs-modulus-Pa", "4000", "--headless", "--seconds", "1",
                         "--", "--no-telemetry", "--no-black-box")
        text = run.communicate(timeout=500)[0]
        self.assertEqual(run.returncode, 0, text)
        first, marker, rest = text.partition("until the map of the organ is made")
        self.assertTrue(marker, text)
        self.assertNotIn("condense  ", first)
        order = [rest.find(word) for word in ("factoring: about", "vertices, 20 rings", "law rhombus", "elastic compliance")]
        self.assertEqual(order, sorted(order), text)
        self.assertGreaterEqual(order[0], 0, text)
        self.assertIn("youngs_modulus_Pa = 4000", (self.folder / "organ.toml").read_text())
        self.assertEqual(sorted(path.name for path in self.folder.glob("organ*")),
                         ["organ.compliance", "organ.obj", "organ.stl", "organ.toml", "organ_tool.obj"])
        again = self.start("organ.stl", "--headless")
        self.assertIn("organ.toml is there already; start it by tools/run organ.toml", again.communicate(timeout=100)[0])
        self.assertEqual(again.returncode, 2)

    def test_ctrl_c_ends_all_of_it_and_leaves_no_scratch(self):
        (self.folder / "organ.stl").write_text(ball_stl(60, 80))
        run = self.start("organ.stl", "--headless", "--", "--no-telemetry", "--no-black-box")
        text = ""
        while "filling with elements" not in text:
            line = run.stdout.readline()
            self.assertTrue(line, text)
            text += line
        begun = time.monotonic()
        os.killpg(run.pid, signal.SIGINT)  # as a terminal does
        while "interrupted; nothing was written" not in text:
            line = run.stdout.readline()
            self.assertTrue(line, text)
            text += line
        self.assertLess(time.monotonic() - begun, 1.0, text)
        text += run.communicate(timeout=60)[0]
        self.assertIn(run.returncode, (0, 130), text)
        self.assertEqual(list((self.folder / "tmp").iterdir()), [], text)
        left = subprocess.run(["pgrep", "-r", "R,S,D,T", "-s", str(run.pid)], capture_output=True, text=True)
        self.assertEqual(left.stdout, "", text)
        self.assertFalse((self.folder / "organ.compliance").exists())


if __name__ == "__main__":
    unittest.main()
