# SPDX-License-Identifier: Apache-2.0
"""The contact radius of a rigid sphere, and its force.

On a half-space, exactly, E* = E / (1 - nu^2) [I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47, cases 6.1 and 6.5]:

    flat punch of radius a      F = 2 E* a d
    sphere of radius R          d = (a / 2) ln((R + a) / (R - a)),   F = E* ((R^2 + a^2) / 2 ln((R + a) / (R - a)) - a R)

On an organ (TipContact) the surface near the tip falls away by s(rho), the mean around the site, so that the gap before
contact is g(rho) = R - sqrt(R^2 - rho^2) + s(rho), and the organ as a whole gives way by c F on top; c comes from one coarse
solve [Sneddon 1965, eqs. 4.6, 4.7]:

    d0(a) = a int_0^(pi/2) g'(a sin t) dt,   F(a) = 2 E* a^2 int_0^(pi/2) g'(a sin t) sin(t)^2 dt,   d = d0(a) + c F(a)
"""
import numpy as np
from scipy.optimize import brentq

import surface

WIDEST = 0.999  # of R: at R itself the slope of the gap is infinite
ANGLES = (np.arange(200) + 0.5) * np.pi / 400.0  # midpoint rule
STEP = np.pi / 400.0


def flat_punch_force_N(organ, radius_m, depth_m):
    return 2.0 * organ.contact_modulus_Pa * radius_m * depth_m


def sphere_contact_radius_m(radius_m, depth_m):
    """a of a sphere at a depth above 0, and at most 15 radii."""
    # t = a / R: d / R = t artanh(t)
    return radius_m * brentq(lambda t: t * np.arctanh(t) - depth_m / radius_m, 0.0, 1.0 - 1e-15, xtol=1e-16)


def sphere_force_N(organ, radius_m, depth_m):
    a = sphere_contact_radius_m(radius_m, depth_m)
    return organ.contact_modulus_Pa * ((radius_m**2 + a**2) / 2.0 * np.log((radius_m + a) / (radius_m - a)) - a * radius_m)


class TipContact:
    def __init__(self, modulus_Pa, radius_m, fall_m=(), pitch_m=1.0):
        """fall_m: s at 0, pitch, 2 pitch, ..., straight between them; empty for a flat surface."""
        self.modulus_Pa, self.radius_m, self.pitch_m = modulus_Pa, radius_m, pitch_m
        self.fall_slope = np.diff(fall_m) / pitch_m if len(fall_m) > 1 else np.zeros(1)

    def gap_slope(self, rho_m):
        ring = np.minimum((rho_m / self.pitch_m).astype(int), len(self.fall_slope) - 1)  # beyond the last its slope goes on
        return rho_m / np.sqrt(self.radius_m**2 - rho_m**2) + self.fall_slope[ring]

    def depth_m(self, a):
        return a * self.gap_slope(a * np.sin(ANGLES)).sum() * STEP

    def force_N(self, a):
        return 2.0 * self.modulus_Pa * a**2 * (self.gap_slope(a * np.sin(ANGLES)) * np.sin(ANGLES)**2).sum() * STEP

    def root(self, rising):
        """The contact radius where a rising function of it is zero."""
        high_m = WIDEST * self.radius_m
        return high_m if rising(high_m) < 0.0 else brentq(rising, 0.0, high_m, xtol=1e-15)

    def compliance_m_per_N(self, solved_depth_m, solved_force_N):
        """c, of a solve that found this force at this depth."""
        a = self.root(lambda at: self.force_N(at) - solved_force_N)
        return (solved_depth_m - self.depth_m(a)) / solved_force_N

    def contact_radius_m(self, depth_m, compliance_m_per_N):
        return self.root(lambda a: self.depth_m(a) + compliance_m_per_N * self.force_N(a) - depth_m)


def surface_fall_m(organ, vertex, rings, pitch_m):
    """s (rings,) around a vertex, at distances k pitch from its normal."""
    at_m, reach_m = organ.vertex_m[vertex], rings * pitch_m
    axis = surface.Circle(at_m, -organ.vertex_normal[vertex], 0.0)
    lengths = surface.EdgeLengths(at_m[None], reach_m, pitch_m, 1.0)
    vertex_m, triangle = surface.refine(organ.vertex_m, organ.triangle, lengths)
    p = vertex_m[triangle]
    normal = surface.unit(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]))
    # Another lobe of the organ may face the same way.
    p = p[(np.linalg.norm(p[:, 0] - at_m, axis=1) < 2.0 * reach_m) & (normal @ axis.axis < -surface.FACING)]
    return surface.ring_means(p, axis.away_m(p), (p - at_m) @ axis.axis, rings, pitch_m, 0.0)
