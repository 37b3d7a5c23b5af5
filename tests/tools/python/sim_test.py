#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact.Sim of tools/python: built outside the tree, its forces are those of tactd, and it is fast enough for batches.

    python3 tests/tools/python/sim_test.py BUILD_DIR

Builds the module in a temporary folder, a minute or two: only with TACT_EXTENT=whole; else it checks what the client says
where the module is missing. Needs pybind11-dev, python3-dev, python3-numpy and python3-matplotlib. Exit status 0 or 1.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
LIVER = str(ROOT / "model/scenes/liver.toml")
BUILD = pathlib.Path(".")
sys.path.insert(0, str(ROOT / "tools/client"))


def cached(name):
    return re.search(rf"^{name}:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text() + f"\n{name}:X=\n", re.M)[1]


class WithoutTheModule(unittest.TestCase):
    def test_the_client_says_how_to_build_it(self):
        done = subprocess.run([sys.executable, "-I", "-c", "import sys; sys.path.insert(0, sys.argv[1]); import tact; tact.Sim",
                               str(ROOT / "tools/client")], capture_output=True, text=True, check=False)
        self.assertIn(f"cmake -S {ROOT / 'tools/python'} -B tact_sim", done.stderr)


@unittest.skipUnless(os.environ.get("TACT_EXTENT") == "whole", "builds for minutes: TACT_EXTENT=whole")
class Sim(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = cls.temporary.name
        options = [f"-D{key}={cached(key)}" for key in ("CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_LAUNCHER")]
        subprocess.run(["cmake", "-S", ROOT / "tools/python", "-B", cls.folder, "-G", "Ninja", *options,
                        f"-DPython_EXECUTABLE={sys.executable}"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", cls.folder], check=True, stdout=subprocess.DEVNULL)
        sys.path.insert(0, cls.folder)
        import tact
        cls.tact = tact

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_forces_are_those_of_tactd(self):
        """The poses of a tick log of tactd, fed one by one."""
        log_path = f"{self.folder}/run.tactlog"
        subprocess.run([BUILD / "tactd", LIVER, "--free-run", "--ticks", "4000", "--no-telemetry", "--no-black-box",
                        "--record", log_path], check=True, capture_output=True)
        ticks = self.tact.read_ticks(log_path).ticks
        sim = self.tact.Sim(LIVER)
        first = int(ticks["sample_fresh"].argmax())
        steps = sim.steps(ticks["tool_position_m"][first:], ticks["tool_orientation"][first:], ticks["grip_ratio"][first:])
        self.assertGreater(abs(ticks["wanted_force_N"]).max(), 0.1)
        difference_N = abs(steps.law_force_N - ticks["wanted_force_N"][first:]).max()
        self.assertLess(difference_N, 1e-9, "but for the velocity, which the liver's law does not use")

    def test_numbers_change_the_force(self):
        sim = self.tact.Sim(LIVER)
        site_m, inward = sim.site
        path_m = [site_m + depth_m * inward for depth_m in [-0.01 + 2e-5 * i for i in range(800)]]
        hard_N = abs(sim.steps(path_m).law_force_N).max()
        sim.steps(path_m[::-1])
        sim.set(["elastic.youngs_modulus_Pa=2500"])
        soft_N = abs(sim.steps(path_m).law_force_N).max()
        self.assertTrue(sim.is_set)
        self.assertGreater(soft_N, 0)
        self.assertLess(soft_N, 0.95 * hard_N)
        with self.assertRaisesRegex(RuntimeError, "cannot change"):
            sim.set(["limits.force_N=3"])

    def test_errors_name_the_file(self):
        with self.assertRaisesRegex(RuntimeError, "/nowhere.toml"):
            self.tact.Sim("/nowhere.toml")
        with self.assertRaisesRegex(ValueError, r"shape \(n, 3\)"):
            self.tact.Sim(LIVER).steps([1.0, 2.0])

    def test_single_steps_cost_little(self):
        """Printed, not asserted: the time of a machine under load is no property of the code."""
        sim = self.tact.Sim(LIVER)
        site_m, inward = sim.site
        begin_s = time.perf_counter()
        for i in range(1000):
            sim.step(site_m + (2e-5 * i - 0.01) * inward)
        print(json.dumps({"ms_of_1000_steps": round(1e3 * (time.perf_counter() - begin_s), 2)}))

    def test_the_example_draws_its_picture(self):
        picture = f"{self.folder}/modulus.png"
        printed = subprocess.run([sys.executable, ROOT / "tools/python/sweep_modulus.py", "--out", picture], check=True,
                                 capture_output=True, text=True, env={**os.environ, "PYTHONPATH": self.folder}).stdout
        forces_N = [float(n) for n in re.findall(r"Pa: ([0-9.]+) N", printed)]
        self.assertEqual(forces_N, sorted(forces_N))
        self.assertEqual(len(forces_N), 5)
        self.assertGreater(pathlib.Path(picture).stat().st_size, 5000)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
