# SPDX-License-Identifier: Apache-2.0
"""Where the whole tool is pressed, and how the solves become one file.

The hand's own site comes first, as its stroke presses it, then the middle and the end of each of its slides in contact. Then
places that no fit has used, chosen by a fixed rule: of all vertices where

    the surface looks towards the hand   outward normal within 60 degrees of the hand's way out
    the whole tool finds tissue          along the tool's way each sphere's axis meets it within half a radius of the same height
    the tissue is deep enough            twice the deepest press along every axis
    nothing is held nearby               no held triangle's corner within three radii and the deepest press
    no edge is near, where asked         every face within three radii looks within 30 degrees the vertex's way

each time the one farthest from the hand's site, from the places chosen before and from the [[reference_site]]s that a law is
fitted on; of equal ones the least number. The tool comes along the inward normal and is in first contact at depth 0.
"""
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.spatial

import surface
from finite_strain import FinitePress
from indentation import ROUGH
from plan import remaining_error
from tool_press import ToolCase, ToolPress

DEPTHS_M = [1e-3, 2e-3, 5e-3, 10e-3]
UNSEEN_PLACES = 6
TOWARDS_HAND = 0.5  # cosine
EDGE, FROM_EDGE = 0.866, 3.0  # cosine; of the radius
SAME_HEIGHT, FROM_HELD, FROM_ABOVE = 0.5, 3.0, 5.0  # of the radius; the last: in which a first touch is looked for
THICKNESS = 2.0  # of the deepest press
SAMPLES = 10  # of a sphere's radius, to find its first contact
SURFACE_M = 0.03  # from the point, whose way is kept
MIN_SLIDE_M = 1e-3


@dataclass
class PressPlace:
    vertex: int | None  # of the organ's mesh; None: the hand's own site, slid
    slid_m: np.ndarray  # (3,), from the hand's own site by a stroke
    point_m: np.ndarray  # (3,), of the tool's lowest point at depth 0, mesh's own frame
    direction: np.ndarray  # (3,), into the tissue, unit
    orientation: np.ndarray = field(default_factory=lambda: np.array([1.0, 0, 0, 0]))  # (4,), w x y z, from how the tool rests
    skin: tuple[int, ...] = ()
    cases: list[ToolCase] = field(default_factory=list)
    tilt_deg: float = 0.0  # at the hand's own site: how far the tool is turned there

    @property
    def name(self):
        if self.tilt_deg:
            return f"tilted {self.tilt_deg:g}"
        if self.vertex is not None:
            return str(self.vertex)
        slid_m = np.linalg.norm(self.slid_m)
        return f"slid {slid_m * 1e3:.3g} mm" if slid_m > 0.0 else "hand's"


def turn_between(start, end):
    """The smallest turn (4,), w x y z, from a unit vector to another."""
    if start @ end < -1.0 + 1e-12:
        return np.array([0.0, *surface.across(start)[0]])
    return surface.unit(np.array([1.0 + start @ end, *np.cross(start, end)]))


def rotate(turn, v):
    """v (..., 3) turned."""
    twice = 2.0 * np.cross(turn[1:], v)
    return v + turn[0] * twice + np.cross(turn[1:], twice)


