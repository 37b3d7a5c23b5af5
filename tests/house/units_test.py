#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every number that a header keeps, alone or in a vector, names its unit, as force_N does, or is known to have none; and
a bound is kMax... or kMin..., not kMost..., kLargest..., kLeast... and their like; kLongest... and kFastest... may be; a
ratio is k..._ratio.

Reads the members and constants of the headers, and the bounds of all C++, as text and prints every breach as file:line:
sentence. Exit status 0 or 1.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOPS = ("model", "firmware", "hal", "host", "tools")
NUMBER = r"(?:double|float|(?:\w+::)*(?:Vec[23]|Vector3[df]|Joints))"
MANY = rf"(?:(?:std::array|std::vector|std::span)<(?:const )?(?:{NUMBER}|std::array<{NUMBER}, [^<>]+>)(?:, [^<>]+)?>)"
MEMBER = re.compile(r"\s*(?:(?:inline|static|mutable|constexpr|const) )*"
                    rf"(?:{NUMBER}|{MANY}) ([^()]*?)[;{{]\s*(?://.*)?$")
NAME = re.compile(r"([A-Za-z_]\w*)(?:\[\w+\])?(?:(?: = )?\{[^}]*\}| = [^,]*)?(?:, |$)")
UNIT = re.compile(r"_(?:s|ms|us|m|mm|um|N|Nm|J|W|kg|Hz|rad|deg|radps|mps|mps2|m2|m3|Pa|V|A|C|N2|N2m2|N2s|turns|words|px|ratio"
                  r"|percent|share|\w*_?per_\w+|kgm2|Ns|bps|kB|MB|bytes|ticks|m_N|wxyz)_?$")
# Shares, coordinates of a formula, and what has the unit of something else: the word says so.
PLAIN = {
    "x", "y", "z", "w", "level", "share", "weight", "factor", "fraction", "value", "slope", "integral", "step",
    "exponent_slope", "softening_exponent",
    "low", "high", "alpha", "lambda", "exponent", "growth", "along", "across", "steepness", "faded_from", "cell",
    "peak", "continuous", "continuous_squared", "mean_square", "periods",  # of a force or a torque; of a period
    "least_transmission", "least_rod_sigma", "limit_tan", "critical_zeta", "f0", "m0", "c2", "c3", "u0",
    "normal", "tilt", "tool_orientation",  # a direction; m/m; w, x, y, z
    "axis", "face_normal", "vertex_normal", "held_normal", "unit", "outward", "inward", "hand_inward", "radial",  # directions
    "coordinate", "press_coordinate", "pull_coordinate",  # along a family of curves
    "direction", "product", "preconditioner", "sum",  # of a linear solver, a mean
    "printed", "ours",  # of a quantity whose name says the unit
    "row", "words", "fade", "strain", "cos_azimuth", "sin_azimuth", "sine", "cosine", "tangent", "push",  # push: a direction
    "motion_scale",  # way of the tool for a way of the handle
    "vertex",  # of an OBJ file, in its units
    "n1", "n2", "s1", "s2",  # barycentric and normal parts of a map
    "xx", "xy", "yy",  # of a tensor, which has the unit
    "limit", "largest", "size", "median", "lower_quartile", "upper_quartile", "rel", "tolerance", "exact",
    "scale", "best_scale", "difference", "good_residual", "shape_weight", "sum_of_squares", "middle_value",
    "first_strain", "boundary_slope", "instructions", "kFacing",
    "kGripHeight", "kMaxObjCoordinate", "kStiffestPlace", "kNonRtForceShare", "kRoundingRoom", "kNothing",
}


def members(text):
    """(line, name) of every number that lives longer than a call: members and constants."""
    depth_of_function = None
    depth = 0
    for number, line in enumerate(text.splitlines(), 1):
        found = MEMBER.match(line) if depth_of_function is None else None
        if found:
            yield from ((number, name[1]) for name in NAME.finditer(found[1]))
        opens = line.split("//")[0].count("{") - line.split("//")[0].count("}")
        if depth_of_function is None and opens > 0 and re.search(r"\)[^;=]*\{", line):
            depth_of_function = depth
        depth += opens
        if depth_of_function is not None and depth <= depth_of_function:
            depth_of_function = None


def breaches(path, text):
    for number, name in members(text):
        if not UNIT.search(name) and name.rstrip("_") not in PLAIN:
            yield f"{path}:{number}: {name} names no unit; if it has none, it is a word of PLAIN in {__file__.rsplit('/', 1)[1]}"


RATIO = re.compile(r"\bk[A-Z]\w*Ratio\b")
BOUND = re.compile(r"\bk(?:Most|Largest|Greatest|Biggest|Least|Smallest|Fewest)(?=[A-Z_]|\b)\w*")


def bound_breaches(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        for name in BOUND.findall(line):
            yield f"{path}:{number}: {name}: a bound is kMax... or kMin..."
        for name in RATIO.findall(line):
            yield f"{path}:{number}: {name}: a unit is written in small letters, behind an underscore: k..._ratio"


def blind_rules():
    bad = ("  double force = 0.0;\n", "  double low = 0.0, speed = 0.0;\n", "inline constexpr double kLimit = 3.0;\n",
           "  float mass_;\n", "  Vec3 place;\n", "  model::Vec3 place{}, far_m;\n", "  std::array<double, 3> torque{};\n",
           "  std::vector<Vec3> place_;\n", "  std::span<const double> mass;\n", "  delta::Joints torque{1.0, 2.0, 3.0};\n")
    good = ("  double force_N = 0.0, low = 0.0;\n", "  void f(double d) {\n    double sum = d;\n  }\n", "  double f(double v);\n",
            "  std::array<Vec3, 2> place_m{}, far_m;\n", "  delta::Joints angle_rad{1_deg, 2_deg};\n", "  Vec3 f(Vec3 v);\n")
    bounds = ("constexpr int kMostSteps = 3;\n", "for (; i < kLeast; ++i)\n", "x = kStepRatio;\n")
    return ([t for t in bad if not list(breaches("x.h", t))] + [t for t in good if list(breaches("x.h", t))] +
            [t for t in bounds if not list(bound_breaches("x.h", t))] +
            list(bound_breaches("x.h", "kMaxSteps kLeastly kStep_ratio\n")))


def main():
    found, count = [], 0
    for top in TOPS:
        for path in sorted((ROOT / top).rglob("*.h")):
            if "node_modules" not in path.parts:
                count += 1
                found += breaches(str(path.relative_to(ROOT)), path.read_text())
    for top in (*TOPS, "tests"):
        for path in sorted((*(ROOT / top).rglob("*.h"), *(ROOT / top).rglob("*.cc"))):
            if "node_modules" not in path.parts:
                found += bound_breaches(str(path.relative_to(ROOT)), path.read_text())
    found += [f"units_test.py: a rule does not see: {text.strip()}" for text in blind_rules()]
    print(*found, sep="\n", end="\n" if found else "")
    print(f"units: {count} headers, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
