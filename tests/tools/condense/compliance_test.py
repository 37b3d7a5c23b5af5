# SPDX-License-Identifier: Apache-2.0
"""The finite elements of tact-lab condense against answers that are known otherwise."""
import pathlib
import sys
from dataclasses import replace

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "reference"))

from support import ROOT, Solves  # noqa: E402

import numpy as np  # noqa: E402
import scipy.sparse.linalg  # noqa: E402

sys.path.insert(0, str(ROOT / "tools/condense"))

import body  # noqa: E402
import compliance  # noqa: E402
import elastic  # noqa: E402
import run  # noqa: E402
import surface  # noqa: E402


def steps(length_m, cells):
    return np.linspace(0.0, length_m, cells + 1)


def block(x_m, y_m, z_m, held_below_m, poisson_ratio=0.45, E_Pa=1.0):
    """Organ and Body of a box in cells of six tetrahedra; vertices are its corners of the boundary, first in the body."""
    size = np.array([len(x_m), len(y_m), len(z_m)])
    grid_m = np.stack(np.meshgrid(x_m, y_m, z_m, indexing="ij"), axis=-1).reshape(-1, 3)
    at = np.arange(len(grid_m)).reshape(size)
    corner = [at[i:i + size[0] - 1, j:j + size[1] - 1, k:k + size[2] - 1].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    ways = [(4, 6), (4, 5), (2, 6), (2, 3), (1, 5), (1, 3)]  # from corner 0 to corner 7 along three edges
    element = np.vstack([np.stack([corner[0], corner[a], corner[b], corner[7]], axis=1) for a, b in ways])
    a, b, c = (grid_m[element[:, 1:]] - grid_m[element[:, :1]]).transpose(1, 0, 2)
    inside_out = np.einsum("ei,ei->e", a, np.cross(b, c)) < 0.0
    element[inside_out] = element[inside_out][:, [0, 2, 1, 3]]
    faces = element[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]].reshape(-1, 3)
    _, first, times = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    boundary = faces[first[times == 1]]
    order = np.concatenate([np.unique(boundary), np.setdiff1d(np.arange(len(grid_m)), boundary)])
    place = np.argsort(order)
    node_m, element, face = body.with_middles(grid_m[order], place[element], place[boundary])
    a, b, c = node_m[face[:, :3]].transpose(1, 0, 2)
    normal = surface.unit(np.cross(b - a, c - a))
    vertices = len(np.unique(boundary))
    vertex_normal = np.zeros((len(node_m), 3))
    for column in face[:, :3].T:
        np.add.at(vertex_normal, column, normal)
    organ = body.Organ(node_m[:vertices], place[boundary], surface.unit(vertex_normal[:vertices]), np.full(3, -1.0),
                       np.array([1.0, 1.0, held_below_m]), E_Pa, poisson_ratio)
    held = np.unique(face[organ.held(node_m[face[:, :3]]).all(axis=1)])
    return organ, body.Body(node_m, element, face, normal, held)


def cushion(poisson_ratio=0.45):
    """60 x 60 x 30 mm in cells of 15 mm, held at the bottom z = 0."""
    return block(steps(0.06, 4), steps(0.06, 4), steps(0.03, 2), 1e-6, poisson_ratio)


def half_space(E_Pa=1.0):
    """100 x 100 x 50 mm under its top face z = 0, finest in the middle of the top; its bottom is held."""
    along = np.arange(-4, 5) / 4
    graded = 0.05 * np.copysign(np.abs(along)**1.4, along)
    return block(graded, graded, graded[:5], -0.0499, E_Pa=E_Pa)


def nearest(node_m, at_m):
    return int(np.linalg.norm(node_m - at_m, axis=1).argmin())


def solved_directly(organ, made, loads):
    """Displacements (N, 3, m) under loads (N, 3, m), by SuperLU."""
    free = np.setdiff1d(np.arange(3 * len(made.node_m)), (3 * made.held[:, None] + np.arange(3)).ravel())
    k, out = elastic.stiffness(organ, made)[free][:, free].tocsc(), np.zeros((3 * len(made.node_m), loads.shape[2]))
    out[free] = scipy.sparse.linalg.splu(k).solve(loads.reshape(-1, loads.shape[2])[free])
    return out.reshape(loads.shape)