class Places:
    """Where a tool of spheres, offset_m (s, 3) and radius_m (s,), can be pressed into an organ; inward is the hand's way in."""

    def __init__(self, organ, offset_m, radius_m, inward, deepest_m, away_from_edges=False):
        self.organ, self.offset_m, self.radius_m, self.inward, self.deepest_m = organ, offset_m, radius_m, inward, deepest_m
        self.away_from_edges = away_from_edges
        self.corner_m = organ.vertex_m[organ.triangle]
        a, b, c = self.corner_m.transpose(1, 0, 2)
        self.face_normal = surface.unit(np.cross(b - a, c - a))
        self.longest_m = np.linalg.norm(self.corner_m - self.corner_m[:, surface.NEXT], axis=2).max()

    def centres_m(self, place):
        """The spheres' (s, 3) at depth 0."""
        # p(0) = point - direction reach, as a press stroke has it
        reach_m = (self.offset_m @ self.inward + self.radius_m).max()
        return place.point_m - reach_m * place.direction + rotate(place.orientation, self.offset_m)

    def at(self, vertex):
        """The tool at a vertex, its tip on it."""
        direction = -self.organ.vertex_normal[vertex]
        return PressPlace(vertex, np.zeros(3), self.organ.vertex_m[vertex], direction, turn_between(self.inward, direction))

    def thickness(self, from_m, direction, reach_m):
        """surface.thickness of parallel ways at most reach_m from the first."""
        away_m = surface.Circle(from_m[0], direction, 0.0).away_m(self.corner_m.mean(axis=1))
        near = away_m <= reach_m + self.longest_m
        return surface.thickness(self.corner_m[near], self.face_normal[near], from_m, direction)

    def reachable(self):
        """Vertices, ascending."""
        organ = self.organ
        held = np.unique(organ.triangle[organ.held(self.corner_m).all(axis=1)])
        far_m = FROM_HELD * self.radius_m.max() + self.deepest_m
        good = -organ.vertex_normal @ self.inward >= TOWARDS_HAND
        if len(held):
            good &= scipy.spatial.cKDTree(organ.vertex_m[held]).query(organ.vertex_m)[0] >= far_m
        return [v for v in np.flatnonzero(good).tolist() if self.is_level(self.at(v)) and not self.has_edge(v)]

    def has_edge(self, vertex):
        """Is an edge near, where places away from edges are asked for?"""
        if not self.away_from_edges:
            return False
        off_m = self.corner_m - self.organ.vertex_m[vertex]
        near = (np.linalg.norm(off_m, axis=2) <= FROM_EDGE * self.radius_m.max()).any(axis=1)
        return (self.face_normal[near] @ self.organ.vertex_normal[vertex] < EDGE).any()

    def is_level(self, place):
        """Does every sphere meet thick tissue at nearly the same height?"""
        centres_m = self.centres_m(place)
        reach_m = np.linalg.norm(centres_m - centres_m[0], axis=1).max()
        away_m, thick_m = self.thickness(centres_m, place.direction, reach_m)
        height_m = away_m - self.radius_m
        return (thick_m >= THICKNESS * self.deepest_m).all() and np.ptp(height_m) <= SAME_HEIGHT * self.radius_m.min()

    def touching(self, place):
        """Moved along its way until first contact."""
        x, y = np.meshgrid(*[np.arange(-SAMPLES, SAMPLES + 1) / SAMPLES] * 2)
        x, y = x[x**2 + y**2 <= 1.0], y[x**2 + y**2 <= 1.0]
        rise = np.sqrt(np.maximum(0.0, 1.0 - x**2 - y**2))
        u, v = surface.across(place.direction)
        way_m = np.inf
        for centre_m, radius_m in zip(self.centres_m(place), self.radius_m):
            off_m = radius_m * (np.outer(x, u) + np.outer(y, v))
            above_m = FROM_ABOVE * radius_m
            met_m = self.thickness(centre_m + off_m - above_m * place.direction, place.direction, 2.0 * radius_m)[0]
            way_m = np.fmin(way_m, np.nanmin(met_m - above_m - radius_m * rise, initial=np.inf))
        return replace(place, point_m=place.point_m + way_m * place.direction) if np.isfinite(way_m) else place

    def unseen(self, taken_m):
        """Each time the candidate that is farthest from all points taken, the least number of equal ones."""
        candidates, out = np.array(self.reachable(), dtype=int), []
        candidate_m, taken_m = self.organ.vertex_m[candidates], list(taken_m)
        while len(out) < min(UNSEEN_PLACES, len(candidates)):
            away_m = np.min([np.linalg.norm(candidate_m - t, axis=1) for t in taken_m], axis=0)
            best = away_m.argmax()
            if away_m[best] <= 0.0:  # only places that are taken already are left
                break
            out.append(int(candidates[best]))
            taken_m.append(candidate_m[best])
        return out


