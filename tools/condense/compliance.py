# SPDX-License-Identifier: Apache-2.0
"""The linear elastic organ reduced to its surface: the compliance map of model/tissue.

For every vertex of the surface three unit loads, normal and two tangential, over a Hertz patch of radius a0, at E = 1 Pa:

    p(rho) = (3 F / (2 pi a0^2)) sqrt(1 - rho^2 / a0^2)   pressure, rho <= a0
    w_a    = integral of p N_a dA / F,  sum w_a = 1       share of F that node a carries
    C_pq   = sum w_a e_p . u_a^(q)                        compliance averaged over the patch, m/N
    r E    = C_nn - 3 / (5 E* a0)                         beyond a half-space's; the rest likewise with C_t
    g_j E  = mean over the ring j of  n . u^(n) - u_half(rho)

A force on one point of a continuum sinks without limit; spread over a patch of known size it has a limit, and that of a
half-space is exact [Johnson, Contact Mechanics (1985), 3.4 and 3.6]:

    u_half(rho) = 3 F (2 a0^2 - rho^2) / (8 E* a0^3)   inside;   C_n = 3 / (5 E* a0),   C_t = 3 (2 - nu) / (20 G a0)

a0 patch radius, m; rho straight distance from the middle of the patch, m; E* = E / (1 - nu^2), Pa; G shear modulus, Pa.
Ring j gathers the boundary's nodes at distance rho from the vertex that face its way, weighted by a hat that reaches one pitch
to either side. Elements near the surface should be no longer than about a0 / 1.6, inside the body too: flat elements behind a
fine surface make r too small.
"""
import numpy as np
import scipy.linalg

import elastic
import run
import surface

CUTS = 8  # a triangle is cut into CUTS^2 for the integral of p N_a
JOB_VERTICES = 32  # vertices of a job: neighbours, whose loads reach the same few parts of the body
FACING = 0.2  # cosine of a node's normal with the vertex's, as kFacing of model/contact/surface.h
MIN_PIVOT_RATIO = 1e-11  # of its stiffness; below: rounding error of an unknown that moves without force
LEAST_NODES = 1e-3  # chosen: a ring of less has no boundary


def part_middles():
    """Barycentric middles (CUTS^2, 3) of equal parts of a triangle."""
    up = [(i + 1 / 3, j + 1 / 3) for i in range(CUTS) for j in range(CUTS - i)]
    down = [(i + 2 / 3, j + 2 / 3) for i in range(CUTS) for j in range(CUTS - i - 1)]
    a, b = np.array(up + down).T / CUTS
    return np.stack([1.0 - a - b, a, b], axis=1)


MIDDLES = part_middles()
# N_a = L (2 L - 1) at a corner, 4 L_i L_(i+1) in the middle of an edge. That of a corner is negative near the opposite side.
SHAPE = np.hstack([MIDDLES * (2.0 * MIDDLES - 1.0), 4.0 * MIDDLES * MIDDLES[:, surface.NEXT]])


class Boundary:
    """The surface of a body: its nodes, and its faces by the places of these."""

    def __init__(self, made):
        self.node, face = np.unique(made.face, return_inverse=True)
        self.face, self.at_m = face.reshape(-1, 6), made.node_m[self.node]
        normal = np.zeros((len(self.node), 3))
        for column in self.face.T:
            np.add.at(normal, column, made.normal)
        self.normal = surface.unit(normal)

    def away_m(self, centre):
        return np.linalg.norm(self.at_m - self.at_m[centre], axis=1)

    def patch(self, centre, radius_m):
        """Places of nodes and their weights w_a; none where the patch falls between the points of the sum.

        The patch grows from face to face: over the rim of a thin lobe it would reach the far side only by walking there.
        """
        near = self.face[(self.away_m(centre)[self.face] < radius_m).any(axis=1)]
        reached = np.zeros(len(self.node), dtype=bool)
        reached[centre] = True
        while True:
            face = near[reached[near].any(axis=1)]
            if reached[face].all():
                break
            reached[face] = True
        corner_m = self.at_m[face[:, :3]]
        area = np.linalg.norm(np.cross(corner_m[:, 1] - corner_m[:, 0], corner_m[:, 2] - corner_m[:, 0]), axis=1)
        ratio = np.linalg.norm(MIDDLES @ corner_m - self.at_m[centre], axis=2) / radius_m
        pressure = np.sqrt(np.maximum(0.0, 1.0 - ratio**2)) * area[:, None]
        weight = np.zeros(len(self.node))
        np.add.at(weight, face, pressure @ SHAPE)
        place = np.flatnonzero(weight)
        return place, weight[place] / pressure.sum() if len(place) else weight[place]


