# SPDX-License-Identifier: Apache-2.0
"""Cases solved: CalculiX and tact's own elimination against answers that are known otherwise."""
import json
import unittest.mock
from dataclasses import replace

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from support import REFERENCES, Solves, ball, liver, needs_calculix

import body
import calculix
import contact
import elastic
import indentation
import job
import run
import self_check
import surface
import tool_press

SIDE_M, ROUGH_BAR = 0.01, 0.04  # the bar of the roughest mesh, which solves in seconds
PRESS = indentation.Indentation(0, 5e-3, 1e-3, contact_radius_m=2.2e-3)
TOOL = tool_press.ToolPress((0.0, 0.0, -1.0), ((0.0, 0.0, 4e-3),), (4e-3,), (1e-3, 2e-3, 5e-3, 10e-3), level=0)


def cube(poisson_ratio=0.45):
    """Organ and Body of a cube from the origin, E = 5 kPa; its bottom is held."""
    vertex_m = SIDE_M * np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], dtype=float)
    triangle = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6],
                         [0, 6, 2], [1, 3, 7], [1, 7, 5]])
    organ = body.Organ(vertex_m, triangle, np.zeros((8, 3)), np.full(3, -1.0), np.array([1, 1, 1e-9]), 5000.0, poisson_ratio)
    return organ, body.make_body(organ, surface.EdgeLengths(np.zeros((1, 3)), 1.0, 0.5 * SIDE_M, 0.0))


class Gmsh(Solves):
    def test_fills_a_cube_to_its_volume_and_keeps_its_vertices(self):
        organ, made = cube()
        a, b, c = (made.node_m[made.element[:, [1, 2, 3]]] - made.node_m[made.element[:, :1]]).transpose(1, 0, 2)
        self.assertAlmostEqual(np.einsum("ei,ei->", a, np.cross(b, c)) / 6.0, 1e-6, delta=1e-18)
        np.testing.assert_array_equal(made.node_m[:8], organ.vertex_m)
        corners, middles = made.node_m[made.element[:, :4]], made.node_m[made.element[:, 4:]]
        np.testing.assert_array_equal(middles, corners[:, body.EDGES].mean(axis=2))
        np.testing.assert_array_equal(made.node_m[made.face[:, 4]], made.node_m[made.face[:, [1, 2]]].mean(axis=1))
        np.testing.assert_array_equal(made.held, np.unique(made.face[(made.node_m[made.face, 2] == 0.0).all(axis=1)]))

    def test_ten_balls_are_finer_than_one_and_no_text_is_too_long(self):
        organ = cube()[0]
        at_m = SIDE_M * np.array([[0.05 + 0.1 * i, 0.512345678912345, 1.0123456789123] for i in range(10)])
        sizes = [surface.EdgeLengths(at, 1e-4, 1e-3, 0.5) for at in (at_m, at_m[:1])]
        ten, one = (body.make_body(organ, lengths) for lengths in sizes)
        self.assertGreater(len(ten.element), 1.5 * len(one.element))
        self.assertEqual(body.size_fields(sizes[0]).count("MathEval"), 3)

    def test_refuses_an_open_surface_and_keeps_its_log(self):
        organ = cube()[0]
        with unittest.mock.patch("tempfile.tempdir", str(self.folder)), self.assertRaisesRegex(run.Failure, "gmsh") as refused:
            body.fill(organ.vertex_m, organ.triangle[1:], surface.EdgeLengths(np.zeros((1, 3)), 1.0, SIDE_M, 0.0))
        log = next(self.folder.glob("tact-gmsh-*/gmsh.log"))
        self.assertIn(str(log), refused.exception.message)
        self.assertEqual(list(run.run_folder.iterdir()), [], "nothing else is left")


