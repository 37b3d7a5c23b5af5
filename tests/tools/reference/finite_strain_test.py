# SPDX-License-Identifier: Apache-2.0
"""The whole tool at finite strain: the coarser surface far away, each program on a small body."""
import importlib.util
import types
import unittest

import numpy as np

from support import Solves, ball, liver, needs_calculix, organ_of

import body
import calculix
import coarsen
import fenicsx
import finite_strain
import job
import self_check
import surface
from run import Failure

DOWN, RADIUS_M = np.array([0.0, 0.0, -1.0]), 5e-3
needs_fenicsx = unittest.skipUnless(importlib.util.find_spec("dolfinx"),
                                    "dolfinx is not installed; apt install python3-dolfinx python3-dolfinx-real")


def press(solver, depths_m=(1e-3,), centre_m=((0.0, 0.0, RADIUS_M),)):
    """Of spheres of 5 mm on the top of a block, on the roughest mesh."""
    return finite_strain.FinitePress(tuple(DOWN), centre_m, (RADIUS_M,) * len(centre_m), depths_m, solver, 0)


class Coarsened(unittest.TestCase):
    def test_a_far_surface_has_fewer_triangles_and_the_same_shape(self):
        organ = organ_of(*ball(0.03, 4), None)
        lengths = surface.EdgeLengths(np.array([[0, 0, 0.03]]), 0.01, 0.0, 0.5, 14e-3)
        vertex_m, triangle = coarsen.coarsened(organ, lengths, 0.8e-3)
        self.assertLess(len(triangle), 0.7 * len(organ.triangle))
        _, count = np.unique(surface.edges_of(triangle)[1], return_counts=True)
        self.assertTrue((count == 2).all(), "closed")
        volume_m3, before_m3 = (np.einsum("ti,ti->", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6.0
                                for p in (vertex_m[triangle], organ.vertex_m[organ.triangle]))
        self.assertAlmostEqual(volume_m3 / before_m3, 1.0, delta=0.03)
        near = np.linalg.norm(organ.vertex_m - [0, 0, 0.03], axis=1) < 8e-3
        for at_m in organ.vertex_m[near]:
            self.assertEqual(np.linalg.norm(vertex_m - at_m, axis=1).min(), 0.0, "every vertex near the tool stays")

    def test_what_is_held_stays_apart_from_what_is_free(self):
        organ = job.organ_of(liver())
        lengths = surface.EdgeLengths(np.array([[0, 0, 0.03]]), 0.012, 0.0, 0.5, 14e-3)
        vertex_m, triangle = coarsen.coarsened(organ, lengths, 1.5e-3)
        area_m2 = [np.linalg.norm(coarsen.normals(p[organ.held(p).all(axis=1)]), axis=1).sum()
                   for p in (organ.vertex_m[organ.triangle], vertex_m[triangle])]
        self.assertAlmostEqual(area_m2[1] / area_m2[0], 1.0, delta=0.1)


class Programs(Solves):
    @needs_calculix
    def test_calculix_presses_two_balls_alike(self):
        block = self_check.make_block(0.02)
        what = press("CalculiX", (0.5e-3, 1e-3), ((-RADIUS_M, 0.0, RADIUS_M), (RADIUS_M, 0.0, RADIUS_M)))
        made = body.make_body(block, surface.EdgeLengths(np.array([[0, 0, 0]]), 8e-3, 3e-3, 0.8, 8e-3))
        each_N = finite_strain.by_calculix(block, made, what)
        self.assertEqual(each_N.shape, (2, 2))
        np.testing.assert_allclose(each_N[:, 0] / each_N[:, 1], 1.0, atol=0.1)
        self.assertGreater(each_N[1, 0], 2.0 * each_N[0, 0], "F grows as d to the power of 1.5")

    @needs_fenicsx
    def test_fenicsx_finds_the_block_that_others_have_solved(self):
        block = self_check.make_block(0.05)
        case = finite_strain.solve(block, press("FEniCSx"))[0]
        self.assertAlmostEqual(case.force_N / 3.776e-3, 1.0, delta=0.06, msg="RF-7, neo-Hookean; the roughest mesh")

    def test_a_force_is_that_of_the_nearest_ball(self):
        tool = calculix.Tool(np.array([1.0, 1.0]), np.array([[-1.0, 0, 1], [1.0, 0, 1]]), [0.1, 0.2],
                             np.array([[0, 1, 2, 3, 4, 5]]))
        made = body.Body(np.array([[x, 0.0, 0.0] for x in (-1.2, -1.0, -0.5, 0.5, 1.0, 1.2)]), None, None, None, None)
        force_N = np.tile(DOWN, (2, 6, 1))
        found_N = calculix.tool_force_N(made, tool, force_N, np.zeros((2, 6, 3)), DOWN)
        np.testing.assert_array_equal(found_N @ DOWN, [[3, 3], [3, 3]])

    def test_a_compile_that_was_stopped_is_named_with_its_file(self):
        def form(_):
            raise TimeoutError("JIT compilation timed out.\n  Try cleaning cache (e.g. remove /home/a/libffcx_forms_1.c) or ...")
        stopped = types.SimpleNamespace(fem=types.SimpleNamespace(form=form))
        with self.assertRaisesRegex(Failure, r"wait, or remove /home/a/libffcx_forms_1\.c"):
            fenicsx.compiled(stopped, None)
