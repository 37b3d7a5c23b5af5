# SPDX-License-Identifier: Apache-2.0
"""Joint angles and rates from the position of a handle, in closed form, from drawings of the simulated delta and of the Falcon:
in the plane of an arm a circle about the shoulder meets one about the end of the rod; tan(theta / 2) solves a quadratic. Rates
are derivatives along the velocity, by a complex step: exact to the last digits."""
import numpy as np

STEP = 1e-30


def arm_rad(x, z, upper_m, reach_m2):
    """Shoulder at the origin; of two elbows the one that is farther out, along x."""
    e, f, c = 2 * upper_m * x, 2 * upper_m * z, x * x + z * z + upper_m * upper_m - reach_m2
    root = np.sqrt(e * e + f * f - c * c)
    both = np.array([2 * np.arctan((f + sign * root) / (c + e)) for sign in (1, -1)])
    return np.where(np.cos(both[0]).real > np.cos(both[1]).real, both[0], both[1])


def leg(point_D, azimuth_rad):
    """Along the leg, across it, and up, (3, n)."""
    x, y, z = point_D
    return (x * np.cos(azimuth_rad) + y * np.sin(azimuth_rad), y * np.cos(azimuth_rad) - x * np.sin(azimuth_rad), z)


def delta_rad(point_W):
    """The simulated one: 180 and 50 mm, arms 260 mm, rods 400 mm; it lies on its side, its plane 345 mm behind the origin."""
    angles = []
    for azimuth_deg in (0, 120, 240):
        x, y, z = leg((point_W[2], -point_W[1], point_W[0] + 0.345), np.deg2rad(azimuth_deg))
        angles.append(arm_rad(x - (0.180 - 0.050), z, 0.260, 0.400**2 - y * y))
    return np.array(angles)


def falcon_rad(point_W):
    """As sold: thigh 60 mm, shin 102.5 mm, two links of 11.25 mm; its plane is 120 mm behind the origin."""
    angles = []
    for azimuth_deg in (105, -15, -135):
        x, y, z = leg((point_W[1], point_W[2], point_W[0] + 0.120), np.deg2rad(azimuth_deg))
        side = y + 0.02309 - 0.025
        angles.append(arm_rad(x - 0.0400 + 0.01443, z, 0.060, (2 * 0.01125 + np.sqrt(0.1025**2 - side * side))**2))
    return np.array(angles)


def turn(rotation_deg):
    """The matrix of axis times angle."""
    angle_rad = np.deg2rad(np.linalg.norm(rotation_deg))
    x, y, z = np.deg2rad(rotation_deg) / (angle_rad or 1.0)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * cross @ cross


def joint_states(ticks, inverse, rotation_deg=(0, 0, 0), position_m=(0, 0, 0), scale=1.0):
    """(n, 6): angles and rates of each tick, of a device that is mounted so; NaN beyond its reach."""
    to_base = turn(rotation_deg).T / scale
    point = to_base @ (ticks["tool_position_m"] - ticks["clutch_shift_m"] - position_m).T
    velocity = to_base @ ticks["tool_velocity_mps"].T
    with np.errstate(invalid="ignore"):
        angles = inverse(point)
        rates = inverse(point + 1j * STEP * velocity).imag / STEP
    return np.vstack([angles, np.where(np.isnan(angles), np.nan, rates)]).T
