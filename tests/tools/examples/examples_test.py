#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/examples/ is a project outside tact: it finds an installed tact, or takes the sources, and its programs run.

    python3 tests/tools/examples/examples_test.py BUILD_DIR

All is built in a temporary folder. Of the sources it builds with TACT_EXTENT=whole alone, as that takes a minute; without
it configures them. Needs python3-numpy and python3-matplotlib. Exit status 0 or 1.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "tools/examples"
LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(".")
PUBLIC = re.compile(r"set\(public_headers([^)]*)\)")


def run(*command, **settings):
    ended = subprocess.run([*map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **settings)
    if ended.returncode:
        raise AssertionError(f"{' '.join(map(str, command))}: status {ended.returncode}\n{ended.stdout}")
    return ended.stdout


def public_headers():
    return PUBLIC.search((ROOT / "tools/cmake/library.cmake").read_text())[1].split()


def cached(name):
    """Of the build under test: the guest has the same compiler, and the same cache of it."""
    return re.search(rf"^{name}:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text() + f"\n{name}:X=\n", re.M)[1]


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        shutil.copytree(EXAMPLES, cls.folder / "source")
        run("cmake", "--install", BUILD, "--component", "development", "--prefix", "/opt/tact",
            env={**os.environ, "DESTDIR": str(cls.folder)})
        cls.prefix = cls.folder / "opt/tact"
        cls.found = cls.configure("found", f"-DCMAKE_PREFIX_PATH={cls.prefix}")
        run("cmake", "--build", cls.found)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def configure(cls, name, *options):
        run("cmake", "-S", cls.folder / "source", "-B", cls.folder / name, "-G", "Ninja", *options,
            *(f"-D{key}={cached(key)}" for key in ("CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_LAUNCHER")))
        return cls.folder / name

    def columns(self, text):
        return [[float(word) for word in line.split()] for line in text.splitlines()[1:]]

    def test_the_wall_pushes_by_its_law_and_the_gate_limits_it(self):
        rows = self.columns(run(self.found / "wall"))
        self.assertEqual(len(rows), 11)
        for _, depth_mm, law_N, gate_N in rows:
            self.assertAlmostEqual(law_N, max(depth_mm, 0.0), delta=0.006)  # 1 N/mm; the depth has two decimals
            self.assertAlmostEqual(gate_N, min(law_N, 1.5), delta=0.001)
        self.assertGreater(rows[5][2], rows[5][3])

    def test_a_law_of_ones_own_presses_a_scenes_organ(self):
        rows = self.columns(run(self.found / "own_law", LIVER))
        self.assertEqual(len(rows), 11)
        self.assertEqual([row[1] for row in rows[:5]], [0.0] * 5)
        forces_N = [row[1] for row in rows[5:]]
        self.assertEqual(forces_N, sorted(forces_N))
        self.assertGreater(forces_N[-1], 0.3)

    def test_a_loop_of_ones_own_has_the_force_of_the_scene(self):
        output = run(self.found / "own_loop", LIVER)
        largest_N, limit_N = map(float, re.match(r"largest force (\S+) N, limit (\S+) N, none$", output.strip()).groups())
        self.assertGreater(largest_N, 0.05)
        self.assertLess(largest_N, limit_N)
        self.assertEqual(limit_N, 2.0)  # a quarter of the scene's: no hard real time

    def test_a_run_that_goes_on_is_read_in_python(self):
        settings = {"env": {**os.environ, "XDG_RUNTIME_DIR": str(self.folder)}}
        tactd = subprocess.Popen([BUILD / "tactd", LIVER, "--seconds", "60", "--no-black-box"], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True, **settings)
        try:
            for line in tactd.stderr:
                if "limits" in line:  # the last before the loop
                    break
            output = run(sys.executable, ROOT / "tools/client/example.py", "--seconds", "2", "--out", self.folder, **settings)
        finally:
            tactd.terminate()
            tactd.stderr.close()
            tactd.wait(30)
        self.assertRegex(output, r"^1\d\d frames, \d\.\d s, force at most \d\.\d+ N\n$")
        self.assertGreater((self.folder / "force.png").stat().st_size, 5000)

    def test_each_public_header_compiles_alone(self):
        for name in public_headers():
            (self.folder / "alone.cc").write_text(f'#include "{name}"\n')
            run(cached("CMAKE_CXX_COMPILER"), "-std=c++20", "-fsyntax-only", f"-I{self.prefix}/include/tact",
                self.folder / "alone.cc")

    def test_examples_include_public_headers_alone(self):
        named = {name for path in EXAMPLES.glob("*.cc") for name in re.findall(r'^#include "(.*)"', path.read_text(), re.M)}
        self.assertEqual(named - set(public_headers()), set())

    def test_another_version_is_not_taken(self):
        (self.folder / "old").mkdir()
        (self.folder / "old/CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(old LANGUAGES NONE)\nfind_package(tact 0.0.9)\n"
            "file(WRITE ${PROJECT_BINARY_DIR}/output \"${tact_FOUND} ${tact_CONSIDERED_VERSIONS}\")\n")
        run("cmake", "-S", self.folder / "old", "-B", self.folder / "old", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.assertRegex((self.folder / "old/output").read_text(), r"^0 \d+\.\d+\.\d+$")

    def test_the_sources_are_a_part_that_changes_nothing_else(self):
        build = self.configure("part", f"-DTACT_SOURCE={ROOT}", "-DBUILD_TESTING=ON", "-DTACT_WERROR=ON",
                               "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG")  # as tact's own, for the compiler cache
        targets = run("ninja", "-C", build, "-t", "targets", "all")
        self.assertIn("tact/libtact.a", targets)
        self.assertNotRegex(targets, r"(tactd|_test|tact-\w+):")
        commands = run("ninja", "-C", build, "-t", "commands", "wall")
        self.assertNotIn(f"-I{self.folder}", commands)
        own = re.search(r"^.* -c \S+wall\.cc$", commands, re.M)[0]
        self.assertNotRegex(own, r" -(W|f|D(?!NDEBUG))")
        self.assertNotRegex((build / "CMakeCache.txt").read_text(), r"(?m)^DART_|EXPORT_COMPILE_COMMANDS:BOOL=ON")
        self.assertNotRegex(run("ninja", "-C", build, "-n"), r"tact/(host|tools|tests)/|tact_hal_(?!threads)\w|tact_firmware_run")
        if os.environ.get("TACT_EXTENT") not in ("whole", "long"):
            return
        run("ninja", "-C", build)
        for command in (["wall"], ["own_law", LIVER]):
            self.assertEqual(*(run(place / command[0], *command[1:]) for place in (build, self.found)))


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
