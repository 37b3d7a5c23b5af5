# SPDX-License-Identifier: Apache-2.0
"""The geometry of organs, and contact on a half-space."""
import unittest.mock
from dataclasses import replace

import numpy as np

from support import ball, organ_of

import contact
import run
import self_check
import surface
import tool_press

FINE = surface.EdgeLengths(np.zeros((1, 3)), 4e-3, 0.7e-3, 0.4)


def volume_m3(vertex_m, triangle):
    a, b, c = vertex_m[triangle].transpose(1, 0, 2)
    return np.einsum("ti,ti->", a, np.cross(b, c)) / 6.0


def areas_m2(vertex_m, triangle):
    a, b, c = vertex_m[triangle].transpose(1, 0, 2)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def least_angle_rad(vertex_m, triangle):
    edge = surface.unit(vertex_m[triangle[:, surface.NEXT]] - vertex_m[triangle])
    return np.arccos(-np.einsum("tki,tki->tk", edge, edge[:, surface.NEXT])).min()


class Refine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        block = self_check.make_block(0.05)
        cls.coarse = block.vertex_m, block.triangle
        cls.fine = surface.refine(*cls.coarse, FINE)

    def is_closed_as_before(self, vertex_m, triangle):
        self.assertTrue((np.unique(surface.edges_of(triangle)[1], return_counts=True)[1] == 2).all())
        self.assertAlmostEqual(volume_m3(vertex_m, triangle) / volume_m3(*self.coarse), 1.0, delta=1e-12)
        self.assertAlmostEqual(areas_m2(vertex_m, triangle).sum() / areas_m2(*self.coarse).sum(), 1.0, delta=1e-12)

    def test_keeps_the_surface_closed_and_its_vertices(self):
        self.is_closed_as_before(*self.fine)
        self.assertGreater(len(self.fine[1]), len(self.coarse[1]))
        np.testing.assert_array_equal(self.fine[0][:len(self.coarse[0])], self.coarse[0])

    def test_leaves_no_edge_longer_than_asked_and_no_angle_below_half_of_the_least(self):
        ends = self.fine[0][surface.edges_of(self.fine[1])[0].reshape(-1, 2)]
        # An edge that is not the longest of its triangle is evaluated by that one: nearly the same h.
        self.assertLess((np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) / FINE.at(ends.mean(axis=1))).max(), 1.2)
        self.assertGreaterEqual(least_angle_rad(*self.fine), 0.5 * least_angle_rad(*self.coarse) - 1e-9)

    def test_refuses_edges_that_cannot_be_reached(self):
        # In order: no length, none, too small for numbers, too many triangles.
        for radius_m, fine_m in ((4e-3, np.nan), (4e-3, 0.0), (0.0, 1e-30), (4e-3, 1e-6)):
            with self.assertRaisesRegex(run.Failure, "ask for a larger depth"):
                surface.refine(*self.coarse, replace(FINE, radius_m=radius_m, fine_m=fine_m))

    def test_edges_grow_from_a_ball_or_from_a_circle(self):
        ring = replace(FINE, axis=np.array([0.0, 0.0, 1.0]))
        at_m = np.array([[4e-3, 0, 0], [0, 0, 0], [0, 4e-3, 3e-3]])
        np.testing.assert_allclose(ring.at(at_m), 0.7e-3 + 0.4 * np.array([0, 4e-3, 3e-3]))
        np.testing.assert_allclose(FINE.at(np.array([[0, 0, 3e-3], [0, 0, 5e-3]])), 0.7e-3 + 0.4 * np.array([0, 1e-3]))

    def test_a_cut_puts_every_triangle_inside_or_outside_of_the_circle(self):
        circle = surface.Circle(np.zeros(3), np.array([0.0, 0.0, -1.0]), 4e-3)
        vertex_m, triangle = surface.cut_along(*self.fine, circle, 8e-3)
        self.is_closed_as_before(vertex_m, triangle)
        inside = np.linalg.norm(vertex_m[triangle].mean(axis=1), axis=1) < circle.radius_m
        # Without the cut the triangles of 0.7 mm leave a ragged edge; with it the area is the disc's.
        self.assertAlmostEqual(areas_m2(vertex_m, triangle)[inside].sum() / (np.pi * 16e-6), 1.0, delta=0.01)
        away_m, tolerance_m = circle.away_m(vertex_m[triangle]), 0.2 * 0.7e-3
        near = np.linalg.norm(vertex_m[triangle].mean(axis=1), axis=1) < 6e-3
        crosses = (away_m.min(axis=1) < 4e-3 - tolerance_m) & (away_m.max(axis=1) > 4e-3 + tolerance_m)
        self.assertFalse((crosses & near).any())


