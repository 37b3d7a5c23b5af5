# SPDX-License-Identifier: Apache-2.0
"""The solver against answers that no tact code made, and exact ones.

    organ   a closed body, patches of triangles moved as one piece (independent, CalculiX)
    block   a round block under a sphere and a bonded disc, linear and with large strain (independent, FEniCS; the linear bond:
            CalculiX)
    space   a big block under a sphere against the half-space (contact.py)
"""
import json
import math
import pathlib
from dataclasses import dataclass

import numpy as np

import calculix
import contact
import indentation
import surface
from body import Organ, make_body
from run import Code, Failure, run_jobs

MODULUS_PA, POISSON = 1000.0, 0.45  # as the independent answers have it; forces scale with E
RADIUS_M = 5e-3
LEVEL = 2
DISC_RINGS, SIDES = 8, 6
SAME_PLANE_M = 1e-9  # a finer triangle lies in its parent's plane up to rounding


@dataclass
class Known:
    name: str
    depth_m: float
    force_N: float
    bar_ratio: float  # of the force


def disc(radius_m):
    """Points (n, 2), ring k has 6 k of them, and triangles of about one size."""
    ring = np.repeat(np.arange(DISC_RINGS + 1), [1, *(SIDES * k for k in range(1, DISC_RINGS + 1))])
    start = np.searchsorted(ring, np.arange(DISC_RINGS + 1))
    angle_rad = 2.0 * np.pi * (np.arange(len(ring)) - start[ring]) / np.maximum(SIDES * ring, 1)
    triangles = []
    for k in range(1, DISC_RINGS + 1):
        i = np.arange(SIDES * k)
        inner, after = (start[k - 1] + (i - i // k + more) % max(SIDES * (k - 1), 1) for more in (0, 1))
        outer, following = start[k] + i, start[k] + (i + 1) % len(i)
        # The last of a side has no second triangle.
        triangles.append(surface.in_place([(i >= 0, inner, outer, following), ((i + 1) % k > 0, inner, following, after)]))
    point_m = (radius_m * ring / DISC_RINGS)[:, None] * np.array([(math.cos(a), math.sin(a)) for a in angle_rad])
    return point_m, np.vstack(triangles)


def make_block(size_m, modulus_Pa=MODULUS_PA, poisson_ratio=POISSON):
    """As wide as high, standing on its held bottom. Vertex 0 is the middle of the top, z = 0."""
    point, top = disc(size_m)
    n, rim = len(point), SIDES * DISC_RINGS
    point = np.hstack([point, np.zeros((n, 1))])
    a = n - rim + np.arange(rim)
    b = np.roll(a, -1)
    side = surface.in_place([(a >= 0, a, a + n, b + n), (a >= 0, a, b + n, b)])
    vertex_m = np.vstack([point, point - [0, 0, size_m]])
    far_m = np.full(3, 4.0 * size_m)
    block = Organ(vertex_m, np.vstack([top, n + top[:, [0, 2, 1]], side]), np.zeros_like(vertex_m), -far_m,
                  np.array([*far_m[:2], -size_m * (1.0 - 1e-9)]), modulus_Pa, poisson_ratio, size_ratio=max(1.0, size_m / 0.05))
    block.vertex_normal[:n - rim, 2] = 1.0  # of the top inside its rim
    return block


def check(known, force_N):
    off = force_N / known.force_N - 1.0
    good = abs(off) <= known.bar_ratio
    print(f"{'good' if good else 'BAD':<5} {known.name:<34} {force_N * 1e3:>9.3f} mN, known {known.force_N * 1e3:>9.3f} mN, "
          f"{off * 100.0:+.2f} % (bar {known.bar_ratio * 100.0:g} %)", flush=True)
    return good


def check_block(job):
    size_m, known, large_strain = job
    what = indentation.Indentation(0, RADIUS_M, known.depth_m, large_strain, indentation.COARSEST if large_strain else LEVEL)
    try:
        return check(known, indentation.solve(make_block(size_m), what)[0].force_N)
    except Failure as failure:
        if failure.code != Code.NO_SOLUTION:
            raise
        print(f"{known.name}: {failure.message}", flush=True)
        return False


def triangles_around(triangle, vertex, rings):
    """Rows (T,) of the triangles that touch `rings` rings of vertices around one."""
    vertices = np.array([vertex])
    for _ in range(rings):
        touched = np.isin(triangle, vertices).any(axis=1)
        vertices = np.unique(triangle[touched])
    return touched


def lies_in(point_m, corner_m):
    """Which of the points (n, 3) lie in one of the triangles (t, 3, 3)."""
    edge_m = corner_m[:, surface.NEXT] - corner_m
    normal = surface.unit(np.cross(edge_m[:, 0], edge_m[:, 1]))
    off_m = point_m[:, None, None] - corner_m
    inside = (np.einsum("ntki,ti->ntk", np.cross(edge_m, off_m), normal) >= 0.0).all(axis=2)
    return (inside & (np.abs(np.einsum("nti,ti->nt", off_m[:, :, 0], normal)) <= SAME_PLANE_M)).any(axis=1)


def check_patch(job):
    """One patch of the mesh's own triangles, moved as one piece."""
    organ, case = job
    vertex, rings, direction = case["vertex"], case["rings"], np.array(case["direction"])
    body = make_body(organ, surface.EdgeLengths(organ.vertex_m[[vertex]], 4.5e-3 * rings, 0.6e-3 * rings, 0.4, 9e-3))
    patch = organ.vertex_m[organ.triangle[triangles_around(organ.triangle, vertex, rings)]]
    moved = np.unique(body.face[lies_in(body.node_m[body.face[:, :3]].mean(axis=1), patch)])
    load = calculix.Load(direction, moved, np.full(len(moved), case["depth_m"]), is_bonded=True)
    force_N = calculix.solve(organ, body, load, moved[:1]).force_N @ direction
    # The independent answer's own error bar.
    return check(Known("organ patch " + case["name"], case["depth_m"], case["force_N"], 0.03), force_N)


def read_organ(folder):
    """The closed body, and its cases."""
    path = pathlib.Path(folder) / "organ_patch.json"
    try:
        known = json.loads(path.read_text())
        lines = [line.split() for line in (path.parent / known["mesh"]).read_text().splitlines()]
        vertex_m = np.array([words[1:4] for words in lines if words[:1] == ["v"]], dtype=float) * known["mesh_unit_m"]
        triangle = np.array([[word.split("/")[0] for word in words[1:4]] for words in lines if words[:1] == ["f"]], dtype=int) - 1
        box_m = np.full(3, -1.0), np.array([1.0, known["fixed_max_y_m"], 1.0])
        return Organ(vertex_m, triangle, np.zeros_like(vertex_m), *box_m, MODULUS_PA, POISSON), known["cases"]
    except FileNotFoundError as missing:
        raise Failure(f"{missing.filename}: no such file; give the folder tests/data/reference") from None
    except (OSError, ValueError, LookupError) as wrong:
        raise Failure(f"{path}: {wrong}; restore the file") from None


def block_checks():
    """(size m, Known, large strain) of each."""
    def of_block(size_m, large_strain, *rows):
        return [(size_m, Known(*row), large_strain) for row in rows]

    block = make_block(1.0)
    sphere_N = {depth_m: contact.sphere_force_N(block, RADIUS_M, depth_m) for depth_m in (1e-3, 5e-3)}
    # A bond is 0.3 % stiffer than a frictionless punch at this nu.
    punch_N = -1.003 * contact.flat_punch_force_N(block, RADIUS_M, 1e-3)
    return [
        # Block 50 x 50 mm, E = 1 kPa, nu = 0.45: FEniCS, contact by penalty; the bond: CalculiX.
        *of_block(0.05, False, ("block, sphere R 5 mm at 1 mm", 1e-3, 3.801e-3, 0.02),
                  ("block, sphere R 5 mm at 2 mm", 2e-3, 10.68e-3, 0.02), ("block, sphere R 5 mm at 5 mm", 5e-3, 40.46e-3, 0.02),
                  ("block, sphere R 5 mm at 10 mm", 10e-3, 103.5e-3, 0.02),
                  ("block, bonded disc pulled 1 mm", -1e-3, -13.722e-3, 0.03)),
        # The same block, neo-Hookean, all by FEniCS. Bars: the coarsest mesh has 3 % under a sphere, 6 % at the rim of a bond.
        *of_block(0.05, True, ("large strain, sphere at 1 mm", 1e-3, 3.776e-3, 0.03),
                  ("large strain, sphere at 2 mm", 2e-3, 10.57e-3, 0.03), ("large strain, sphere at 5 mm", 5e-3, 39.16e-3, 0.03),
                  ("large strain, sphere at 10 mm", 10e-3, 89.1e-3, 0.03),
                  ("large strain, disc pulled 1 mm", -1e-3, -13.76e-3, 0.06),
                  ("large strain, disc pulled 5 mm", -5e-3, -63.4e-3, 0.06)),
        *of_block(1.0, False, ("half-space, sphere at 1 mm", 1e-3, sphere_N[1e-3], 0.02),
                  ("half-space, sphere at 5 mm", 5e-3, sphere_N[5e-3], 0.02), ("half-space, bonded disc", -1e-3, punch_N, 0.03))]


def self_check(folder, processes):
    """Prints one line a case; True if all are within their bars. Takes about a quarter of an hour."""
    organ, patches = read_organ(folder)
    jobs = [(check_patch, (organ, case)) for case in patches] + [(check_block, check) for check in block_checks()]
    return all(run_jobs(lambda job: job[0](job[1]), jobs, processes, label=""))
