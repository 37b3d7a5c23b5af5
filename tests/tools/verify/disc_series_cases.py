#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The cases of tests/data/vectors/001_disc_series.json, by 60-digit decimals and bisection; shares nothing with the C++.

    python3 tests/tools/verify/disc_series_cases.py            # compares with the file
    python3 tests/tools/verify/disc_series_cases.py --write    # writes it

The force at a depth is the one at which the discs' own shortenings min(F, P_i) / k_i add up to it. Exit status 0 or 1.
"""
import decimal
import json
import pathlib
import random
import sys

D = decimal.Decimal
FILE = pathlib.Path(__file__).resolve().parents[2] / "data/vectors/001_disc_series.json"
HEAD = {
    "schema": "haptic-law-vectors/1", "set": "public", "law": "disc_series", "source_document": "none: own reference",
    "equations": "DS-14..DS-17",
    "units": {"force": "N", "depth": "m", "first_depth": "m", "exponent": "1", "exponent_slope": "1", "F": "N", "K": "N/m",
              "U": "J"},
    "conventions": "depth in, F, K and U out; beyond the last flat disc F stays, K is 0",
    "comparison": "|got - want| <= max(abs, rel * |want|)", "tolerance": {"rel": 1e-9, "abs": {}},
    "field_kinds": {"F": "force", "K": "stiffness", "U": "energy"}}


def discs_of(p):
    """(k_i, P_i) of each disc, from the points where discs go flat."""
    last, points = p["discs"] - 1, [(D(0), D(0))]
    for i in range(p["discs"]):
        x = (D(p["first_depth"]) / D(p["depth"])) ** (D(last - i) / D(last))
        points.append((D(p["depth"]) * x, D(p["force"]) * x ** (D(p["exponent"]) + D(p["exponent_slope"]) / 2 * x.ln())))
    softness = [(d1 - d0) / (f1 - f0) for (d0, f0), (d1, f1) in zip(points, points[1:])] + [D(0)]
    return [(1 / (own - rest), flat) for own, rest, (_, flat) in zip(softness, softness[1:], points[1:])]


def answer(p, depth):
    discs, low, high = discs_of(p), D(0), D(p["force"])
    for _ in range(190):
        middle = (low + high) / 2
        low, high = (middle, high) if sum(min(middle, flat) / k for k, flat in discs) < depth else (low, middle)
    energy = sum(min(low, flat) ** 2 / (2 * k) for k, flat in discs)
    soft = sum(1 / k for k, flat in discs if flat > low)
    beyond = depth - D(p["depth"])
    if beyond > 0:
        return {"F": float(p["force"]), "K": 0.0, "U": float(energy + D(p["force"]) * beyond), "status": "SATURATED"}
    return {"F": float(low), "K": float(1 / soft), "U": float(energy), "status": "OK"}


def cases():
    rng = random.Random(36)
    for n in range(200):
        p = {"force": round(rng.uniform(0.01, 5.0), 6), "depth": round(rng.uniform(0.004, 0.03), 6),
             "exponent": round(rng.uniform(1.2, 3.0), 4), "exponent_slope": round(rng.uniform(-0.02, 0.02), 5),
             "first_depth": round(rng.uniform(1e-4, 1e-3), 7), "discs": rng.randint(2, 31)}
        if n == 0:  # the liver's
            p = {"force": 0.5028, "depth": 0.012, "exponent": 1.286, "exponent_slope": -0.0735, "first_depth": 0.0002, "discs": 9}
        depth = round(p["depth"] * rng.uniform(0.01, 1.1), 9)
        yield {"id": f"series-{n:03}", "class": "nominal", "params": p, "inputs": {"depth": depth}, "expect": answer(p, D(depth))}


def main():
    decimal.getcontext().prec = 60
    text = json.dumps(HEAD | {"cases": list(cases())}, indent=1) + "\n"
    if "--write" in sys.argv[1:]:
        FILE.write_text(text)
    elif FILE.read_text() != text:
        sys.exit(f"{FILE}: another reference than this script computes; run it with --write")
    print(f"{FILE.name}: 200 cases")


if __name__ == "__main__":
    main()