class Ways(unittest.TestCase):
    def test_go_through_a_ball(self):
        vertex_m, triangle = ball(0.01, 5)
        corner_m, axis = vertex_m[triangle], np.array([0.0, 0, 1])
        start_m = np.array([[1e-4, 2e-4, 0.05], [1e-4, 2e-4, 0.004], [0.02, 0, 0.05]])
        away_m, thick_m = surface.thickness(corner_m, surface.unit(corner_m.mean(axis=1)), start_m, -axis)
        np.testing.assert_allclose(away_m, [0.04, -0.006, np.nan], atol=1e-4, err_msg="a start inside lies behind the way in")
        np.testing.assert_allclose(thick_m, [0.02, 0.02, np.nan], atol=2e-4)
        behind = surface.thickness(corner_m, surface.unit(corner_m.mean(axis=1)), start_m[:1], axis)
        self.assertTrue(np.isnan(behind[0][0]), "behind the start")
        both_m = np.vstack([corner_m, corner_m - [0, 0, 0.05]])
        away_m, thick_m = surface.thickness(both_m, surface.unit(np.tile(corner_m.mean(axis=1), (2, 1))), start_m[:1], -axis)
        np.testing.assert_allclose([away_m[0], thick_m[0]], [0.04, 0.02], atol=2e-4, err_msg="the first of two balls")

    def test_of_a_cone_rings_have_its_heights(self):
        n = 41
        x = np.stack(np.meshgrid(*[np.linspace(-0.04, 0.04, n)] * 2), axis=-1).reshape(-1, 2)
        at = np.add.outer(n * np.arange(n - 1), np.arange(n - 1)).ravel()
        triangle = np.vstack([np.stack([at, at + 1, at + n], axis=1), np.stack([at + 1, at + n + 1, at + n], axis=1)])
        p = np.hstack([x, np.zeros((n * n, 1))])[triangle]
        rho_m = np.linalg.norm(p, axis=2)
        # The tilt 5 x averages out round each ring.
        rings = surface.ring_means(p, rho_m, 1.0 - rho_m / 0.04 + 5.0 * p[:, :, 0], 31, 1e-3, 1.0)
        np.testing.assert_allclose(rings, 1.0 - np.arange(31) / 40.0, atol=2e-3)
        ones = surface.ring_means(p, rho_m, np.ones_like(rho_m), 100, 1e-3, 1.0)
        np.testing.assert_allclose(ones, np.ones(100), err_msg="off the plate too")


class HalfSpace(unittest.TestCase):
    def setUp(self):
        self.organ = self_check.make_block(1.0)  # E = 1 kPa, nu = 0.45

    def test_is_hertz_at_small_depth(self):
        d, radius_m = 1e-6, 5e-3
        self.assertAlmostEqual(contact.sphere_contact_radius_m(radius_m, d), np.sqrt(radius_m * d), delta=1e-3 * 7e-5)
        hertz_N = 4 / 3 * self.organ.contact_modulus_Pa * np.sqrt(radius_m * d) * d
        self.assertAlmostEqual(contact.sphere_force_N(self.organ, radius_m, d) / hertz_N, 1.0, delta=1e-3)

    def test_force_rises_by_the_punch_stiffness_of_its_contact(self):
        for d in (0.5e-3, 2e-3, 5e-3, 12e-3):  # dF/dd = 2 E* a, for any shape of the tool
            low_N, high_N = (contact.sphere_force_N(self.organ, 5e-3, d + h) for h in (-1e-7, 1e-7))
            slope = (high_N - low_N) / 2e-7
            punch = contact.flat_punch_force_N(self.organ, contact.sphere_contact_radius_m(5e-3, d), 1.0)
            self.assertAlmostEqual(punch / slope, 1.0, delta=1e-5)

    def test_is_that_of_an_independent_solution(self):
        # Block of radius and height 2 m, sphere R = 5 mm, by FEniCS. Its mesh is 0.2 mm at the tip: good to 1 %.
        for depth_m, force_mN in ((1e-3, 3.6639), (2e-3, 10.1590), (3e-3, 18.2841), (5e-3, 37.6647)):
            self.assertAlmostEqual(contact.sphere_force_N(self.organ, 5e-3, depth_m) * 1e3 / force_mN, 1.0, delta=0.01)


