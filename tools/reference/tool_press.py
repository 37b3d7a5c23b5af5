# SPDX-License-Identifier: Apache-2.0
"""All spheres of a tool pressed into an organ together: one rigid body, no friction, linear elastic.

Pressure acts along the surface's inward normal m, by which the tissue gives way, and across it the tissue slides freely. A load
along the way would drag faces that lean against it: 10 % at a rim. The contact area is not known
beforehand, and each sphere changes it for the others, so it is found: pressure is linear over each face of the surface,

    p(x) = sum_v p_v h_v(x)                         h_v hat of the corner v
    C_vw = int h_v u^w . m dA                       u^w under the pressure h_w
    g_v  = int h_v (d + o(x)) c dA                  o how far the tool reaches beyond x at d = 0
    F    = sum_v p_v int h_v c dA                   along the way;   c = m . way

and p is that of solve_contact(). Every depth d has the same C. o(x) = max over the spheres of c + sqrt(R^2 - rho^2) - s, c and
s where centre and x lie along the way, rho the distance of x from the sphere's axis. m, N, Pa.
"""
from dataclasses import dataclass, field

import numpy as np
import scipy.linalg
import scipy.sparse

import contact
import elastic
import surface
from body import make_body
from run import Failure

# A level: edge of an element over its distance from the tip, and the longest inside the body, m.
LEVELS = [(0.5, 16e-3), (0.35, 14e-3), (0.25, 12e-3), (0.175, 10e-3), (0.125, 8e-3)]
WIDEST_TOUCH = 0.99  # of R: beyond, a sphere's side is too steep to touch
TALLEST = 4.0  # of the largest R: what lies further above is not near it
SAME_POINT_M = 1e-7
TIMEOUT, PIVOTS, ZERO = 10, 50, 1e-10  # rounds of many that make it no better; times the unknowns; of the largest value
# Radon's seven points of a triangle (1948), barycentric, and their shares of the area: exact to the fifth power.
A, B = 0.470142064105115, 0.101286507323456
GAUSS = np.vstack([np.full((1, 3), 1 / 3), A + (1 - 3 * A) * np.eye(3), B + (1 - 3 * B) * np.eye(3)])
WEIGHT = np.array([0.225, *[0.132394152788506] * 3, *[0.125939180544827] * 3])


@dataclass(frozen=True)
class Press:
    """The way and the spheres of a tool."""
    direction: tuple[float, ...]  # (3,), of the way, unit, into the tissue
    centre_m: tuple[tuple[float, ...], ...]  # (s, 3), of the spheres at depth 0, in the mesh's own frame
    radius_m: tuple[float, ...]  # (s,)
    depths_m: tuple[float, ...]  # above 0, rising


@dataclass(frozen=True)
class ToolPress(Press):
    skin: tuple[int, ...] = ()  # vertices of the organ's surface whose way is wanted
    level: int = 2


@dataclass
class ToolCase:
    depth_m: float
    force_N: float  # on the tool against the direction
    sphere_N: list[float]  # of each sphere
    skin_m: list[float] = field(default_factory=list)  # how far each vertex of the surface goes along the way
    force_error_ratio: float | None = None  # takes two levels


def edge_lengths(organ, what):
    """Edges in proportion to the distance from the nearest sphere's tip."""
    slope, largest_m = LEVELS[what.level]
    least_m = min(contact.sphere_contact_radius_m(r, what.depths_m[0]) for r in what.radius_m)
    tips_m = np.array(what.centre_m) + np.array(what.radius_m)[:, None] * np.array(what.direction)
    return surface.EdgeLengths(tips_m, least_m, slope * least_m, slope, largest_m * organ.size_ratio)


def reach_beyond(what, point_m):
    """How far each sphere reaches beyond points (..., 3) at depth 0, m, (..., s); beside it minus infinity."""
    way, radius_m = np.array(what.direction), np.array(what.radius_m)
    off_m = point_m[..., None, :] - np.array(what.centre_m)
    along_m = off_m @ way
    rho2_m2 = np.einsum("...i,...i->...", off_m, off_m) - along_m**2
    beyond_m = np.sqrt(np.maximum(0.0, radius_m**2 - rho2_m2)) - along_m
    return np.where(rho2_m2 <= (WIDEST_TOUCH * radius_m)**2, beyond_m, -np.inf), -along_m


@dataclass
class Patch:
    """Corners (n,) that the tool may touch, and what unit pressure on the hat of each does."""
    sphere: np.ndarray  # (n,), that is over the corner
    area_m2: np.ndarray  # (n,), int h_v c dA
    overlap_m3: np.ndarray  # (n,), int h_v o c dA, at depth 0
    push_m2: scipy.sparse.coo_matrix  # (3 N, n), int h_v N_a m dA


