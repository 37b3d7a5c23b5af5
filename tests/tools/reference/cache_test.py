# SPDX-License-Identifier: Apache-2.0
"""Cases solved once and kept."""
import multiprocessing
import os
import unittest.mock
from dataclasses import replace

from support import Solves

import cache
import contact
import indentation
import run
import self_check
import tool_press

PRESS = indentation.Indentation(0, 5e-3, 1e-3, contact_radius_m=2.2e-3)
TOOL = tool_press.ToolPress((0.0, 0.0, -1.0), ((0.0, 0.0, 4e-3),), (4e-3,), (1e-3, 2e-3, 5e-3, 10e-3), level=0)


class Kept(Solves):
    def setUp(self):
        super().setUp()
        self.organ = replace(self_check.make_block(0.05), mesh_hash="0123")
        self.cache = cache.Cache(self.folder / "new/folder", self.organ, "solver 1")
        self.case = indentation.Case(1e-3, True, 0.1 / 3.0, 2e-3, [1e-3, 1e-3 / 7.0])

    def key(self, what, **other):
        kind = tool_press if isinstance(what, tool_press.ToolPress) else indentation
        organ = replace(self.organ, **{key: value for key, value in other.items() if key != "solver"})
        return cache.Cache(self.folder, organ, other.get("solver", "solver 1")).key(what, kind.edge_lengths(organ, what))

    def test_finds_what_it_kept_and_nothing_else(self):
        self.assertIsNone(self.cache.find("a key", indentation.Case))
        self.cache.keep("a key", [self.case])
        self.assertEqual(self.cache.find("a key", indentation.Case), [self.case], "to the last bit")
        self.assertIsNone(self.cache.find("another key", indentation.Case))
        self.assertIsNone(self.cache.find("a key", tool_press.ToolCase), "it is no whole tool")
        # Two keys of one hash: the other's file lies where ours would.
        self.cache.path("a key").rename(self.cache.path("another key"))
        self.assertIsNone(self.cache.find("another key", indentation.Case))
        self.cache.path("a key").write_text('{"key": "a key", "solved": [{')
        self.assertIsNone(self.cache.find("a key", indentation.Case), "a damaged file counts as absent")

    def test_many_may_keep_the_same_case_at_once(self):
        self.case.profile_m = [1.0 / 3.0] * 3000
        with multiprocessing.get_context("fork").Pool(4) as pool:
            pool.starmap(self.cache.keep, [("a key", [self.case])] * 100)
        self.assertEqual(list(self.cache.folder.iterdir()), [self.cache.path("a key")], "nothing else is left behind")
        self.assertEqual(self.cache.find("a key", indentation.Case), [self.case])

    def test_says_what_to_do_without_room(self):
        with self.assertRaisesRegex(run.Failure, "name another --cache"):
            cache.Cache(self.folder / ("x" * 300), self.organ, "s").keep("a key", [self.case])

    def test_the_key_names_everything_that_changes_the_answer(self):
        keys = [self.key(PRESS), self.key(PRESS, solver="solver 2"), self.key(TOOL)]
        keys += [self.key(replace(PRESS, **other)) for other in (
            {"vertex": 1}, {"tool_radius_m": 4e-3}, {"depth_m": -1e-3}, {"large_strain": True}, {"level": 3},
            {"contact_radius_m": 2e-3}, {"along": (1.0, 0.0, 0.0)}, {"along": (1.0, 0.0, 0.0), "held": True})]
        keys += [self.key(PRESS, **other) for other in (
            {"youngs_modulus_Pa": 2000.0}, {"poisson_ratio": 0.4}, {"mesh_hash": "0124"},
            {"held_max_m": self.organ.held_max_m + 1e-3})]
        keys += [self.key(replace(TOOL, **other)) for other in (
            {"centre_m": ((1e-6, 0.0, 4e-3),)}, {"depths_m": (1e-3, 2e-3)}, {"level": 2}, {"skin": (3,)}, {"radius_m": (5e-3,)})]
        self.assertEqual(len(set(keys)), len(keys))
        self.assertEqual(self.key(PRESS), keys[0])

    def test_a_hit_does_not_run_the_solver(self):
        self.cache.keep(self.cache.key(PRESS, indentation.edge_lengths(self.organ, PRESS)), [replace(self.case, force_N=42.0)])
        with unittest.mock.patch.dict(os.environ, PATH="/nowhere"):
            self.assertEqual(self.cache.case(PRESS).force_N, 42.0)
            with self.assertRaises(run.Failure) as refused:
                self.cache.case(replace(PRESS, vertex=1))
        self.assertEqual(refused.exception.message, "gmsh is not installed; apt install gmsh")

    def test_a_press_without_a_radius_is_solved_coarsely_first(self):
        asked, probe = replace(PRESS, contact_radius_m=0.0), cache.probe_of(0, 5e-3)
        self.assertEqual(probe, replace(PRESS, depth_m=5e-3, level=1, contact_radius_m=0.75 * 5e-3))
        probe_N = 0.9 * contact.sphere_force_N(self.organ, 5e-3, 5e-3)
        tip = contact.TipContact(self.organ.contact_modulus_Pa, 5e-3)  # the block's top is flat
        radius_m = tip.contact_radius_m(1e-3, tip.compliance_m_per_N(5e-3, probe_N))
        self.assertLess(radius_m, 0.99 * contact.sphere_contact_radius_m(5e-3, 1e-3))
        solved = {probe: replace(self.case, force_N=probe_N)}

        def solve(_, what):
            if what not in solved:
                self.assertAlmostEqual(what.contact_radius_m, radius_m, delta=1e-9)
                solved[what] = replace(self.case, force_N=42.0)
            return [solved[what]]

        with unittest.mock.patch("indentation.solve", solve):
            self.assertEqual(self.cache.case(asked).force_N, 42.0)
        self.assertEqual(len(solved), 2)