class TipContact(unittest.TestCase):
    def test_on_a_flat_surface_is_the_half_space(self):
        organ = self_check.make_block(1.0)
        tip = contact.TipContact(organ.contact_modulus_Pa, 4e-3)
        for depth_m in (0.5e-3, 2e-3, 5e-3, 8e-3):
            a_m = contact.sphere_contact_radius_m(4e-3, depth_m)
            np.testing.assert_allclose([tip.depth_m(a_m), tip.force_N(a_m), tip.contact_radius_m(depth_m, 0.0)],
                                       [depth_m, contact.sphere_force_N(organ, 4e-3, depth_m), a_m], rtol=1e-4)

    def test_on_a_ball_is_hertz_of_both_radii(self):
        # s = rho^2 / (2 Rs) is a paraboloid: at small depth 1/R + 1/Rs act together.
        ball_m, pitch_m, a_m, modulus_Pa = 12e-3, 1e-6, 0.2e-3, 1000.0
        tip = contact.TipContact(modulus_Pa, 4e-3, (np.arange(400) * pitch_m)**2 / (2.0 * ball_m), pitch_m)
        both_m = 1.0 / (1.0 / 4e-3 + 1.0 / ball_m)
        np.testing.assert_allclose(tip.depth_m(a_m), a_m**2 / both_m, rtol=2e-3)
        np.testing.assert_allclose(tip.force_N(a_m), 4 / 3 * modulus_Pa * a_m**3 / both_m, rtol=3e-3)

    def test_takes_the_compliance_of_the_organ_from_one_solve(self):
        tip, compliance_m_per_N = contact.TipContact(6000.0, 4e-3), 0.02
        force_N = tip.force_N(2.5e-3)
        depth_m = tip.depth_m(2.5e-3) + compliance_m_per_N * force_N
        self.assertAlmostEqual(tip.compliance_m_per_N(depth_m, force_N), compliance_m_per_N, delta=1e-9)
        self.assertAlmostEqual(tip.contact_radius_m(depth_m, compliance_m_per_N), 2.5e-3, delta=1e-9)
        stiff_m, soft_m = (tip.contact_radius_m(7e-3, c) for c in (0.0, compliance_m_per_N))
        self.assertLess(soft_m, stiff_m, "what is compliant is touched less")

    def test_the_fall_of_a_ball_is_its_cap_and_of_a_plate_nothing(self):
        vertex_m, triangle = ball(0.03, 5)
        fall_m = contact.surface_fall_m(organ_of(vertex_m, triangle, surface.unit(vertex_m)), 2, 17, 0.25e-3)
        rho_m = np.arange(17) * 0.25e-3
        self.assertEqual(fall_m[0], 0.0)
        np.testing.assert_allclose(fall_m[4:], (0.03 - np.sqrt(0.03**2 - rho_m**2))[4:], atol=0.02e-3)
        np.testing.assert_allclose(contact.surface_fall_m(self_check.make_block(0.05), 0, 17, 0.25e-3), np.zeros(17), atol=1e-15)