def half_space_m_per_N(organ, radius_m, rho_m):
    """Displacement at the distances rho (n,) under a unit normal force on the patch."""
    a, r = radius_m, np.asarray(rho_m)
    scale, out = 3.0 / (8.0 * organ.contact_modulus_Pa * a**3), np.maximum(r, a)
    # Outside: u = (3 F / (4 pi E* a^3)) [(2 a^2 - r^2) asin(a / r) + a sqrt(r^2 - a^2)]
    beyond = (2.0 * a**2 - out**2) * np.arcsin(a / out) + a * np.sqrt(out**2 - a**2)
    return scale * np.where(r <= a, 2.0 * a**2 - r**2, 2.0 / np.pi * beyond)


def half_space_normal_m_per_N(organ, radius_m):
    """C_n: the mean of u over the patch, weighted by the pressure."""
    return 3.0 / (5.0 * organ.contact_modulus_Pa * radius_m)


def half_space_tangential_m_per_N(organ, radius_m):
    """C_t: for a traction of that shape along the surface (2 - nu) / (4 G) takes the place of 1 / E* (Johnson 3.6)."""
    return 3.0 * (2.0 - organ.poisson_ratio) / (20.0 * organ.shear_modulus_Pa * radius_m)


class Factor(elastic.Elimination):
    """K = L L' of a body that is held, by parts: a local load and its neighbourhood need but few of them."""

    def __init__(self, organ, made):
        depth = max(0, int(np.ceil(np.log2(len(made.element) / elastic.LEAF))))
        is_free = np.ones(len(made.node_m), dtype=bool)
        is_free[made.held] = False
        unknown = np.flatnonzero(np.repeat(is_free, 3))
        self.row = np.full(3 * len(made.node_m), len(unknown))  # of each displacement; the last is that of all held nodes
        self.row[unknown] = np.arange(len(unknown))
        self.row = self.row.reshape(-1, 3)
        self.part, self.factor = np.repeat(elastic.part_of_nodes(made, depth), 3)[unknown], {}
        stiffness = elastic.stiffness(organ, made)[unknown][:, unknown]
        self.min_pivot = MIN_PIVOT_RATIO * stiffness.diagonal()
        super().__init__(stiffness, self.part, depth)
        try:
            self.left_of(1)
        except np.linalg.LinAlgError:  # a part of the body can move without force
            raise run.Failure("finite elements: the stiffness is not positive definite; make the box from elastic.fixed_min_m "
                              "to elastic.fixed_max_m hold every part of the organ") from None

    def keep(self, part, own, around, lower, solved):
        if (lower.diagonal()**2 < self.min_pivot[own]).any():
            raise np.linalg.LinAlgError
        self.factor[part] = own, around, lower, solved

    def parts_of(self, rows):
        """The parts that have these rows, and those that they are halves of; ascending."""
        parts = set(self.part[rows[rows < len(self.part)]].tolist())
        for part in list(parts):
            while (part := part >> 1) and part not in parts:
                parts.add(part)
        return sorted(parts & self.factor.keys())

    def solve(self, loads, loaded, wanted):
        """B' K^-1 B, (3, 3, k), of the loads B (rows, 3, k), each k by itself; of the first of three also the displacements.

        These take the place of the load in the wanted rows; what is left elsewhere has no meaning.
        """
        flat, first, c = loads.reshape(len(loads), -1), loads[:, 0], np.zeros((3, *loads.shape[1:]))
        for part in reversed(self.parts_of(loaded)):
            own, around, lower, solved = self.factor[part]
            flat[own] = scipy.linalg.solve_triangular(lower, flat[own], lower=True, check_finite=False)
            flat[around] -= solved.T @ flat[own]
            c += np.einsum("npk,nqk->pqk", loads[own], loads[own])  # K = L L', so that L^-1 B is enough
        for part in self.parts_of(wanted):
            own, around, lower, solved = self.factor[part]
            rest = first[own] - solved @ first[around]
            first[own] = scipy.linalg.solve_triangular(lower, rest, trans=1, lower=True, check_finite=False)
        loads[-1] = 0.0  # held nodes: forces on them do nothing
        return c

    def order_of(self, nodes):
        """Nodes, near each other in the elimination."""
        part = np.append(self.part, 1)[self.row[nodes, 0]]
        return nodes[np.argsort((part + 0.5) / 2.0**np.floor(np.log2(part)), kind="stable")]