class Patch(Solves):
    def test_shares_out_the_whole_force_around_its_middle(self):
        made = half_space()[1]
        boundary = compliance.Boundary(made)
        node, weight = boundary.patch(np.searchsorted(boundary.node, nearest(made.node_m, [0.0, 0.0, 0.0])), 0.005)
        self.assertAlmostEqual(weight.sum(), 1.0, delta=1e-12)
        self.assertLess(np.linalg.norm(weight @ boundary.at_m[node]), 0.0005)

    def test_stays_on_its_side_of_a_thin_lobe(self):
        made = block(steps(0.04, 20), steps(0.04, 20), np.array([0.0, 0.002]), -1.0)[1]
        boundary = compliance.Boundary(made)
        node, _ = boundary.patch(nearest(boundary.at_m, [0.02, 0.02, 0.002]), 0.005)
        self.assertGreater(len(node), 20)
        self.assertGreater(boundary.at_m[node, 2].min(), 0.001)

    def test_of_a_half_space_is_continuous_and_far_away_only_a_force(self):
        organ = cushion()[0]
        inside, outside, far = compliance.half_space_m_per_N(organ, 0.005, [0.005 * (1 - 1e-9), 0.005 * (1 + 1e-9), 0.5])
        self.assertAlmostEqual(outside / inside, 1.0, delta=1e-6)
        # Boussinesq: u = F / (pi E* rho)
        self.assertAlmostEqual(far * np.pi * organ.contact_modulus_Pa * 0.5, 1.0, delta=1e-4)

    def test_what_a_half_space_does_not_explain_hardly_depends_on_it(self):
        # 3 / (5 E* a0) is 0.034 m/N for 14 mm and 0.024 for 20 mm; what is left must be the block's own.
        organ, made = half_space(1000.0)
        vertex = np.array([nearest(organ.vertex_m, [0.0, 0.0, 0.0])])
        small, large = (compliance.Condensation(organ, made, radius_m, 0.005, 1).of_vertices(vertex)[0]
                        for radius_m in (0.014, 0.020))
        self.assertAlmostEqual(small[0], large[0], delta=0.04 * compliance.half_space_normal_m_per_N(organ, 0.014))
        np.testing.assert_allclose(small[3:5], large[3:5], atol=0.04 * compliance.half_space_tangential_m_per_N(organ, 0.014))
        # A round block of this size, by CalculiX and another load: r = -6.7e-3 m/N (RF-3, a flat punch); this one is square.
        self.assertAlmostEqual(large[0], -6.7e-3, delta=1.5e-3)


class Factor(Solves):
    def test_bends_a_beam_as_the_book_says(self):
        # 200 x 10 x 10 mm, clamped at one end: w = F L^3 / (3 E I), and its shear.
        length_m, side_m = 0.2, 0.01
        organ, made = block(steps(side_m, 2), steps(side_m, 2), steps(length_m, 40), 1e-6, 0.3, 1e6)
        tip = np.flatnonzero(made.node_m[:, 2] > length_m - 1e-9)
        factor = compliance.Factor(organ, made)
        loads = np.zeros((len(factor.part) + 1, 3, 1))
        loads[factor.row[tip, 0], 0] = 1.0 / len(tip)
        rows = factor.row[tip].ravel()
        c = factor.solve(loads, rows, rows)
        book_m = length_m**3 / (3 * 1e6 * side_m**4 / 12) + length_m / (5 / 6 * organ.shear_modulus_Pa * side_m**2)
        self.assertAlmostEqual(loads[factor.row[tip, 0], 0].mean() / book_m, 1.0, delta=0.015)
        self.assertAlmostEqual(c[0, 0, 0], loads[factor.row[tip, 0], 0].mean(), delta=1e-9 * book_m)

    def test_of_local_loads_is_what_a_sparse_solver_finds(self):
        organ, made = block(steps(0.06, 8), steps(0.06, 8), steps(0.06, 8), 1e-6)
        self.assertGreater(len(made.element), 16 * elastic.LEAF, "in many parts")
        factor, random = compliance.Factor(organ, made), np.random.default_rng(1)
        patches = [np.flatnonzero(np.linalg.norm(made.node_m - at_m, axis=1) < 0.008)
                   for at_m in ([0.06, 0.03, 0.06], [0.0, 0.0, 0.03], [0.03, 0.03, 0.0])]  # the last is held
        loads = np.zeros((len(made.node_m), 3, 3, len(patches)))  # node, direction, load, patch
        for k, patch in enumerate(patches):
            loads[patch, :, :, k] = random.normal(size=(len(patch), 3, 3))
        wanted = np.flatnonzero(np.linalg.norm(made.node_m - made.node_m[patches[0][0]], axis=1) < 0.02)
        moved = np.zeros((len(factor.part) + 1, 3, len(patches)))
        moved[factor.row] = loads
        c = factor.solve(moved, factor.row[np.concatenate(patches)].ravel(), factor.row[wanted].ravel())
        known = solved_directly(organ, made, loads.reshape(len(made.node_m), 3, -1)).reshape(loads.shape)
        np.testing.assert_allclose(c, np.einsum("nipk,niqk->pqk", loads, known), atol=1e-9 * np.abs(c).max())
        np.testing.assert_allclose(moved[factor.row[wanted], 0], known[wanted, :, 0], atol=1e-9 * np.abs(known).max())
        self.assertEqual(np.abs(moved[-1]).max(), 0.0, "all held nodes")

    def test_refuses_a_body_that_is_not_held(self):
        organ, made = cushion()
        edge = np.flatnonzero((made.node_m[:, 2] < 1e-9) & (made.node_m[:, 0] < 1e-9))
        for held in (np.array([], dtype=np.int64), edge):  # it can turn about the edge
            with self.assertRaisesRegex(run.Failure, "elastic.fixed_min_m to elastic.fixed_max_m hold every part"):
                compliance.Factor(organ, replace(made, held=held))
        with self.assertRaisesRegex(run.Failure, "not positive definite"):
            compliance.Factor(*cushion(poisson_ratio=0.6))


