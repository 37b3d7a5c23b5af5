#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How does the liver's force depend on Young's modulus? Presses it with five of them and draws force over depth.

    python3 tools/python/sweep_modulus.py [--scene SCENE] [--out modulus.png]

Needs the module tact_sim (tools/python/README.md), python3-numpy and python3-matplotlib.
"""
import argparse
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/client"), str(ROOT / "build/python")]
import tact  # noqa: E402

MODULI_PA = (2000, 3000, 4000, 5000, 6000)
LIFT_M, DEPTH_M, SPEED_MPS = 0.01, 0.008, 0.02


def press(sim, modulus_Pa):
    """Depth of the first sphere, m, and force of the law, N, while the tool goes in."""
    sim.set([f"elastic.youngs_modulus_Pa={modulus_Pa}"])
    site_m, inward = sim.site
    way_m = np.arange(-LIFT_M, DEPTH_M, SPEED_MPS / sim.rate_Hz)
    path_m = site_m + np.outer(np.concatenate([way_m, way_m[::-1]]), inward)
    steps = sim.steps(path_m)
    if not sim.is_set:
        raise SystemExit("the tool is in contact at the start of the path: raise LIFT_M")
    return steps.depth_m[:len(way_m), 0], np.linalg.norm(steps.law_force_N[:len(way_m)], axis=1)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--scene", default=str(ROOT / "model/scenes/liver.toml"))
    arguments.add_argument("--out", default="modulus.png")
    options = arguments.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    sim = tact.Sim(options.scene)
    for modulus_Pa in MODULI_PA:
        depth_m, force_N = press(sim, modulus_Pa)
        is_in_contact = depth_m > 0
        pyplot.plot(1e3 * depth_m[is_in_contact], force_N[is_in_contact], label=f"{modulus_Pa / 1000:g} kPa")
        print(f"E = {modulus_Pa} Pa: {force_N.max():.3f} N at {1e3 * depth_m.max():.1f} mm")
    pyplot.xlabel("depth of the first sphere, mm")
    pyplot.ylabel("force of the law, N")
    pyplot.legend(title="Young's modulus")
    pyplot.savefig(options.out, dpi=120)
    print(options.out)


if __name__ == "__main__":
    main()
