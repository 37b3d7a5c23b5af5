# SPDX-License-Identifier: Apache-2.0
"""Triangle surfaces: finer near a point, cut along a circle, pierced by straight ways, averaged along rings.

A surface is vertex_m, (V, 3), and triangle, (T, 3) vertex numbers, counter-clockwise seen from outside.
"""
from dataclasses import dataclass

import numpy as np

from run import Failure

FACING = 0.1  # cosine of a face's normal with the site's: the others are the organ's far side
MAX_ROUNDS = 40  # two halve a triangle's edges: from 0.1 m to 0.1 um, far below any tool
MAX_TRIANGLES = 1_000_000  # gmsh would need days for the body of more
NEXT = np.array([1, 2, 0])


def unit(v):
    """v (..., 3) of length 1."""
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def across(direction):
    """Two unit vectors at right angles to a unit vector; with it they are right-handed."""
    first = unit(np.cross(direction, [1, 0, 0] if abs(direction[0]) < 0.6 else [0, 1, 0]))
    return first, np.cross(direction, first)


@dataclass
class Circle:
    """About an axis, drawn on the surface by a cylinder."""
    at_m: np.ndarray  # (3,)
    axis: np.ndarray  # (3,), unit
    radius_m: float

    def away_m(self, point_m):
        """Distance of points (..., 3) from the axis."""
        r = point_m - self.at_m
        return np.linalg.norm(r - (r @ self.axis)[..., None] * self.axis, axis=-1)


@dataclass
class EdgeLengths:
    """h(x) = min(largest, fine + growth distance of x), from balls of one radius or from a circle about the axis."""
    at_m: np.ndarray  # (k, 3): the nearest ball counts
    radius_m: float
    fine_m: float
    growth: float  # of the edge per distance
    largest_m: float = np.inf
    axis: np.ndarray | None = None  # unit, of the circle; then k is 1

    def at(self, point_m):
        """h of points (n, 3), m."""
        r = point_m[:, None] - self.at_m
        if self.axis is None:
            away_m = np.maximum(0.0, np.linalg.norm(r, axis=2).min(axis=1) - self.radius_m)
        else:
            height_m = r[:, 0] @ self.axis
            away_m = np.hypot(np.linalg.norm(r[:, 0] - height_m[:, None] * self.axis, axis=1) - self.radius_m, height_m)
        return np.minimum(self.largest_m, self.fine_m + self.growth * away_m)


def edges_of(triangle):
    """Ends (T, 3, 2), ascending, of the edges 01, 12, 20, and one number (T, 3) for each, the same from either side."""
    ends = np.sort(np.stack([triangle, triangle[:, NEXT]], axis=2).astype(np.int64), axis=2)
    return ends, ends[..., 0] << 32 | ends[..., 1]


def turned(triangle, first):
    """The columns of (T, 3), each row beginning with its column first[row]."""
    return np.take_along_axis(triangle, (first[:, None] + np.arange(3)) % 3, axis=1)


def middle_of(marked, key, vertices):
    """Number of the new vertex of each edge, counted from `vertices` in the order of `marked`; -1 if it is not among them."""
    order = np.argsort(marked)
    place = order[np.minimum(np.searchsorted(marked, key, sorter=order), len(marked) - 1)]
    return np.where(marked[place] == key, vertices + place, -1)


def as_met(key, marked):
    """The marked edges, each once, in the order in which `key` (T, k) has them."""
    met = key[np.isin(key, marked)]
    return met[np.sort(np.unique(met, return_index=True)[1])]


def in_place(parts):
    """Triangles (n, 3) of parts (chosen triangles (T,), three corners (T,)): those of one triangle together, in their order."""
    out = np.vstack([np.stack(corners, axis=1)[chosen] for chosen, *corners in parts])
    return out[np.argsort(np.concatenate([np.flatnonzero(chosen) for chosen, *_ in parts]), kind="stable")]