class Condensation(Solves):
    def setUp(self):
        super().setUp()
        self.organ, self.made = cushion()
        self.condensed = compliance.Condensation(self.organ, self.made, 0.02, 0.008, 4)

    def test_knows_where_the_organ_is_stiff_and_where_it_gives(self):
        rows = self.condensed.run(2, "")
        middle, edge, corner, held = (rows[nearest(self.organ.vertex_m, at_m), 0] for at_m in
                                      ([0.03, 0.03, 0.03], [0.06, 0.03, 0.03], [0.06, 0.06, 0.03], [0.03, 0.03, 0.0]))
        self.assertLess(middle, 0.0, "the held bottom is near")
        self.assertGreater(edge, middle, "beside it there is nothing to push")
        self.assertGreater(corner, edge)
        half = compliance.half_space_normal_m_per_N(self.organ, 0.02)
        self.assertAlmostEqual(held / -half, 1.0, delta=1e-4, msg="a held place is stiffer than a half-space by all of it")

    def test_is_the_solution_of_its_own_loads(self):
        vertex = nearest(self.organ.vertex_m, [0.045, 0.015, 0.03])
        r, n1, n2, s1, s2, ax, ay, az, *rings = self.condensed.of_vertices(np.array([vertex]))[0]
        boundary = self.condensed.boundary
        place, weight = boundary.patch(np.searchsorted(boundary.node, vertex), 0.02)
        axis = np.array([self.organ.vertex_normal[vertex], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        loads = np.zeros((len(self.made.node_m), 3, 3))
        loads[boundary.node[place]] = weight[:, None, None] * axis.T
        moved = solved_directly(self.organ, self.made, loads)
        c = np.einsum("pi,a,aiq->pq", axis, weight, moved[boundary.node[place]])
        c[0, 0] -= compliance.half_space_normal_m_per_N(self.organ, 0.02)
        c[1:, 1:] -= compliance.half_space_tangential_m_per_N(self.organ, 0.02) * np.eye(2)
        turn = np.array([[ax, ay], [-ay, ax]])
        scale = 1e-9 * c[0, 0] + 1e-9
        self.assertAlmostEqual(az, 0.0, delta=1e-12)
        np.testing.assert_allclose(turn @ turn.T, np.eye(2), atol=1e-12)
        # Here x, y and z are right-handed; turned back from the axes that the map gives.
        np.testing.assert_allclose(turn.T @ np.diag([s1, s2]) @ turn, c[1:, 1:], atol=scale)
        np.testing.assert_allclose(turn.T @ [n1, n2], c[0, 1:], atol=scale)
        self.assertAlmostEqual(r, c[0, 0], delta=scale)
        # Ring by ring, node by node.
        n = axis[0]
        for j, ring in enumerate(rings, 1):
            shares, sum_g = 0.0, 0.0
            for node, normal in zip(boundary.node, boundary.normal):
                rho_m = np.linalg.norm(self.made.node_m[node] - self.made.node_m[vertex])
                share = max(0.0, 1.0 - abs(rho_m / 0.008 - j))
                if normal @ n >= 0.2:
                    shares += share
                    sum_g += share * (n @ moved[node, :, 0] - compliance.half_space_m_per_N(self.organ, 0.02, rho_m))
            self.assertAlmostEqual(ring, sum_g / shares, delta=scale)

    def test_the_order_of_its_jobs_changes_nothing(self):
        rows = self.condensed.run(2, "")
        backward = np.arange(len(rows))[::-1]
        together = self.condensed.of_vertices(backward)
        np.testing.assert_allclose(together, rows[backward], atol=1e-9 * np.abs(rows).max())

    def test_refuses_a_patch_that_falls_between_the_points_of_the_sum(self):
        condensed = compliance.Condensation(self.organ, self.made, 1e-5, 0.008, 4)
        with self.assertRaisesRegex(run.Failure, "a patch of 1e-05 m is too small for the elements at vertex 7; make the patch"):
            condensed.of_vertices(np.array([7]))