def make_patch(body, what):
    way, deepest_m = np.array(what.direction), what.depths_m[-1]
    facing = body.normal @ way <= -surface.FACING
    face, inward = body.face[facing], -body.normal[facing]
    corners = np.unique(face[:, :3])
    reach_m = reach_beyond(what, body.node_m[corners])[0]
    beyond_m = reach_m.max(axis=1) + deepest_m
    is_near = (beyond_m > 0.0) & (beyond_m <= TALLEST * max(what.radius_m) + deepest_m)
    corners, sphere = corners[is_near], reach_m[is_near].argmax(axis=1)
    number = np.full(len(body.node_m), -1)
    number[corners] = np.arange(len(corners))
    touched = (number[face[:, :3]] >= 0).any(axis=1)
    face, inward = face[touched], inward[touched]
    p, vertex = body.node_m[face[:, :3]], number[face[:, :3]]
    doubled = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    reach_m, above_m = reach_beyond(what, np.einsum("gk,fki->fgi", GAUSS, p))
    # Beside a sphere its side goes on straight: there is no pressure.
    beside_m = np.take_along_axis(above_m, sphere[vertex][:, None, :], axis=2)
    beyond_m = np.where(np.isfinite(reach_m.max(axis=2, keepdims=True)), reach_m.max(axis=2, keepdims=True), beside_m)
    hat_m2 = 0.5 * np.einsum("f,g,gk->fgk", doubled, WEIGHT, GAUSS)  # face, Gauss point, corner
    along_m2 = hat_m2 * (inward @ way)[:, None, None]
    shape = np.hstack([GAUSS * (2.0 * GAUSS - 1.0), 4.0 * GAUSS * GAUSS[:, surface.NEXT]])  # (7, 6), of a six-node face
    push_m2 = np.einsum("fgk,gj,fi->fkji", hat_m2, shape, inward)
    row, column = np.broadcast_arrays((3 * face[:, :, None] + np.arange(3))[:, None], vertex[:, :, None, None])
    known = vertex >= 0
    total = [np.bincount(vertex[known], x.sum(axis=1)[known], len(corners)) for x in (along_m2, along_m2 * beyond_m)]
    size, entries = (3 * len(body.node_m), len(corners)), (row[known].ravel(), column[known].ravel())
    return Patch(sphere, *total, scipy.sparse.coo_matrix((push_m2[known].ravel(), entries), size))


def solve_contact(compliance, overlap):
    """p (n,) with p >= 0, C p >= g, p . (C p - g) = 0: pressure only pushes, and nothing lies inside.

    p pressures, g how far the bodies would overlap without them, C compliance, symmetric and positive definite: then there is
    exactly one p. Block principal pivoting: all that pulls leaves, all that overlaps joins; where that turns in a circle, one
    at a time, the one with the largest number, which ends for every such C. Source: J. J. Judice, F. M. Pires, Comput. Oper.
    Res. 21 (1994) 587.
    """
    inside, fewest, timeout = overlap > 0.0, len(overlap) + 1, TIMEOUT
    for _ in range(PIVOTS * len(overlap) + 1):
        pressure = np.zeros(len(overlap))
        try:
            if inside.any():
                pressure[inside] = scipy.linalg.solve(compliance[np.ix_(inside, inside)], overlap[inside], assume_a="pos")
        except np.linalg.LinAlgError:
            break
        residual = compliance @ pressure - overlap
        # Rounding of a pressure that is zero must not flip it for ever.
        least, least_gap = -ZERO * np.abs(pressure).max(initial=0.0), -ZERO * np.abs(overlap).max(initial=0.0)
        wrong = np.flatnonzero(np.where(inside, pressure < least, residual < least_gap))
        if len(wrong) == 0:
            return pressure
        timeout = TIMEOUT if len(wrong) < fewest else timeout - 1
        fewest = min(fewest, len(wrong))
        flipped = wrong if timeout > 0 else wrong[-1:]
        inside[flipped] = ~inside[flipped]
    raise Failure("the compliance of the patch is not positive definite; ask for another mesh level")


def surface_loads(organ, body, what):
    """A unit load along the way (3 N) on each node that was a vertex of the surface: a finer surface keeps them."""
    corners = np.unique(body.face[:, :3])
    nodes = []
    for vertex in what.skin:
        away_m = np.linalg.norm(body.node_m[corners] - organ.vertex_m[vertex], axis=1)
        if away_m.min() >= SAME_POINT_M:
            raise Failure(f"vertex {vertex} of the organ is not among the nodes")
        nodes.append(corners[away_m.argmin()])
    row, n = 3 * np.array(nodes, dtype=int)[:, None] + np.arange(3), len(nodes)
    entries = row.ravel(), np.repeat(np.arange(n), 3)
    return scipy.sparse.coo_matrix((np.tile(what.direction, n), entries), (3 * len(body.node_m), n))


def solve(organ, what):
    """A ToolCase for each depth."""
    body = make_body(organ, edge_lengths(organ, what))
    skin, patch = surface_loads(organ, body, what), make_patch(body, what)
    n = len(patch.sphere)
    if n == 0:
        raise Failure("the tool is out of contact at its deepest")
    moved = elastic.compliance(organ, body, scipy.sparse.hstack([patch.push_m2, skin]))
    cases = []
    for depth_m in what.depths_m:
        pressure = solve_contact(moved[:n, :n], patch.overlap_m3 + depth_m * patch.area_m2)
        each_N = pressure * patch.area_m2
        cases.append(ToolCase(depth_m, float(each_N.sum()), np.bincount(patch.sphere, each_N, len(what.radius_m)).tolist(),
                              (moved[n:, :n] @ pressure).tolist()))
    return cases