def halved(vertex_m, triangle, key, longest, marked):
    """Every marked edge split at its middle; a triangle that has one also splits its longest."""
    a, b, c = turned(triangle, longest).T
    key = turned(key, longest)
    marked = as_met(key, marked)
    ab, bc, ca = middle_of(marked, key, len(vertex_m)).T
    split = ab >= 0
    parts = [(~split, *triangle.T)]
    for p, q, m in ((b, c, bc), (c, a, ca)):
        parts += [(split, ab, p, np.where(m < 0, q, m)), (split & (m >= 0), ab, m, q)]
    new_m = 0.5 * (vertex_m[marked >> 32] + vertex_m[marked & 0xFFFFFFFF])
    return np.vstack([vertex_m, new_m]), in_place(parts)


def refine(vertex_m, triangle, lengths):
    """Finer triangles on exactly the same polyhedron: Rivara's longest-edge partition. Old vertices keep their numbers.

    Edges longer than h at their middle are split; the surface stays conforming, and no angle falls below half of the smallest
    that was there. Source: M.-C. Rivara, Int. J. Numer. Meth. Eng. 20 (1984) 745.
    """
    for _ in range(MAX_ROUNDS if lengths.fine_m > 0.0 else 0):
        if len(triangle) >= MAX_TRIANGLES:
            break
        ends, key = edges_of(triangle)
        length2_m2 = ((vertex_m[ends[..., 0]] - vertex_m[ends[..., 1]])**2).sum(axis=2)
        longest = np.lexsort((key, -length2_m2), axis=1)[:, 0]  # of equal ones the least key, so neighbours agree
        rows = np.arange(len(triangle))
        key_of_longest, longest_ends = key[rows, longest], ends[rows, longest]
        goal_m = lengths.at(0.5 * vertex_m[longest_ends].sum(axis=1))
        marked, before = np.unique(key_of_longest[np.sqrt(length2_m2[rows, longest]) > goal_m]), -1
        if len(marked) == 0:
            return vertex_m, triangle
        while len(marked) != before:  # to the neighbours, until all agree
            before, touched = len(marked), np.isin(key, marked).any(axis=1)
            marked = np.unique(key_of_longest[touched])
        vertex_m, triangle = halved(vertex_m, triangle, key, longest, marked)
    x, y, z = lengths.at_m[0]
    raise Failure(f"the surface around ({x:.4g}, {y:.4g}, {z:.4g}) m cannot be refined to edges of {lengths.fine_m:.3g} m; "
                  "ask for a larger depth or a larger tool radius")


def crossings(vertex_m, key, circle):
    """Where the edges (n,) meet the circle's cylinder, which each meets once: halve the interval."""
    a, b = vertex_m[key >> 32], vertex_m[key & 0xFFFFFFFF]
    low, high, starts_inside = np.zeros(len(key)), np.ones(len(key)), circle.away_m(a) < circle.radius_m
    for _ in range(50):  # the distance from the axis may be curved
        half = 0.5 * (low + high)
        same = (circle.away_m(a + half[:, None] * (b - a)) < circle.radius_m) == starts_inside
        low, high = np.where(same, half, low), np.where(same, high, half)
    return a + low[:, None] * (b - a)


