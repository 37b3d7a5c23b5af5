# SPDX-License-Identifier: Apache-2.0
"""What is bounded: for each law a scene, the classes that it makes, and what its loops' bounds depend on."""
import collections
import math
import tomllib

from machine import Refused

Case = collections.namedtuple("Case", "bench scene phases classes names")

# Instructions of an imported function: twice the longest of 1 500 arguments (denormal, huge, infinite and NaN among
# them), measured by single steps on Debian 12's glibc; assumed, not proved. Copies: 4 kB at 32 bytes each, and around.
LIBRARY = {"fmin": 36, "fmax": 36, "hypot": 130, "sin": 220, "cos": 230, "atan": 160, "exp": 220, "expm1": 190,
           "log": 160, "log1p": 180, "tanh": 260, "asin": 210, "atanh": 240, "ceil": 20, "floor": 20, "round": 60,
           "sqrt": 110, "sincos": 330, "memcpy": 300, "memmove": 300, "memset": 300, "memcmp": 300}
# What the kernel does is not counted.
KERNEL = {"clock_gettime": 100, "clock_nanosleep": 100}
# They end the program; no tick that goes on calls them.
ENDS = ("trap", "abort", "__stack_chk_fail", "_ZSt9terminatev", "__cxa_", "_Unwind_", "_ZSt__throw",
        "_ZSt20__throw", "_ZSt24__throw", "_ZSt17__throw", "_ZSt19__throw", "_ZSt28__throw")

PHASES = ("read", "detect", "render", "limit", "write", "publish")  # as they follow one another in RtLoop::tick

LOOP = ("MonotonicClock",)
# The gate of the hand alone, and with the gate of a gripper that has a motor.
GRIPPERS = {"cia402": 0, "falcon": 0, "force-dimension": 1, "moteus": 0, "odrive05": 0, "odrive06": 0, "phantom": 0,
            "sim-delta": 1}
CASES = tuple(Case(bench, "liver", ("limit",), LOOP, {"grips": grips}) for bench, grips in GRIPPERS.items())


def cost(name):
    """Instructions of an imported function; None: it does not return."""
    plain = name.split("@")[0]
    if plain.startswith(ENDS):
        return None
    figure = LIBRARY.get(plain, KERNEL.get(plain))
    if figure is None:
        raise Refused(f"{plain}: an imported function without a figure (cases.py)")
    return figure


def names_of(case, root):
    """What the bounds in the source are expressions of."""
    scene = tomllib.loads((root / f"model/scenes/{case.scene}.toml").read_text())
    spheres = len(scene["tool"]["sphere"])
    radius_m = min(sphere["radius_m"] for sphere in scene["tool"]["sphere"])
    limits = scene["limits"]
    lever_m = max(math.dist(sphere["offset_m"], (0, 0, 0)) for sphere in scene["tool"]["sphere"])
    way_m = 1.05 * (limits["speed_mps"] + limits.get("turn_radps", 0.0) * lever_m) / scene["rate_Hz"] + 1e-4
    unknowns = 3 * spheres if "MovedContact" in case.classes else 2 * spheres
    return {"spheres": spheres, "pairs": spheres * (spheres - 1) // 2, "skipped": 0,
            "steps": math.ceil(way_m / (0.5 * radius_m)), "unknowns": unknowns,
            "half": unknowns * (unknowns - 1) // 2, "leaves": 512, "fan": 128, **case.names}
