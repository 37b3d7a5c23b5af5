# SPDX-License-Identifier: Apache-2.0
"""A tool on one site of an organ: what is moved, what force that takes, what shape results.

press: a rigid frictionless sphere of radius R goes in by d along the inward vertex normal. Nodes of the faces whose centre is
within the contact radius a of the axis follow it,

    u_n = d - (R - sqrt(R^2 - rho^2)) - s

rho distance from the axis, s how far the resting surface lies below the site's tangent plane (an organ is not flat). They slide
freely sideways. The force is largest for the true a (J. R. Barber, J. Elast. 4 (1974) 31), so a small error in a is a much
smaller one in F. contact.py finds a. At large strain the surface slides along the sphere and no radius separates the nodes in
contact: the sphere comes as a rigid body and the contact is found while it goes in. pull: the faces within R of the axis move
outward as one piece, bonded. A patch dragged along the surface moves as one piece, too.
"""
from dataclasses import dataclass

import numpy as np

import calculix
import contact
import surface
from body import make_body

ROUGH, COARSEST, FINEST = 0, 1, 4  # levels of the mesh; ROUGH is for the error of the coarsest only
RING_PITCH_M, RINGS = 1e-3, 31  # 0 .. 30 mm
FINE_RADIUS = 1.1  # of the contact radius: up to here the mesh is finest
SPHERE_SHARE = 0.99  # of R: beyond, a sphere's side is too steep to touch
BALL_REACH, BALL_TOUCH = 2.0, 3e-3  # of R: faces that the ball may touch; nearer than this is a touch
# A pull of more of their edges than this draws the elements at a bond's rim out so far that CalculiX stalls.
MAX_DRAWN_OUT = 8.0
# A level: edge under the tool, of the contact radius; edge at the rim of a bonded disc, of its radius; growth of the edge with
# distance; edge inside the body, m. Edges shrink by about 0.7 from level to level.
LEVELS = [(0.5, 0.17, 0.72, 16e-3), (0.35, 0.12, 0.6, 14e-3), (0.25, 0.08, 0.5, 12e-3), (0.175, 0.05, 0.42, 10e-3),
          (0.125, 0.032, 0.35, 8e-3)]


@dataclass(frozen=True)
class Indentation:
    vertex: int
    tool_radius_m: float
    depth_m: float  # > 0 press, < 0 pull
    large_strain: bool = False
    level: int = 2
    contact_radius_m: float = 0.0  # of a press; 0: that of the half-space at this depth
    # A round patch dragged depth_m along the surface as one piece; it needs a contact radius.
    along: tuple[float, ...] = ()  # (3,), unit, tangential; empty: the tool moves along the normal
    held: bool = False  # it cannot rise or sink

    @property
    def is_bonded(self):
        return self.depth_m < 0.0 or bool(self.along)

    @property
    def radius_m(self):
        """Of the contact."""
        if self.depth_m < 0.0:
            return self.tool_radius_m
        return self.contact_radius_m or contact.sphere_contact_radius_m(self.tool_radius_m, self.depth_m)


@dataclass
class Case:
    """What one case found; force_error_ratio takes two levels and stays None."""
    depth_m: float
    large_strain: bool
    force_N: float
    contact_radius_m: float
    profile_m: list[float]  # ring k at k RING_PITCH_M
    force_error_ratio: float | None = None


def edge_lengths(organ, what):
    fine, bond, growth, largest_m = LEVELS[what.level]
    fine_m = (bond if what.is_bonded else fine) * what.radius_m  # stress is singular at the rim of a bond
    if what.is_bonded and what.large_strain:  # the ratio between levels stays
        fine_m = max(fine_m, -what.depth_m / MAX_DRAWN_OUT * bond / LEVELS[COARSEST][1])
    return surface.EdgeLengths(organ.vertex_m[[what.vertex]], (1.0 if what.is_bonded else FINE_RADIUS) * what.radius_m, fine_m,
                               growth, largest_m * organ.size_ratio,
                               -organ.vertex_normal[what.vertex] if what.is_bonded else None)


def press_load(body, rim, what):
    nodes = np.unique(body.face[body.within(rim)])
    p, radius_m = body.node_m[nodes], what.tool_radius_m
    rho_m = rim.away_m(p)
    reached = rho_m <= SPHERE_SHARE * radius_m
    nodes, p, rho_m = nodes[reached], p[reached], rho_m[reached]
    along_m = what.depth_m - (radius_m - np.sqrt(radius_m**2 - rho_m**2)) - (p - rim.at_m) @ rim.axis
    pushed = along_m > 0.0  # a node that the sphere does not reach is free
    return calculix.Load(rim.axis, nodes[pushed], along_m[pushed])


def load_of(body, rim, what):
    nodes = np.unique(body.face[body.within(rim)])
    along_m = np.full(len(nodes), what.depth_m)
    if what.along:
        return calculix.Load(np.array(what.along), nodes, along_m, is_bonded=what.held)
    if what.depth_m < 0.0:
        return calculix.Load(rim.axis, nodes, along_m, is_bonded=True, large_strain=what.large_strain)
    if what.large_strain:
        return calculix.Load(rim.axis, large_strain=True, tool=ball_on(body, rim, what.tool_radius_m, what.depth_m))
    return press_load(body, rim, what)


def ball_on(body, rim, radius_m, depth_m):
    """The ball rests on the site and goes along the axis."""
    reach = surface.Circle(rim.at_m, rim.axis, BALL_REACH * radius_m)
    return calculix.Tool(np.array([radius_m]), (rim.at_m - radius_m * rim.axis)[None], [depth_m], body.face[body.within(reach)])


def touched_radius_m(body, ball, axis, displacement_m):
    """Of a circle as large as the contact area of the ball, seen along its way."""
    corners = ball.face[:, :3]
    p = body.node_m[corners] + displacement_m[corners]
    touching = np.linalg.norm(p - ball.centre_m - ball.along_m[-1] * axis, axis=2) < (1.0 + BALL_TOUCH) * ball.radius_m
    # Tissue that folds in over the ball's widest circle is not seen along the way.
    seen_m2 = np.maximum(0.0, -0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) @ axis)
    return float(np.sqrt(touching.mean(axis=1) @ seen_m2 / np.pi))


def profile_of(body, at_m, outward, inward_m, middle_m):
    """Mean way in (RINGS,) along rings at k RING_PITCH_M from the site, straight distance, on the faces that look outward."""
    parts = body.face[body.normal @ outward >= surface.FACING][:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    p = body.node_m[parts]  # a six-node face as four flat ones
    return surface.ring_means(p, np.linalg.norm(p - at_m, axis=2), inward_m[parts], RINGS, RING_PITCH_M, middle_m)


def solve(organ, what):
    """The Case, alone in a list: as that of tool_press.py."""
    # The mesh follows the rim of the contact: there the stress ends, or is singular.
    rim = surface.Circle(organ.vertex_m[what.vertex], -organ.vertex_normal[what.vertex], what.radius_m)
    body = make_body(organ, edge_lengths(organ, what), rim)
    load = load_of(body, rim, what)
    answer = calculix.solve(organ, body, load, np.unique(body.face))
    inward_m = answer.displacement_m @ rim.axis
    radius_m = touched_radius_m(body, load.tool, rim.axis, answer.displacement_m) if load.tool else rim.radius_m
    profile_m = profile_of(body, rim.at_m, -rim.axis, inward_m, inward_m[what.vertex])
    return [Case(what.depth_m, what.large_strain, float(answer.force_N @ load.direction), float(radius_m), profile_m.tolist())]
