# SPDX-License-Identifier: Apache-2.0
"""Which cases make a reference, where the whole tool is pressed, and how the solves become one file."""
import json
import unittest
from dataclasses import replace

import numpy as np

from support import REFERENCES, liver

import indentation
import job
import plan
import run
import self_check
import texts
import tool_plan
import tool_press


class Plans(unittest.TestCase):
    def setUp(self):
        block = self_check.make_block(0.05)
        self.plan = plan.Plan(replace(block, mesh="block.obj"), 5e-3, [0, 3], [1e-3, 2e-3, 9e-3], [3], 2)

    def made_up(self, no_solution=()):
        """F = d, 1 % more at the coarser level, 5 % more at the least depth."""
        solved = []
        for what in plan.cases_of(self.plan):
            coarse = what.level < (1 if what.large_strain else self.plan.level)
            more = (1.05 if what.depth_m == self.plan.depths_m[0] else 1.01) if coarse else 1.0
            d = what.depth_m
            case = indentation.Case(d, what.large_strain, d * more, 1e-3, [d, 0.5 * d])
            solved.append(None if (what.large_strain, what.depth_m) in no_solution else case)
        return [plan.cases_of_site(self.plan, vertex, solved) for vertex in self.plan.sites]

    def test_every_depth_and_the_coarse_ones_for_the_error(self):
        cases = plan.cases_of(self.plan)
        # A site: three presses, one pull; least, largest and pull coarser. With large strain: three presses and two pulls, since
        # 9 mm is too far for one; least and largest of both coarser.
        self.assertEqual(len(cases), 2 * 7 + 5 + 4)
        for case in cases:
            if case.large_strain:
                self.assertEqual(case.vertex, 3)
                self.assertTrue(case.level == 1 or case.depth_m != 2e-3)
                self.assertGreater(case.depth_m, -3e-3)

    def test_puts_the_file_together(self):
        linear, both = self.made_up()
        np.testing.assert_allclose([c.depth_m for c in linear], [1e-3, 2e-3, 9e-3, -1e-3, -2e-3, -9e-3])
        np.testing.assert_allclose([c.force_N for c in linear], [c.depth_m for c in linear], err_msg="pull is one solve, scaled")
        np.testing.assert_allclose([c.profile_m[1] for c in linear], [0.5 * c.depth_m for c in linear])
        np.testing.assert_allclose([c.force_error_ratio for c in linear], 7 / 3 * np.array([0.05, 0.05, 0.01, 0.01, 0.01, 0.01]))
        self.assertEqual([c.large_strain for c in both], [False] * 6 + [True] * 5)
        # Its own; where a bond is drawn out the error falls slower.
        np.testing.assert_allclose([c.force_error_ratio for c in both[6:]], [0.35 / 3, 0.35 / 3, 0.07 / 3, 0.04, 0.04])
        data = json.loads(texts.sphere(self.plan, 'a "solver"', [(0, linear), (3, both)])[0])
        self.assertEqual((data["schema"], data["solver"]), ("tact-reference/1", 'a "solver"'))
        self.assertEqual(data["sites"][0]["direction"], [0, 0, -1])

    def test_a_large_strain_without_a_solution_is_left_out(self):
        both = self.made_up({(True, 9e-3)})[1]
        self.assertEqual([c.depth_m for c in both[6:]], [1e-3, 2e-3, -1e-3, -2e-3])
        self.assertAlmostEqual(both[7].force_error_ratio, 7 / 3 * 0.05, msg="of the end that is left")

    def test_the_coarsest_level_has_no_error_that_is_known(self):
        self.plan.level = 1
        for cases in self.made_up():
            self.assertTrue(all((c.force_error_ratio is None) != c.large_strain for c in cases), "large has levels of its own")
        data = json.loads(texts.sphere(self.plan, "s", [(0, cases)])[0])
        self.assertIsNone(data["sites"][0]["cases"][0]["force_error_ratio"])

    def test_refuses_what_cannot_be_solved(self):
        depths = "--depths must rise, all above 0 and at most 0.025 m (5 tool radii); give metres: 0.001,0.002"
        plan.check(self.plan)
        plan.check(replace(self.plan, depths_m=[0.025]))
        for changed, message in [
                ({"sites": [0, 434]}, "site 434 is no vertex of block.obj; they are 0 to 433"),
                ({"sites": [3, 217]}, "site 217 lies in the held box, elastic.fixed_min_m to elastic.fixed_max_m; choose another,"
                 " or move the box"),
                ({"sites": [0, 3, 0]}, "site 0 is there twice; give it once"),
                ({"sites": []}, "no site to solve; add [[reference_site]] to the scene, or give --sites"),
                ({"large_strain_sites": [5]}, "large strain at 5, which is no site; add it to --sites"),
                *(({"depths_m": bad}, depths) for bad in ([], [0.0, 1e-3], [2e-3, 1e-3], [1e-3, 1e-3], [np.nan], [1e-3, np.nan],
                                                          [np.nan, 1e-3], [1e-3, np.inf], [0.1]))]:
            with self.assertRaises(run.Failure) as refused:
                plan.check(replace(self.plan, **changed))
            self.assertEqual(refused.exception.message, message)
        triangle = self.plan.organ.triangle[1:]
        with self.assertRaisesRegex(run.Failure, "block.obj has 3 open edges"):
            plan.check(replace(self.plan, organ=replace(self.plan.organ, triangle=triangle)))