def cut_along(vertex_m, triangle, circle, reach_m):
    """Every triangle within reach_m of the circle's middle becomes part of the inside or of the outside.

    A vertex nearer than a fifth of its shortest edge counts as on the circle.
    """
    ends, key = edges_of(triangle)
    shortest_m = np.full(len(vertex_m), np.inf)
    length_m = np.linalg.norm(vertex_m[ends[..., 0]] - vertex_m[ends[..., 1]], axis=2)
    for end in (0, 1):
        np.minimum.at(shortest_m, ends[..., end], length_m)
    beyond_m = circle.away_m(vertex_m) - circle.radius_m
    side = np.sign(beyond_m) * (np.abs(beyond_m) > 0.2 * shortest_m)
    side[np.linalg.norm(vertex_m - circle.at_m, axis=1) > reach_m] = 0  # the cylinder meets the far side, too
    marked = np.unique(key[side[ends].prod(axis=2) < 0])
    if len(marked) == 0:
        return vertex_m, triangle
    s = side[triangle]
    s1, s2 = s[:, NEXT], s[:, NEXT[NEXT]]
    from_corner = (s == 0) & (s1 * s2 < 0)  # through the edge opposite
    cut = from_corner | ((s * s1 < 0) & (s * s2 < 0))  # or cuts the corner off
    first = cut.argmax(axis=1)
    a, b, c = turned(triangle, first).T
    key = turned(key, first)
    marked = as_met(key, marked)
    ab, bc, ca = middle_of(marked, key, len(vertex_m)).T
    whole, corner = ~cut.any(axis=1), from_corner.any(axis=1)
    off = ~whole & ~corner
    parts = [(whole, *triangle.T), (corner, a, b, bc), (corner, a, bc, c), (off, a, ab, ca), (off, ab, b, c), (off, ab, c, ca)]
    return np.vstack([vertex_m, crossings(vertex_m, marked, circle)]), in_place(parts)


def thickness(corner_m, face_normal, from_m, direction):
    """Straight ways from points (n, 3) along one unit vector through a closed surface of triangles (T, 3, 3), m: (n,) and (n,).

    First how far it is to where the way goes in (below 0: the point lies inside), then from there to where it comes out; NaN
    where it does not go through. Source: T. Moeller, B. Trumbore, J. Graphics Tools 2 (1997) 21.
    """
    a, b, c = corner_m.transpose(1, 0, 2)
    e1, e2 = b - a, c - a
    p, det = np.cross(direction, e2), np.einsum("ti,ti->t", e1, np.cross(direction, e2))
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, way_m = ((from_m @ w.T - np.einsum("ti,ti->t", a, w)) / det for w in (p, np.cross(e1, direction), np.cross(e1, e2)))
        met = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        is_out = face_normal @ direction > 0.0
        out_m = np.where(met & is_out & (way_m > 0.0), way_m, np.inf).min(axis=1)
        in_m = np.where(met & ~is_out & (way_m < out_m[:, None]), way_m, -np.inf).max(axis=1)
        good = np.isfinite(out_m) & np.isfinite(in_m)
        return np.where(good, in_m, np.nan), np.where(good, out_m - in_m, np.nan)


def ring_means(corner_m, distance_m, value, rings, pitch_m, middle):
    """Mean of a value along the lines where the distance is k pitches, k = 0 .. rings - 1: (rings,).

    corner_m (T, 3, 3); distance_m and value (T, 3), linear within a triangle. Ring 0 is the value `middle`; a ring that meets
    no triangle has the mean of the one before.
    """
    means = [middle]
    for k in range(1, rings):
        below = distance_m < k * pitch_m
        crossed = np.flatnonzero(below.any(axis=1) & ~below.all(axis=1))
        odd = np.where(below[crossed].sum(axis=1) == 1, below[crossed].argmax(axis=1), below[crossed].argmin(axis=1))
        order = (odd[:, None] + np.arange(3)) % 3  # both cut edges begin at the odd corner
        rho, u = (np.take_along_axis(x[crossed], order, axis=1) for x in (distance_m, value))
        p = np.take_along_axis(corner_m[crossed], order[..., None], axis=1)
        t = (k * pitch_m - rho[:, :1]) / (rho[:, 1:] - rho[:, :1])
        cut_m = p[:, :1] + t[..., None] * (p[:, 1:] - p[:, :1])
        length_m = np.linalg.norm(cut_m[:, 0] - cut_m[:, 1], axis=1)
        at_cuts = (u[:, :1] + t * (u[:, 1:] - u[:, :1])).mean(axis=1)
        means.append(length_m @ at_cuts / length_m.sum() if length_m.sum() > 0.0 else means[-1])
    return np.array(means)