class Condensation:
    """`organ` has E = 1 Pa: a compliance is that times E, as the map has it."""

    def __init__(self, organ, made, patch_radius_m, ring_pitch_m, rings):
        self.organ, self.boundary, self.radius_m = organ, Boundary(made), patch_radius_m
        self.pitch_m, self.rings = ring_pitch_m, rings
        self.factor = Factor(organ, made)

    def of_vertices(self, vertices):
        """Rows (k, 8 + rings): r E, then n1, n2, s1, s2, first axis, then g_j E, as compliance_file.h has them."""
        boundary, row = self.boundary, self.factor.row[self.boundary.node]
        places = np.searchsorted(boundary.node, vertices)
        patches = [boundary.patch(place, self.radius_m) for place in places]
        for vertex, patch in zip(vertices, patches):
            if len(patch[0]) == 0:
                raise run.Failure(f"condensation: a patch of {self.radius_m:g} m is too small for the elements at vertex "
                                  f"{vertex}; make the patch wider or the elements finer")
        axes = [np.array([n, *surface.across(n)]) for n in self.organ.vertex_normal[vertices]]
        moved = np.zeros((len(self.factor.part) + 1, 3, len(vertices)))
        wanted = np.zeros(len(boundary.node), dtype=bool)
        for k, ((node, weight), axis) in enumerate(zip(patches, axes)):
            moved[row[node], :, k] = weight[:, None, None] * axis.T
            wanted |= boundary.away_m(places[k]) < (self.rings + 1) * self.pitch_m
        loaded = np.unique(np.concatenate([row[node].ravel() for node, _ in patches]))
        c = self.factor.solve(moved, loaded, row[wanted].ravel())
        return np.array([self.row_of(place, axis, c[:, :, k], moved[row, 0, k] @ axis[0])
                         for k, (place, axis) in enumerate(zip(places, axes))])

    def row_of(self, place, axis, c, displacement):
        """displacement: how far the nodes of the surface go along the normal under the normal load."""
        # Less the half-space under the same patch: the part that knows only the patch cancels.
        normal = c[0, 0] - half_space_normal_m_per_N(self.organ, self.radius_m)
        side = c[1:, 1:] - half_space_tangential_m_per_N(self.organ, self.radius_m) * np.eye(2)
        # Turn the tangential axes until c12 = 0: tan(2 angle) = 2 c12 / (c11 - c22).
        angle = 0.5 * np.arctan2(2.0 * c[1, 2], side[0, 0] - side[1, 1])
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        turned = turn @ side @ turn.T
        return np.concatenate([[normal], turn @ c[0, 1:], turned.diagonal(), turn[0] @ axis[1:],
                               self.rings_of(place, axis[0], displacement)])

    def rings_of(self, place, normal, displacement):
        rho_m = self.boundary.away_m(place)
        g = displacement - half_space_m_per_N(self.organ, self.radius_m, rho_m)
        at = rho_m / self.pitch_m
        counts = np.flatnonzero((at < self.rings + 1) & (self.boundary.normal @ normal >= FACING))
        low, g_of, high_share = at[counts].astype(np.int64), g[counts], at[counts] % 1.0
        # A hat a ring: a node between two rings counts for both, by its nearness.
        ring, share = np.concatenate([low, low + 1]), np.concatenate([1.0 - high_share, high_share])
        nodes = np.bincount(ring, share, self.rings + 2)
        sums = np.bincount(ring, share * np.tile(g_of, 2), self.rings + 2)
        out, before = [], g[place]  # at rho = 0, should no boundary beside it count
        for j in range(self.rings + 1):
            before = sums[j] / nodes[j] if nodes[j] > LEAST_NODES else before  # beyond an edge: as the last ring
            out.append(before)
        return out[1:]

    def run(self, processes, label):
        """Rows as of_vertices, of all vertices, in processes that share the factor."""
        order = self.factor.order_of(np.arange(len(self.organ.vertex_m)))
        jobs = np.split(order, range(JOB_VERTICES, len(order), JOB_VERTICES))
        rows = np.empty((len(order), 8 + self.rings))
        rows[order] = np.vstack(run.run_jobs(self.of_vertices, jobs, processes, label))
        return rows
