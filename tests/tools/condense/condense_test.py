#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-lab condense as a person meets it; its finite elements in compliance_test.py beside this.

    python3 tests/tools/condense/condense_test.py BUILD_DIR [compliance_test | __main__.Program | ...]

Needs python3-scipy and gmsh. Exit status 0 or 1.
"""
import os
import pathlib
import signal
import struct
import subprocess
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "reference"))

from support import BUILD, LIVER, ROOT, Solves, ball  # noqa: E402

import numpy as np  # noqa: E402

from compliance_test import cushion  # noqa: E402
import body  # noqa: E402
import compliance  # noqa: E402
import condense  # noqa: E402
import run  # noqa: E402
import surface  # noqa: E402

PLAIN = ROOT / "tests/data/scenes/plain.toml"
BALL_HELD = ["elastic.youngs_modulus_Pa=5000", "elastic.poisson_ratio=0.45", "elastic.fixed_min_m=[-1,-1,-1]",
             "elastic.fixed_max_m=[1,1,-0.015]"]


def condense_program(*arguments, **settings):
    ended = subprocess.run([BUILD / "tact-lab", "condense", *map(str, arguments)], stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, check=False, **settings)
    return ended.returncode, ended.stdout


class Program(Solves):
    def refuses(self, arguments, message):
        self.assertEqual(condense_program(*arguments), (2, f"tact-lab condense: {message}\n"))

    def ball_scene(self):
        """Options: plain.toml with a ball of 30 mm, held below z = -15 mm."""
        point, triangle = ball(30.0, 2)
        lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in point.tolist()] + \
            [f"f {a} {b} {c}\n" for a, b, c in (triangle + 1).tolist()]
        (self.folder / "ball.obj").write_text("".join(lines))
        return [PLAIN, *(word for key in (f"organ.mesh={self.folder}/ball.obj", *BALL_HELD) for word in ("--set", key))]

    def test_refuses_lengths_that_are_none(self):
        for option in ("--mesh-size-m", "--patch-radius-m", "--ring-pitch-m"):
            for value, said in (("-1", "-1 is not"), ("0", "0 is not"), ("nan", '"nan" is no finite number'),
                                ("inf", '"inf" is no finite number'), ("3mm", '"3mm" is no finite number')):
                self.refuses([LIVER, "--out", "x.map", option, value],
                             f"{option}: {said} in [1e-06 - 1]; see tact-lab condense --help")

    def test_names_the_keys_of_a_held_box_that_holds_nothing_or_everything(self):
        organ = "of the organ, which lies in [-0.05008, -0.07497, -0.03007] to [0.05009, 0.07499, 0.02999] there; make it hold " \
                "a part (tact-mesh --align proposes one)"
        for low, high, which in ((5, 6, "no"), (-1, 1, "every")):
            self.refuses([LIVER, "--out", "x.map", "--set", f"elastic.fixed_min_m=[{low},{low},{low}]", "--set",
                          f"elastic.fixed_max_m=[{high},{high},{high}]"],
                         f"the held box, elastic.fixed_min_m = [{low}, {low}, {low}] to elastic.fixed_max_m = [{high}, {high}, "
                         f"{high}], holds {which} triangle {organ}")

    def test_refuses_a_surface_without_an_inside(self):
        organ = cushion()[0]
        organ.triangle = organ.triangle[1:]
        with self.assertRaisesRegex(run.Failure, "3 open edges, so it has no inside; close it"):
            condense.check(organ)

    def test_tries_its_file_before_the_work(self):
        self.refuses([LIVER, "--out", "/nowhere/liver.map"], "/nowhere/liver.map: cannot be written: No such file or directory; "
                     "check the folder, who may write there and the free space")
        self.refuses([LIVER, "--out", LIVER], f"{LIVER}: would be overwritten, and is read; name another")
        self.refuses([PLAIN, "--out", self.folder / "map"], f"{PLAIN}: has no [elastic]; add it with youngs_modulus_Pa, "
                     "poisson_ratio, fixed_min_m and fixed_max_m, or give them with --set")

    def test_says_what_to_install(self):
        status, text = condense_program(LIVER, "--out", self.folder / "map", env={**os.environ, "PATH": "/nowhere"})
        self.assertEqual((status, text), (2, "filling with elements: about 3 s\ntact-lab condense: gmsh is not installed; apt "
                                          "install gmsh\n"))

    def test_makes_the_map_that_another_solver_made(self):
        # ball.compliance: by MUMPS and C++, the same command.
        out = self.folder / "map"
        status, text = condense_program(*self.ball_scene(), "--ring-pitch-m", 0.005, "--rings", 6, "--mesh-size-m", 0.006,
                                        "--patch-radius-m", 0.02, "--out", out)
        self.assertEqual(status, 0, text)
        self.assertIn("66 vertices, 6 rings of 5 mm, nu = 0.45\nbody   ", text)
        known, made = (HERE / "ball.compliance").read_bytes(), out.read_bytes()
        self.assertEqual((made[:112], len(made)), (known[:112], len(known)), "the head, with the hash of the mesh")
        known, found = (np.frombuffer(data[112:-8], "<f4") for data in (known, made))
        np.testing.assert_allclose(found[:66], known[:66], atol=1e-5 * np.abs(known).max())
        np.testing.assert_allclose(found[66 * 8:], known[66 * 8:], atol=1e-5 * np.abs(known).max())
        (n1, n2, s1, s2, *axis), found = known[66:66 * 8].reshape(66, 7).T, found[66:66 * 8].reshape(66, 7).T
        scale = 1e-5 * np.abs(known).max()
        np.testing.assert_allclose(found[2] + found[3], s1 + s2, atol=scale)  # of any two axes
        apart = np.abs(s1 - s2) > 1e-2 * np.abs(known).max()  # else any axis is one
        self.assertGreater(apart.sum(), 20)
        np.testing.assert_allclose(found[:4, apart], np.array([n1, n2, s1, s2])[:, apart], atol=10 * scale)
        np.testing.assert_allclose(found[4:, apart], np.array(axis)[:, apart], atol=1e-3)

    def test_puts_the_lumps_of_the_scene_into_the_map(self):
        scene, out = self.folder / "lump.toml", self.folder / "map"
        words = ["--rings", 1, "--out", out, *self.ball_scene()[1:]]
        hashes = []
        for modulus_Pa in (50000, 5000):
            scene.write_text(PLAIN.read_text().replace('"box.obj"', f'"{PLAIN.parent}/box.obj"') + "[[elastic.inclusion]]\n"
                             f"center_m = [0.0, 0.0, 0.015]\nradius_m = 0.012\nyoungs_modulus_Pa = {modulus_Pa}\n")
            status, text = condense_program(scene, *words)
            self.assertEqual(status, 0, text)
            self.assertIn("elements of 12 mm", text, "as its radius, if that is less")
            self.assertRegex(text, r"\Afilling with elements: about \d+ s\nfilling with elements: \d+ s\nfactoring: about \d+ s\n"
                             r"factoring: \d+ s\nsolving: about \d+ s\nsolving: \d+ s\n")
            hashes.append(struct.unpack_from("<I", out.read_bytes(), 20)[0])
        self.assertEqual(len({0, *hashes}), 3, "the head says of which")

    def test_ctrl_c_ends_it_at_once_and_leaves_nothing(self):
        out = self.folder / "map"
        words = [BUILD / "tact-lab", "condense", *self.ball_scene(), "--mesh-size-m=0.0025", f"--out={out}"]
        before = set(pathlib.Path("/tmp").glob("tact-*"))
        asked = subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                 env={**os.environ, "TMPDIR": str(self.folder)})
        until_s = time.monotonic() + 120.0
        while not list(self.folder.glob("tact-reference-*")) and time.monotonic() < until_s:
            time.sleep(0.02)
        asked.send_signal(signal.SIGINT)
        self.assertRegex(asked.communicate(timeout=10)[0],
                         r"\Afilling with elements: about \d+ s\ntact-lab condense: interrupted; nothing was written\n\Z")
        self.assertEqual(asked.returncode, 1)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"ball.obj"})
        self.assertEqual(set(pathlib.Path("/tmp").glob("tact-gmsh*")) - before, set())


class Lumps(Solves):
    @staticmethod
    def organ(*lumps):
        """A ball of 30 mm, held below z = -15 mm."""
        point, triangle = ball(0.03, 3)
        return body.Organ(point, triangle, surface.unit(point), np.full(3, -1.0), np.array([1.0, 1.0, -0.015]), 1.0, 0.45,
                          lumps=lumps)

    def test_one_counts_over_it_and_not_beside_it(self):
        at_m, size_m = np.array([0.0, 0.0, 0.02]), 0.005
        made = body.make_body(self.organ(), surface.EdgeLengths(np.zeros((1, 3)), 0.0, 1e3, 0.0, size_m))

        def gives(*lumps):
            """C_nn E over it and beside it, 1/m, for a patch of 8 mm."""
            organ = self.organ(*lumps)
            vertices = np.array([organ.vertex_m[:, 2].argmax(), organ.vertex_m[:, 0].argmax()])
            rows = compliance.Condensation(organ, made, 0.008, 0.002, 1).of_vertices(vertices)
            return rows[:, 0] + compliance.half_space_normal_m_per_N(organ, 0.008)

        plain = gives()
        hard = body.Lump(at_m, 0.008, 10.0)
        over, beside = gives(hard) / plain
        self.assertLess(over, 0.95)
        self.assertAlmostEqual(beside, 1.0, delta=0.01)
        np.testing.assert_array_equal(gives(hard, body.Lump(at_m, 0.008, 1.0)), plain, "the later one counts")

    def test_one_lies_deeper_than_its_radius(self):
        condense.check_lumps(self.organ(body.Lump(np.array([0.0, 0.0, 0.02]), 0.0095, 10.0)))
        for z_m, radius_m, said in ((0.02, 0.011, "below the surface at vertex 2 and a radius of 11 mm"),
                                    (0.04, 0.003, "outside the surface at vertex 2 and a radius of 3 mm")):
            with self.assertRaisesRegex(run.Failure, f"elastic.inclusion 1 of 1 has its centre 10 mm {said}; move"):
                condense.check_lumps(self.organ(body.Lump(np.array([0.0, 0.0, z_m]), radius_m, 10.0)))


class MapFile(Solves):
    JOB = {"out": "x.map", "ring_pitch_m": 0.002, "surface_hash": "0123456789abcdef", "inclusions_hash": 7}

    def test_is_laid_out_as_its_reader_has_it(self):
        organ = cushion()[0]
        rows = np.arange(22.0).reshape(2, 11)
        data = condense.map_bytes(self.JOB, organ, 0.008, rows)
        self.assertEqual(struct.unpack("<8s4I9d16s", data[:112]), (b"TACTCOMP", 2, 2, 3, 7, 0.45, 0.008, 0.002, -1.0, -1.0, -1.0,
                                                                   1.0, 1.0, 1e-6, b"0123456789abcdef"))
        self.assertEqual(struct.unpack("<22f", data[112:200]),
                         (0.0, 11.0, *range(1, 8), *range(12, 19), 8.0, 9.0, 10.0, 19.0, 20.0, 21.0))
        checksum = 0xcbf29ce484222325
        for byte in data[:-8]:
            checksum = ((checksum ^ byte) * 0x100000001b3) % 2**64
        self.assertEqual(struct.unpack("<Q", data[200:]), (checksum,))

    def test_holds_no_value_that_is_no_finite_number(self):
        for bad in (np.nan, np.inf, 1e300):
            for column in (0, 3, 9):
                rows = np.ones((2, 11))
                rows[1, column] = bad
                with self.assertRaisesRegex(run.Failure, "x.map: not written, the map holds a value that is no finite number"), \
                        np.errstate(over="ignore"):
                    condense.map_bytes(self.JOB, cushion()[0], 0.008, rows)


if __name__ == "__main__":
    names = sys.argv[2:] or ["__main__", "compliance_test"]
    tests = unittest.defaultTestLoader.loadTestsFromNames(names)
    sys.exit(not unittest.TextTestRunner(verbosity=1).run(tests).wasSuccessful())