class ToolPlans(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.organ, cls.hand = job.organ_of(liver()), liver()["hand"]
        offset_m, radius_m = (np.array([sphere[key] for sphere in liver()["tool"]]) for key in ("offset_m", "radius_m"))
        cls.places = tool_plan.Places(cls.organ, offset_m, radius_m, np.array(cls.hand["inward"]), 10e-3)
        cls.fitted = [site["vertex"] for site in liver()["reference_sites"] if not site["held_out"]]
        cls.known = json.loads((REFERENCES / "liver_tool.json").read_text())["places"]

    def test_is_at_the_hands_site_along_its_slides_and_at_six_places_that_no_fit_uses(self):
        found = tool_plan.places_of(self.places, self.hand, self.fitted, [])
        self.assertEqual([place.name for place in found[:3]], ["hand's", "slid 10 mm", "slid 20 mm"])
        self.assertEqual([place.vertex for place in found], [place["vertex"] for place in self.known])
        self.assertFalse(set(self.fitted) & {place.vertex for place in found})
        for place, known in zip(found, self.known):
            for key in ("point_m", "direction"):
                np.testing.assert_allclose(getattr(place, key), known[key], atol=1e-6)
            np.testing.assert_allclose(place.orientation, known["orientation_wxyz"], atol=1e-6)
            np.testing.assert_allclose(tool_plan.rotate(place.orientation, self.places.inward), place.direction, atol=1e-12)
        gripped = {**self.hand, "path": [{**point, "grip_ratio": 1.0} for point in self.hand["path"]]}
        self.assertEqual(tool_plan.slides_of(gripped, self.places), [], "a pull, no slide")

    def test_the_surface_around_a_place_faces_the_tool(self):
        known = json.loads((REFERENCES / "liver_tool_skin.json").read_text())["places"][1]
        place = self.places.touching(self.places.at(known["vertex"]))
        self.assertEqual(list(tool_plan.surface_around(self.organ, place)), known["skin"])

    def test_first_contact_at_depth_zero(self):
        found = tool_plan.places_of(self.places, self.hand, self.fitted, [1985, 2478])
        presses = tool_plan.presses_of(self.places, found, [1e-3], 1)
        self.assertEqual([what.level for what in presses], [1, 1, 1, 0, 0, 0], "three places at two levels")
        weight = np.array([(p, q, 20 - p - q) for p in range(21) for q in range(21 - p)]) / 20
        for what in presses[1:3]:
            facing = self.places.face_normal @ np.array(what.direction) <= 0.0
            point_m = np.einsum("gk,fki->fgi", weight, self.places.corner_m[facing])
            self.assertAlmostEqual(tool_press.reach_beyond(what, point_m)[0].max(), 0.0, delta=0.03e-3)

    def test_a_tilted_tool_brings_one_sphere_first_at_the_same_site(self):
        own, tilted = tool_plan.places_of(self.places, self.hand, self.fitted, [1985], [40.0])[:2]
        self.assertEqual((own.name, tilted.name), ("hand's", "tilted 40"))
        self.assertEqual(len(tool_plan.places_of(self.places, self.hand, self.fitted, [], [0.0, 20.0])), 2, "of that site alone")
        np.testing.assert_array_equal(tilted.direction, own.direction)
        along_m = self.places.centres_m(tilted) @ own.direction
        self.assertAlmostEqual(np.ptp(along_m), 8e-3 * np.sin(np.radians(40.0)), delta=1e-9, msg="centres are 8 mm apart")
        off_m = tilted.point_m - own.point_m
        np.testing.assert_allclose(off_m - off_m @ own.direction * own.direction, 0.0, atol=1e-12)

    def test_at_finite_strain_each_place_is_solved_once_by_the_program_that_is_named(self):
        found = tool_plan.places_of(self.places, self.hand, self.fitted, [1985])
        presses = tool_plan.finite_presses_of(self.places, found, [1e-3, 2e-3], 1, "CalculiX")
        self.assertEqual([(what.solver, what.level, what.depths_m) for what in presses], [("CalculiX", 1, (1e-3, 2e-3))] * 2)
        self.assertEqual(presses[0].centre_m, tool_plan.presses_of(self.places, found, [1e-3], 1)[0].centre_m)

    def test_an_error_is_what_is_left_of_the_change_between_two_levels(self):
        def solved(force_N):
            return [tool_press.ToolCase(0.002, force_N, [0.0, force_N])]

        found = [tool_plan.PressPlace(None, np.zeros(3), np.zeros(3), self.places.inward), self.places.at(1985)]
        done = tool_plan.assemble(found, [solved(1.0), solved(2.0), solved(1.03), solved(1.97)])
        np.testing.assert_allclose([place.cases[0].force_error_ratio for place in done], 7 / 3 * np.array([0.03, 0.015]))
        data = json.loads(texts.tool(self.places, "s", done)[0])
        self.assertEqual([place["vertex"] for place in data["places"]], [None, 1985])
        self.assertEqual(data["places"][1]["cases"][0]["force_N"], 2.0)
