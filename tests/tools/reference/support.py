# SPDX-License-Identifier: Apache-2.0
"""What the tests of tools/reference share. Its modules are found after this one."""
import functools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # threads that wait for a core take it from other tests
import numpy as np  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/reference"))

import body  # noqa: E402
import run  # noqa: E402
import surface  # noqa: E402

BUILD = pathlib.Path(sys.argv[1]).resolve()
LIVER = ROOT / "model/scenes/liver.toml"
REFERENCES = ROOT / "tests/data/reference"
needs_calculix = unittest.skipUnless(shutil.which("ccx"), "ccx is not installed; apt install calculix-ccx")


class Solves(unittest.TestCase):
    """Has a folder for what is written on the way."""

    def setUp(self):
        self.enterContext(run.folder_of_run())
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))


def tact_lab(arguments, **settings):
    """Exit status and output."""
    ended = subprocess.run([BUILD / "tact-lab", "reference", *map(str, arguments)], stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, check=False, **settings)
    return ended.returncode, ended.stdout


@functools.cache
def liver():
    """The job that tact-lab hands to reference.py."""
    with tempfile.TemporaryDirectory() as folder:
        program = shutil.copy(BUILD / "tact-lab", folder)
        os.mkdir(f"{folder}/reference")
        pathlib.Path(f"{folder}/reference/reference.py").write_text("import sys\nprint(open(sys.argv[1]).read())\n")
        return json.loads(subprocess.check_output([program, "reference", LIVER, "--tool"]))


def ball(radius_m, rounds):
    """Points (n, 3) and triangles (t, 3) of a sphere, from an octahedron; point 2 is its pole +z."""
    point = np.vstack([np.eye(3), -np.eye(3)])
    triangle = np.array([[0, 1, 2], [0, 2, 4], [0, 4, 5], [0, 5, 1], [3, 2, 1], [3, 4, 2], [3, 5, 4], [3, 1, 5]])
    for _ in range(rounds):
        key = surface.edges_of(triangle)[1]
        edges = np.unique(key)
        (a, b, c), (ab, bc, ca) = triangle.T, surface.middle_of(edges, key, len(point)).T
        point = np.vstack([point, surface.unit(point[edges >> 32] + point[edges & 0xFFFFFFFF])])
        triangle = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return radius_m * point, triangle


def organ_of(vertex_m, triangle, normal):
    """Held nowhere; its vertices look along their normals (V, 3)."""
    return body.Organ(vertex_m, triangle, normal, np.full(3, 9.0), np.full(3, 9.0), 5000.0, 0.45)