def sinking(x, y, h):
    """Of a square of side h under unit pressure at (x, y) from its middle, times E*.

    Source: A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377.
    """
    a, b, c, d = x + 0.5 * h, x - 0.5 * h, y + 0.5 * h, y - 0.5 * h

    def part(p, q, r):
        return p * np.log((q + np.hypot(p, q)) / (r + np.hypot(p, r)))
    return (part(a, c, d) + part(c, a, b) + part(b, d, c) + part(d, b, a)) / np.pi


def forces_N(modulus_Pa, radius_m, balls, squares):
    """Of balls (x, y, depth) on a half-space; `squares` to a radius."""
    h = radius_m / squares
    x, y = (g.ravel() for g in np.meshgrid(*[(np.arange(-squares, squares) + 0.5) * h] * 2))
    beyond_m = np.sqrt(np.maximum(0.0, radius_m**2 - x**2 - y**2)) - radius_m
    beyond_m[np.hypot(x, y) > 0.999 * radius_m] = -np.inf
    parts = [(bx + x, by + y, depth_m + beyond_m, np.full(len(x), i)) for i, (bx, by, depth_m) in enumerate(balls)]
    x, y, overlap_m, number = (np.concatenate(part)[np.concatenate([p[2] for p in parts]) > 0.0] for part in zip(*parts))
    compliance = sinking(np.subtract.outer(x, x), np.subtract.outer(y, y), h) / modulus_Pa
    return np.bincount(number, tool_press.solve_contact(compliance, overlap_m) * h * h, len(balls))


class ActiveSet(unittest.TestCase):
    def test_presses_a_sphere_as_sneddon_does(self):
        organ = self_check.make_block(1.0)
        for depth_m in (1e-3, 2e-3, 5e-3, 10e-3):
            found_N = forces_N(organ.contact_modulus_Pa, 4e-3, [(0, 0, depth_m)], 12)[0]
            self.assertAlmostEqual(found_N / contact.sphere_force_N(organ, 4e-3, depth_m), 1.0, delta=0.015)

    def test_couples_spheres_as_boundary_elements_do(self):
        # By others, on a grid of R / 40; alone they would be up to 718 % off. The grid here is R / 9: 2 %.
        for modulus_Pa, nu, radius_m, balls in (
                (2000, 0.49, 4.65e-3, [(0.000913, -0.009837, 0.002285, 0.009634), (0.002458, 0.005752, 0.00801, 0.140654)]),
                (2000, 0.49, 5.81e-3, [(-0.008858, -0.007882, 0.002466, 0.003836), (0.011778, 0.011146, 0.008593, 0.15328),
                                       (-0.003833, 0.002961, 0.005277, 0.052047), (0.011992, -0.011301, 0.007469, 0.119775)]),
                (8000, 0.45, 4.71e-3, [(-0.010051, -0.007808, 0.005855, 0.268485), (-0.005479, 0.006901, 0.005855, 0.270215),
                                       (0.004796, -0.004879, 0.005855, 0.269266)])):
            known_N = np.array(balls)[:, 3]
            found_N = forces_N(modulus_Pa / (1 - nu**2), radius_m, [one[:3] for one in balls], 9)
            np.testing.assert_allclose(found_N, known_N, rtol=0.02, atol=2e-5)

    def test_neither_pulls_nor_lets_anything_in_for_any_definite_compliance(self):
        random = np.random.default_rng(1)
        for timeout in [tool_press.TIMEOUT] * 100 + [0] * 20:  # 0: one at a time from the start
            root, overlap = random.normal(size=(40, 40)), random.normal(size=40)
            compliance = root @ root.T + 0.01 * np.eye(40)
            with unittest.mock.patch("tool_press.TIMEOUT", timeout):
                pressure = tool_press.solve_contact(compliance, overlap)
            gap = compliance @ pressure - overlap
            self.assertGreaterEqual(min(pressure.min(), gap.min()), -1e-8)
            self.assertAlmostEqual(pressure @ gap, 0.0, delta=1e-7)

    def test_says_when_the_compliance_is_none(self):
        with self.assertRaisesRegex(run.Failure, "not positive definite"):
            tool_press.solve_contact(-np.eye(3), np.ones(3))
