#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The cases of tests/data/vectors/002_membrane.json: the membrane's energy at its least, over finite volumes.

    /usr/bin/python3 tests/tools/verify/membrane_cases.py            # compares with the file
    /usr/bin/python3 tests/tools/verify/membrane_cases.py --write    # writes it

Rings of one width, w_i >= d - r_i^2 / (2 R) by an active set, Newton's method. The force is what all of the foundation
carries. No shooting, no contact radius, no code of tact. Two grids, extrapolated. Needs python3-scipy. Exit status 0 or 1.
"""
import json
import pathlib
import random
import sys

import numpy as np
from scipy.linalg import solve_banded

FILE = pathlib.Path(__file__).resolve().parents[2] / "data/vectors/002_membrane.json"
HEAD = {
    "schema": "haptic-law-vectors/1", "set": "public", "law": "membrane", "source_document": "none: own reference",
    "equations": "HX-30..HX-33",
    "units": {"tension": "N/m", "foundation": "Pa/m", "softening_depth": "m", "softening_exponent": "1", "working_depth": "m",
              "tip_radius": "m", "depth": "m", "F": "N"},
    "conventions": "depth in, F out", "comparison": "|got - want| <= max(abs, rel * |want|)",
    "tolerance": {"rel": 5e-4, "abs": {}}, "field_kinds": {"F": "force"}}


def pressure(p, w):
    u = 1.0 + np.maximum(w, 0.0) / p["softening_depth"]
    k, g = p["foundation"], p["softening_exponent"]
    return k * w / u**g, k / u**g - k * g * w / p["softening_depth"] / u**(g + 1.0)


def force(p, depth, rings):
    length = np.sqrt(p["tension"] / p["foundation"])
    far = np.sqrt(2.0 * p["tip_radius"] * depth) + 25.0 * length
    h = far / rings
    r = (np.arange(rings) + 0.5) * h
    area, flow = r * h, p["tension"] * np.arange(1, rings + 1) * h / h  # per radian: T r / h between rings
    flow_in = np.concatenate([[0.0], flow[:-1]])
    tip = depth - r**2 / (2.0 * p["tip_radius"])
    w, held = np.maximum(tip, 0.0), tip > 0.0

    def holding(w):
        """What holds each ring down, over its width, and the foundation's slope."""
        q, slope = pressure(p, w)
        left, right = np.concatenate([[0.0], w[:-1]]), np.concatenate([w[1:], [0.0]])
        return flow_in * (w - left) + flow * (w - right) + area * q, slope

    for _ in range(1000):
        rest, slope = holding(w)
        bands = np.zeros((3, rings))
        bands[1] = np.where(held, 1.0, flow_in + flow + area * slope)
        bands[0, 1:] = np.where(held[:-1], 0.0, -flow[:-1])
        bands[2, :-1] = np.where(held[1:], 0.0, -flow_in[1:])
        change = solve_banded((1, 1), bands, np.where(held, tip - w, -rest))
        w = w + change
        before, held = held, np.where(held, holding(w)[0] > 0.0, w < tip)
        if np.array_equal(before, held) and np.max(np.abs(change)) < 1e-9 * depth:
            return float(2.0 * np.pi * np.sum(area * pressure(p, w)[0]))
    raise RuntimeError(f"{p}, {depth}: not solved")


def cases():
    rng = random.Random(36)
    for n in range(16):
        p = {"tension": round(rng.uniform(0.2, 10.0), 3), "foundation": round(rng.uniform(2e5, 5e6)),
             "softening_depth": round(rng.uniform(1e-3, 1e-2), 5), "softening_exponent": round(rng.uniform(0.0, 1.3), 3),
             "working_depth": 0.012, "tip_radius": round(rng.uniform(0.002, 0.008), 4)}
        if n == 0:  # the liver's
            p = {"tension": 1.709, "foundation": 899000, "softening_depth": 0.002853, "softening_exponent": 1.169,
                 "working_depth": 0.012, "tip_radius": 0.004}
        depth = round(rng.uniform(0.3e-3, 11.9e-3), 6)
        coarse, fine = force(p, depth, 6000), force(p, depth, 12000)
        yield {"id": f"membrane-{n:03}", "class": "nominal", "params": p, "inputs": {"depth": depth},
               "expect": {"F": float(f"{2.0 * fine - coarse:.6g}"), "status": "OK"}}


def main():
    found = list(cases())
    if "--write" in sys.argv[1:]:
        FILE.write_text(json.dumps(HEAD | {"cases": found}, indent=1) + "\n")
    known = json.loads(FILE.read_text())["cases"]
    off = max(abs(a["expect"]["F"] / b["expect"]["F"] - 1.0) for a, b in zip(known, found, strict=True))
    print(f"{FILE.name}: {len(found)} cases, at most {off:.1e} off")
    return 0 if off < 1e-4 and all(a["inputs"] == b["inputs"] for a, b in zip(known, found)) else 1


if __name__ == "__main__":
    sys.exit(main())