class Elimination(Solves):
    def test_is_what_a_sparse_solver_finds(self):
        organ = self_check.make_block(0.05)
        made = body.make_body(organ, surface.EdgeLengths(np.zeros((1, 3)), 5e-3, 6e-3, 0.8, 16e-3))
        size = 3 * len(made.node_m)
        loads = scipy.sparse.random(size, 7, 0.001, random_state=1, format="csc")
        free = np.setdiff1d(np.arange(size), (3 * made.held[:, None] + np.arange(3)).ravel())
        k = elastic.stiffness(organ, made)[free][:, free].tocsc()
        known = loads[free].T @ scipy.sparse.linalg.spsolve(k, loads[free]).toarray()
        self.assertGreater(len(made.element), 16 * elastic.LEAF, "in many parts")
        np.testing.assert_allclose(elastic.compliance(organ, made, loads), known, atol=1e-9 * np.abs(known).max())

    def test_refuses_a_stiffness_that_is_not_positive_definite(self):
        organ, made = cube(poisson_ratio=0.6)
        loads = scipy.sparse.coo_matrix(([1.0], ([2], [0])), (3 * len(made.node_m), 1))
        with self.assertRaisesRegex(run.Failure, "not positive definite; make the box"):
            elastic.compliance(organ, made, loads)

    def test_of_one_sphere_is_sneddons(self):
        block = self_check.make_block(0.3, 2000.0, 0.4)  # so large that it is a half-space
        for case in tool_press.solve(block, TOOL):
            self.assertAlmostEqual(case.force_N / contact.sphere_force_N(block, 4e-3, case.depth_m), 1.0, delta=ROUGH_BAR)
            self.assertAlmostEqual(case.sphere_N[0], case.force_N, delta=1e-12)

    def test_of_two_spheres_couples_them(self):
        # Boundary elements by others: alone they would give 35 and 17 % more.
        first_m, second_m, radius_m = 0.002872, 0.003423, 3.66e-3
        press = tool_press.ToolPress((0.0, 0.0, -1.0), ((0.006714, -0.005797, radius_m + second_m - first_m),
                                                        (-0.000104, -0.003136, radius_m)), (radius_m,) * 2, (second_m,), level=0)
        case = tool_press.solve(self_check.make_block(0.3, 2000.0, 0.4), press)[0]
        np.testing.assert_allclose(case.sphere_N, [0.020165, 0.029695], rtol=ROUGH_BAR)

    def test_of_one_sphere_on_the_liver_is_what_calculix_finds(self):
        known = json.loads((REFERENCES / "liver.json").read_text())
        site, radius_m, organ = known["sites"][2], known["tool_radius_m"], job.organ_of(liver())
        self.assertEqual(site["vertex"], 2780, "far from what is held: it gives most")
        presses = [case for case in site["cases"] if case["depth_m"] > 0.0 and not case["large_strain"]]
        centre_m = np.array(site["point_m"]) - radius_m * np.array(site["direction"])
        press = tool_press.ToolPress(tuple(site["direction"]), (tuple(centre_m),), (radius_m,),
                                     tuple(case["depth_m"] for case in presses), (2780,), level=0)
        found = tool_press.solve(organ, press)
        np.testing.assert_allclose([case.force_N for case in found], [case["force_N"] for case in presses], rtol=ROUGH_BAR)
        # The touched vertex goes as far as the tool.
        np.testing.assert_allclose([case.skin_m[0] for case in found], press.depths_m, rtol=0.02)

    def test_a_tool_reaches_as_far_as_its_lowest_sphere(self):
        press = replace(TOOL, centre_m=((-5e-3, 0.0, 4e-3), (5e-3, 0.0, 3e-3)), radius_m=(4e-3, 4e-3))
        at_m = np.array([[-5e-3, 0, 0], [5e-3, 0, 0], [5e-3, 2.4e-3, -1e-3], [0, 0, 0]])
        reach_m = tool_press.reach_beyond(press, at_m)[0]
        np.testing.assert_allclose(reach_m.max(axis=1), [0.0, 1e-3, -0.8e-3, -np.inf], atol=1e-15)
        self.assertEqual(reach_m[1].argmax(), 1)