def slides_of(hand, places):
    """How far the hand's strokes slide the open tool along the tissue from its site: (3,) each, middle and end, each once."""
    site_m, inward = np.array(hand["site_m"]), places.inward
    reach_m = (places.offset_m @ inward + places.radius_m).max()
    off_m = np.array([point["position_m"] for point in hand["path"]]).reshape(-1, 3) - site_m
    along_m = off_m - np.outer(off_m @ inward, inward)
    presses = (off_m @ inward + reach_m > 0.0) & (np.array([point["grip_ratio"] for point in hand["path"]]) == 0.0)
    out = []
    for i in range(1, len(off_m)):
        start_m, end_m = along_m[i - 1], along_m[i]
        if presses[i - 1] and presses[i] and np.linalg.norm(end_m - start_m) >= MIN_SLIDE_M:
            for slid_m in (0.5 * (start_m + end_m), end_m):
                if all(np.linalg.norm(slid_m - other_m) >= MIN_SLIDE_M for other_m in out):
                    out.append(slid_m)
    return out


def tilted(places, own, tilt_deg):
    """At the same site, turned about the axis across its way and the line of its spheres: one of them comes first."""
    off_m = places.offset_m[-1] - places.offset_m[0]
    axis = np.cross(own.direction, off_m)
    half_rad = np.radians(0.5 * tilt_deg)
    turn = np.array([np.cos(half_rad), *(np.sin(half_rad) * surface.unit(axis))])
    return places.touching(replace(own, orientation=turn, tilt_deg=tilt_deg))


def places_of(places, hand, fitted, vertices, tilts_deg=()):
    """Every Place of the tool; `vertices`: instead of the slides and of those that the rule chooses.

    With tilts and no vertices only the hand's site.
    """
    site_m, organ = np.array(hand["site_m"]), places.organ
    own = PressPlace(None, np.zeros(3), site_m, places.inward)
    turned = [own, *(tilted(places, own, tilt_deg) for tilt_deg in tilts_deg if tilt_deg)]
    if len(tilts_deg) and not vertices:
        return turned
    slides = [] if vertices else slides_of(hand, places)
    taken_m = [site_m, *(organ.vertex_m[v] for v in fitted if v < len(organ.vertex_m))]
    chosen = vertices or places.unseen(taken_m)
    return [*turned, *(places.touching(replace(own, slid_m=slid_m, point_m=site_m + slid_m)) for slid_m in slides),
            *(places.touching(places.at(v)) for v in chosen)]


def surface_around(organ, place):
    """The vertices that the picture shows pressed: within SURFACE_M, facing the tool."""
    near = np.linalg.norm(organ.vertex_m - place.point_m, axis=1) < SURFACE_M
    return tuple(np.flatnonzero(near & (organ.vertex_normal @ place.direction < -surface.FACING)).tolist())


def tool_at(places, place, depths_m):
    """The fields of a Press there."""
    return (tuple(place.direction.tolist()), tuple(map(tuple, places.centres_m(place).tolist())), tuple(places.radius_m.tolist()),
            tuple(depths_m))


def presses_of(places, tool_places, depths_m, level):
    """Every solve, each once: all places at the level, then one level coarser."""
    return [ToolPress(*tool_at(places, place, depths_m), place.skin if finer else (), level - (not finer))
            for finer in (True, False) if level - (not finer) >= ROUGH for place in tool_places]


def finite_presses_of(places, tool_places, depths_m, level, solver):
    """Every solve at finite strain, at one level: minutes each."""
    return [FinitePress(*tool_at(places, place, depths_m), solver, level) for place in tool_places]


def assemble(tool_places, solved):
    """Each place with its cases and their errors; `solved` in the order of presses_of."""
    def with_errors(fine, coarse):
        return [replace(f, force_error_ratio=remaining_error(f.force_N, c.force_N)) for f, c in zip(fine, coarse)]

    return [replace(place, cases=with_errors(fine, coarse))
            for place, fine, coarse in zip(tool_places, solved, solved[len(tool_places):])]
