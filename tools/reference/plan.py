# SPDX-License-Identifier: Apache-2.0
"""Which cases make the reference of an organ, under one sphere and along its surface, and how they become one file.

Per site: press at every depth; pull once, since it is linear, scaled to every depth. For some sites also press and pull with
large strain, at every depth (a pull up to LARGE_PULL R) and on the coarsest mesh: it says how far linear is wrong. The mesh
error of a force comes from its change from the next coarser level, solved at the least and the largest depth and for linear
pull; a depth between takes that of the nearer end. Not known (linear cases at the coarsest level, ends without a solution) is
None, null in the file. The error of the solver's steps is not in it: 1 % of a press with large strain two radii deep.
"""
from dataclasses import dataclass, replace

import numpy as np

import surface
from body import Organ
from indentation import COARSEST, ROUGH, Case, Indentation
from run import Failure

DEPTHS_M = [1e-3, 2e-3, 3.5e-3, 5e-3, 7e-3, 10e-3]  # chosen: steps in about the same ratio
UNIT_PULL_M = -1e-3  # linear: solved once and scaled to every depth
DRAGGED_M = 1e-3  # linear: any
MAX_DEPTH = 5.0  # of the tool's radius
# The deepest pull with large strain, of the tool's radius: elements at the rim of the bond that stand more are too coarse.
LARGE_PULL = 1.3
SHRINK = 0.7  # of edges, and of the error, from a level to the next finer one
# Measured on the block of --self-check: 5 mm with edges of 0.43, 0.3, 0.2 and 0.12 of the radius is 10.3, 9.2, 7.2 and 4.6 %
# above the known answer.
SHRINK_OF_LARGE_PULL = 0.8
# Dragged: radius of the patch, of the tool's, and whether it is held at its height; free to rise and sink as under a sphere.
PATCHES = [(1.0, True), (0.5, False), (1.0, False)]


@dataclass
class Plan:
    organ: Organ
    tool_radius_m: float
    sites: list[int]
    depths_m: list[float]  # above 0, rising
    large_strain_sites: list[int]  # also among sites
    level: int


def remaining_error(fine_N, coarse_N, shrink=SHRINK):
    """What is left of the error at the finer level, of the force.

    Edges shrink by k from one level to the next and the error with them (the rim of a contact is singular), so the rest of the
    series is k / (1 - k) of the last change.
    """
    return shrink / (1.0 - shrink) * abs(fine_N - coarse_N) / abs(fine_N)


def check(plan):
    """A Failure names the vertex or depth that cannot be solved."""
    organ, sites, depths_m = plan.organ, plan.sites, plan.depths_m
    if not sites:
        raise Failure("no site to solve; add [[reference_site]] to the scene, or give --sites")
    open_edges = (np.unique(surface.edges_of(organ.triangle)[1], return_counts=True)[1] == 1).sum()
    if open_edges:
        raise Failure(f"{organ.mesh} has {open_edges} open edges, so it has no inside; close the surface")
    for vertex in sites:
        if sites.count(vertex) > 1:
            raise Failure(f"site {vertex} is there twice; give it once")
        if vertex >= len(organ.vertex_m):
            raise Failure(f"site {vertex} is no vertex of {organ.mesh}; they are 0 to {len(organ.vertex_m) - 1}")
        if organ.held(organ.vertex_m[vertex]):
            raise Failure(f"site {vertex} lies in the held box, elastic.fixed_min_m to elastic.fixed_max_m; choose another, or "
                          "move the box")
    for vertex in plan.large_strain_sites:
        if vertex not in sites:
            raise Failure(f"large strain at {vertex}, which is no site; add it to --sites")
    most_m = MAX_DEPTH * plan.tool_radius_m
    if not depths_m or not all(a < b <= most_m for a, b in zip([0.0, *depths_m], depths_m)):  # a NaN is neither
        raise Failure(f"--depths must rise, all above 0 and at most {most_m:.3g} m ({MAX_DEPTH:g} tool radii); give metres: "
                      "0.001,0.002")


def large_pulls_m(plan):
    return [d for d in plan.depths_m if d <= LARGE_PULL * plan.tool_radius_m]


def cases_of(plan):
    """Every solve of the plan, each once."""
    out = []
    for vertex in plan.sites:
        def add(depths_m, level, large_strain=False):
            out.extend(Indentation(vertex, plan.tool_radius_m, d, large_strain, level) for d in depths_m)
        ends_m = plan.depths_m[:1] + plan.depths_m[1:][-1:]
        add([*plan.depths_m, UNIT_PULL_M], plan.level)
        if plan.level > COARSEST:  # both ends one level coarser: their change shows the error that is left
            add([*ends_m, UNIT_PULL_M], plan.level - 1)
        if vertex in plan.large_strain_sites:
            pulls_m = [-d for d in large_pulls_m(plan)]
            add([*plan.depths_m, *pulls_m], COARSEST, True)
            add([*ends_m, *pulls_m[:1], *pulls_m[1:][-1:]], ROUGH, True)
    return out


def with_errors(fine: list[Case], coarse: list[Case]):
    """The fine cases of one way to load a site, each with the error of the nearest depth that is solved at both levels."""
    pairs = [(f, c) for c in coarse for f in fine if f.depth_m == c.depth_m]
    out = []
    for case in fine:
        if pairs:
            f, c = min(pairs, key=lambda pair: abs(pair[0].depth_m - case.depth_m))
            # At the rim of a bond at large strain the error shrinks slower.
            shrink = SHRINK_OF_LARGE_PULL if c.large_strain and c.depth_m < 0.0 else SHRINK
            case = replace(case, force_error_ratio=remaining_error(f.force_N, c.force_N, shrink))
        out.append(case)
    return out


def scaled(unit: Case, depth_m):
    ratio = depth_m / unit.depth_m
    return replace(unit, depth_m=depth_m, force_N=unit.force_N * ratio, profile_m=[u * ratio for u in unit.profile_m])


def cases_of_site(plan, vertex, solved):
    """Linear press and pull, then large; `solved` has a Case, or None, for each of cases_of."""
    series = {}
    for what, case in zip(cases_of(plan), solved):
        if what.vertex == vertex and case:
            fine = what.level == (COARSEST if what.large_strain else plan.level)
            series.setdefault((what.large_strain, what.depth_m < 0.0), {True: [], False: []})[fine].append(case)
    found = {key: with_errors(levels[True], levels[False]) for key, levels in series.items()}
    pulls = [scaled(found[False, True][0], -d) for d in plan.depths_m]
    return [*found[False, False], *pulls, *found.get((True, False), []), *found.get((True, True), [])]


def sideways_cases(plan):
    """All of one level, then of the next coarser one."""
    return [Indentation(vertex, plan.tool_radius_m, DRAGGED_M, level=level, contact_radius_m=ratio * plan.tool_radius_m,
                        along=tuple(along), held=held)
            for level in (plan.level, plan.level - 1) for vertex in plan.sites for ratio, held in PATCHES
            for along in surface.across(plan.organ.vertex_normal[vertex])]


def sideways_rows(plan, solved):
    """(case, stiffness N/m, error ratio) of each case of the finer level."""
    asked, n = sideways_cases(plan), len(solved) // 2
    return [(what, fine.force_N / DRAGGED_M, remaining_error(fine.force_N, coarse.force_N))
            for what, fine, coarse in zip(asked, solved[:n], solved[n:])]