class Deck(unittest.TestCase):
    def setUp(self):
        self.organ = self_check.make_block(0.05)
        node_m = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]])  # one tetrahedron, its edges halved
        node_m = np.vstack([node_m, node_m[body.EDGES].mean(axis=1)])
        self.body = body.Body(node_m, np.arange(10)[None], np.empty((0, 6)), np.empty((0, 3)), np.array([3]))

    def deck(self, depth_m=0.0, corners=((0, 1, 2),), **load):
        way = np.array([0.0, 0.0, 1.0])
        tool = calculix.Tool(np.array([5e-3]), np.array([[0, 0, -5e-3]]), [depth_m], np.array(corners)) if depth_m else None
        return calculix.deck_of(self.organ, self.body, calculix.Load(way, large_strain=bool(tool), tool=tool, **load), [0])

    def test_a_ball_goes_by_a_tenth_of_its_radius_at_a_time(self):
        # CalculiX keeps the direction of a contact through a step.
        self.assertIn("\n*STATIC\n0.025,1.,1e-5,0.05\n", self.deck(10e-3))
        self.assertIn("\n*STATIC\n0.1,1.,1e-5,0.2\n", self.deck(1e-3))
        self.assertIn("\nTOOL,1,1,10\nTOOL,2,3\n", self.deck(10e-3))

    def test_names_the_element_and_the_number_of_every_face_that_may_be_touched(self):
        # CalculiX manual 6.2: face 1 is 1-2-3, 2 is 1-4-2, 3 is 2-4-3, 4 is 3-4-1; in any order here.
        self.assertIn("\n*SURFACE,NAME=TOUCHED,TYPE=ELEMENT\n1,S1\n1,S2\n1,S3\n1,S4\n*",
                      self.deck(1e-3, [(2, 1, 0), (0, 1, 3), (1, 2, 3), (2, 0, 3)]))

    def test_the_ball_rests_where_it_is_put_in_millimetres(self):
        # The deck's x is the direction of the load; nodes of the body are 1 to 10.
        first = self.deck(1e-3).split("*NODE,NSET=TOOL\n11,")[1].split("\n")[0]
        known_mm = calculix.rigid_ball()[0][0] * 5.0 + [-5, 0, 0]
        np.testing.assert_allclose([float(x) for x in first.split(",")], known_mm, atol=1e-9)

    def test_moved_nodes_need_no_contact(self):
        deck = self.deck(moved=np.array([1]), along_m=np.array([2e-3]), is_bonded=True)
        self.assertIn("\n*STEP\n*STATIC\n*BOUNDARY\n2,1,1,2\n2,2,3\n", deck)
        self.assertNotIn("CONTACT", deck)
        self.assertNotIn("TOOL", deck)

    def test_the_ball_is_round_outside_and_has_its_wedges_right_side_out(self):
        node, wedge = calculix.rigid_ball()
        at = node[wedge].transpose(1, 0, 2)
        np.testing.assert_allclose(np.linalg.norm(at[[3, 4, 5, 9, 10, 11]], axis=2), 1.0, atol=1e-15)
        np.testing.assert_allclose(at[12:15], 0.5 * (at[0:3] + at[3:6]), atol=1e-15, err_msg="the middle of a spoke")
        for k in range(3):
            ends = [np.linalg.norm(at[9 + k] - at[3 + j], axis=1) for j in (k, (k + 1) % 3, (k + 2) % 3)]
            np.testing.assert_allclose(ends[0], ends[1], err_msg="the middle of the edge from corner k to the next")
            self.assertTrue((ends[0] < ends[2]).all())
        self.assertTrue((np.einsum("wi,wi->w", np.cross(at[1] - at[0], at[2] - at[0]), at[3] - at[0]) > 0.0).all(), "its volume")
        self.assertEqual(at[3:6, :, 0].max(), 1.0, "a node in the pole: the first contact")
        self.assertLess(at[3:6, :, 0].min(), -0.5, "round the sides, where deep tissue closes in")
        self.assertEqual(len(np.unique(wedge)), len(node), "each node once")


