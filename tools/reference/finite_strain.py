# SPDX-License-Identifier: Apache-2.0
"""All spheres of a tool pressed into an organ together at finite strain: neo-Hookean body, contact found, no friction.

Two programs solve the same press, CalculiX (calculix.py) and FEniCSx (fenicsx.py); what they share is the mesh. Far from the
tool the organ's surface has fewer triangles than the organ (coarsen.py), as a body is solved a hundred times.
"""
from dataclasses import dataclass, replace

import numpy as np

import calculix
import coarsen
import fenicsx
import surface
from body import gmsh_version, make_body
from run import Failure
from tool_press import Press, ToolCase

# A level: edge of an element under the tool, of the radius; growth with distance; how far the far surface may be off, m.
LEVELS = [(0.6, 0.72, 3e-3), (0.42, 0.6, 1.5e-3), (0.3, 0.4, 0.8e-3), (0.21, 0.33, 0.4e-3), (0.15, 0.28, 0.2e-3)]
LARGEST_M, COARSENED_FROM, COARSE_GROWTH = 14e-3, 3.0, 0.5  # of the radius
CONTACT_REACH = 2.0  # of R around each sphere's axis: faces that CalculiX lets it press


@dataclass(frozen=True)
class FinitePress(Press):
    solver: str  # FEniCSx or CalculiX
    level: int = 1


def version(solver):
    """ "CalculiX 2.20, gmsh 4.8.4" """
    return f"{solver} {(calculix if solver == 'CalculiX' else fenicsx).version()}, gmsh {gmsh_version()}"


def edge_lengths(organ, what):
    fine, growth, _ = LEVELS[what.level]
    radius_m = min(what.radius_m)
    tips_m = np.array(what.centre_m) + np.array(what.radius_m)[:, None] * np.array(what.direction)
    return surface.EdgeLengths(tips_m, radius_m, fine * radius_m, growth, LARGEST_M * organ.size_ratio)


def body_of(organ, what):
    lengths = edge_lengths(organ, what)
    far = replace(lengths, radius_m=COARSENED_FROM * lengths.radius_m, fine_m=0.0, growth=COARSE_GROWTH)
    vertex_m, triangle = coarsen.coarsened(organ, far, LEVELS[what.level][2])
    return make_body(replace(organ, vertex_m=vertex_m, triangle=triangle), lengths)


def contact_faces(body, what):
    """Faces (f, 6) around the spheres that look against their way."""
    near = np.zeros(len(body.face), dtype=bool)
    for centre_m, radius_m in zip(what.centre_m, what.radius_m):
        tip_m = np.array(centre_m) + radius_m * np.array(what.direction)
        near |= body.within(surface.Circle(tip_m, np.array(what.direction), CONTACT_REACH * radius_m))
    return body.face[near]


def by_calculix(organ, body, what):
    way = np.array(what.direction)
    tool = calculix.Tool(np.array(what.radius_m), np.array(what.centre_m), list(what.depths_m), contact_faces(body, what))
    load = calculix.Load(way, large_strain=True, tool=tool)
    return calculix.solve(organ, body, load, np.unique(body.face)).tool_N @ way


def solve(organ, what):
    """A ToolCase for each depth."""
    if organ.lumps:
        raise Failure("finite strain knows no other modulus inside; leave it out")
    body = body_of(organ, what)
    solved_N = (fenicsx.solve if what.solver == "FEniCSx" else by_calculix)(organ, body, what)
    return [ToolCase(depth_m, float(sum(each_N)), [float(force_N) for force_N in each_N])
            for depth_m, each_N in zip(what.depths_m, solved_N)]