@needs_calculix
class CalculiX(Solves):
    def moved(self, direction, along_m, **how):
        """The cube's surface moved by along_m(x); nothing is held."""
        organ, made = cube()
        outside = np.unique(made.face)
        load = calculix.Load(surface.unit(np.array(direction)), outside, along_m(made.node_m[outside]), is_bonded=True, **how)
        made = replace(made, held=outside[:0])
        return made, load, calculix.solve(organ, made, load, np.arange(len(made.node_m)))

    def test_passes_the_patch_test(self):
        # A linear displacement is in the element's space: inside it must be linear too, exactly.
        def along_m(x):
            return 1e-3 * x @ np.array([2.0, -1.0, 0.5])

        made, load, answer = self.moved((0.3, -0.5, 0.8), along_m)
        known_m = np.outer(along_m(made.node_m), load.direction)
        np.testing.assert_allclose(answer.displacement_m, known_m, atol=1e-6 * 1e-3 * SIDE_M)
        self.assertLess(np.linalg.norm(answer.force_N), 1e-9, "constant stress has no resultant")

    def test_gives_youngs_modulus_in_tension(self):
        # nu = 0: the held bottom does not hinder, and F = E A strain = 5000 * 1e-4 * 1e-3 = 0.5 mN.
        organ, made = cube(poisson_ratio=0.0)
        top = np.flatnonzero(made.node_m[:, 2] > SIDE_M - 1e-9)
        load = calculix.Load(np.array([0.0, 0.0, 1.0]), top, np.full(len(top), 1e-3 * SIDE_M))
        answer = calculix.solve(organ, made, load, np.array([7]))
        np.testing.assert_allclose(answer.force_N, [0, 0, 0.5e-3], atol=1e-9)
        np.testing.assert_allclose(answer.displacement_m[7], [0, 0, 1e-5], atol=1e-11)

    def test_knows_both_elastic_constants_also_at_large_strain(self):
        # Sides confined: W = E (1 - nu) / ((1 + nu)(1 - 2 nu)) strain^2 / 2 V; at 0.1 % neo-Hookean is the same.
        known_J = 0.5 * 5000.0 * 0.55 / (1.45 * 0.1) * 1e-6 * 1e-6
        for large_strain, bar in ((False, 1e-5), (True, 5e-3)):
            _, load, answer = self.moved((0, 0, 1), lambda x: -1e-3 * x[:, 2], large_strain=large_strain)
            self.assertAlmostEqual(0.5 * answer.moved_force_N[:, 2] @ load.along_m / known_J, 1.0, delta=bar)

    def test_of_a_block_is_that_of_an_independent_solution(self):
        # Round block 50 x 50 mm, sphere R = 5 mm: 40.46 mN at 5 mm (FEniCS).
        block = self_check.make_block(0.05)
        case = indentation.solve(block, replace(PRESS, depth_m=5e-3, level=1, contact_radius_m=0.0))[0]
        self.assertAlmostEqual(case.force_N / 40.46e-3, 1.0, delta=0.025)
        self.assertGreater(case.force_N, 1.03 * contact.sphere_force_N(block, 5e-3, 5e-3), "the held bottom counts")
        self.assertAlmostEqual(case.profile_m[0], 5e-3, delta=1e-9)
        self.assertAlmostEqual(case.profile_m[3], 5e-3 - (5e-3 - 4e-3), delta=0.03e-3, msg="under the tip the sphere's shape")

    def test_tissue_slides_around_the_ball_and_is_never_in_it(self):
        block, depth_m, radius_m = self_check.make_block(0.01), 3e-3, 5e-3
        rim = surface.Circle(np.zeros(3), np.array([0.0, 0.0, -1.0]), radius_m)
        made = body.make_body(block, surface.EdgeLengths(np.zeros((1, 3)), 5e-3, 2.2e-3, 0.8, 8e-3))
        ball = indentation.ball_on(made, rim, radius_m, depth_m)
        np.testing.assert_array_equal(ball.centre_m, [[0, 0, radius_m]], err_msg="it rests on the site")
        centres_m = made.node_m[made.face[:, :3]].mean(axis=1)
        self.assertEqual(len(ball.face), (centres_m[:, 2] == 0.0).sum(), "all of the top lies within two radii")
        answer = calculix.solve(block, made, calculix.Load(rim.axis, large_strain=True, tool=ball), np.unique(made.face))
        away_m = np.linalg.norm(made.node_m + answer.displacement_m - [0, 0, radius_m - depth_m], axis=1)
        self.assertAlmostEqual(np.nanmin(away_m) / radius_m, 1.0, delta=0.005)
        slid_m = np.hypot(*answer.displacement_m[away_m < 1.01 * radius_m, :2].T)
        self.assertGreater(slid_m.max(), 0.1e-3, "nodes that may not slide make it stiffer")
        touched_m = indentation.touched_radius_m(made, ball, rim.axis, answer.displacement_m)
        self.assertTrue(0.5 * radius_m < touched_m < radius_m)
        self.assertLess(answer.force_N[2], -20e-3, "the ball pushes down")
        self.assertLess(np.hypot(*answer.force_N[:2]), 0.02 * abs(answer.force_N[2]))


class Load(unittest.TestCase):
    def test_a_press_follows_the_sphere_from_the_resting_surface(self):
        node_m, triangle = ball(0.03, 5)
        pole_m, normal = np.array([0, 0, 0.03]), surface.unit(node_m[triangle].mean(axis=1))
        made = body.Body(node_m, np.empty((0, 10)), np.hstack([triangle, triangle]), normal, np.empty(0))
        rim = surface.Circle(pole_m, np.array([0.0, 0, -1]), 3e-3)
        load = indentation.press_load(made, rim, replace(PRESS, depth_m=2e-3))
        self.assertGreater(len(load.moved), 10)
        rho2_m2 = (node_m[load.moved, :2]**2).sum(axis=1)  # u_n = d - (R - sqrt(R^2 - rho^2)) - s
        fall_m = 0.03 - np.sqrt(0.03**2 - rho2_m2)
        np.testing.assert_allclose(load.along_m, 2e-3 - (5e-3 - np.sqrt(5e-3**2 - rho2_m2)) - fall_m, atol=1e-12)

    def test_a_pull_with_large_strain_has_edges_it_can_draw_out(self):
        def fine_m(depth_m, large_strain, level):
            what = indentation.Indentation(0, 5e-3, depth_m, large_strain, level)
            return indentation.edge_lengths(self_check.make_block(0.05), what).fine_m

        self.assertAlmostEqual(fine_m(-6.5e-3, False, 1), 0.12 * 5e-3, msg="linear: any depth")
        self.assertAlmostEqual(fine_m(-1e-3, True, 1), 0.12 * 5e-3)
        self.assertAlmostEqual(fine_m(-6.5e-3, True, 1), 6.5e-3 / 8.0)
        self.assertAlmostEqual(fine_m(-6.5e-3, True, 0), 6.5e-3 / 8.0 / 0.7, delta=0.02e-3, msg="coarser, for the error")
        self.assertGreater(fine_m(5e-3, True, 0), 1.3 * fine_m(5e-3, True, 1))
