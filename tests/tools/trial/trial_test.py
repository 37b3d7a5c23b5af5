#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-trial of BUILD_DIR: its methods find what an observer has, its marks stand in the log, its table is that of BIDS.

    python3 tests/tools/trial/trial_test.py BUILD_DIR

No person was tested: answers are computed or written here. Needs python3-numpy. Exit status 0 or 1.
"""
import contextlib
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools/trial"), str(ROOT / "tools/client")]
sys.dont_write_bytecode = True
import methods  # noqa: E402
import tact  # noqa: E402

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
LIVER = ROOT / "model/scenes/liver.toml"
NOTICED = 0.07
IS_LONG = os.environ.get("TACT_EXTENT") == "long"
SWITCHES = 1000 if IS_LONG else 100
PROTOCOL = """
name = "stiffness"
scene = "{scene}"
seed = 7
parameter = "elastic.youngs_modulus_Pa"
{more}
"""
QUEST = """
[[block]]
name = "near 5 kPa"
reference = 5000
method = "quest"
guess = 0.2
trials = 60
"""
PAIRS = """
interval_s = 0.05
[[block]]
name = "softer"
reference = 4000
method = "constant"
levels = [0.25, 0.5]
repeats = {repeats}
[[block]]
name = "stiffer"
reference = 5000
method = "constant"
levels = [-0.25]
repeats = {repeats}
"""


def settings(method, **given):
    return {key: default for key, (default, _, _) in methods.SETTINGS[method].items()} | given


def played(method, threshold, seed, probability=0.75):
    """The estimate, by an observer whose curve is that of methods.weibull."""
    rng = random.Random(seed)
    while (level := method.next()) is not None:
        method.add(level, rng.random() < methods.weibull(math.log10(level / threshold), 3.5, probability))
    return method.estimate()


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def protocol(self, more, scene=LIVER):
        path = self.folder / "protocol.toml"
        path.write_text(PROTOCOL.format(scene=scene, more=more))
        return path

    def trial(self, *arguments, answers=""):
        return subprocess.run([BUILD / "tact-trial", *map(str, arguments)], input=answers, capture_output=True, text=True,
                              env=self.environment())

    def environment(self):
        """Of a folder of its own, so that no other test's tactd is asked."""
        return os.environ | {"XDG_RUNTIME_DIR": str(self.folder)}

    def table(self, out):
        with open(self.folder / out / "task-stiffness_events.tsv", encoding="utf-8") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    def about(self, out):
        return json.loads((self.folder / out / "task-stiffness_events.json").read_text())


class Methods(unittest.TestCase):
    def test_quest_is_within_a_point_in_60_trials(self):
        found = np.array([played(methods.Quest(settings("quest", guess=0.2), None), NOTICED, seed) for seed in range(300)])
        self.assertLess(abs(np.median(found) - NOTICED), 0.003)
        self.assertGreater((abs(found - NOTICED) < 0.01).mean(), 0.8)

    def test_staircase_converges_to_70_7_percent(self):
        at = settings("staircase", start=0.3, reversals=40, trials=2000)
        found = [played(methods.Staircase(at, None), NOTICED, seed, math.sqrt(0.5)) for seed in range(100)]
        self.assertLess(abs(math.exp(np.mean(np.log(found))) / NOTICED - 1.0), 0.1)

    def test_staircase_steps_by_the_rule(self):
        stairs = methods.Staircase(settings("staircase", start=0.1, step=2.0, least=0.01, reversals=3), None)
        levels = []
        for correct in (True, True, True, False, True, True, True, True, False):
            levels.append(round(stairs.next(), 6))
            stairs.add(stairs.next(), correct)
        self.assertEqual(levels, [0.1, 0.1, 0.05, 0.05, 0.1, 0.1, 0.05, 0.05, 0.025])
        self.assertEqual([round(level, 6) for level in stairs.reversals], [0.05, 0.1, 0.025])
        self.assertIsNone(stairs.next())

    def test_constant_stimuli_find_the_curve(self):
        at = settings("constant", levels=[0.03, 0.05, 0.07, 0.1, 0.15], repeats=40)
        found = [played(methods.Constant(at, random.Random(seed)), NOTICED, seed) for seed in range(50)]
        self.assertLess(abs(np.median(found) - NOTICED), 0.003)

    def test_constant_stimuli_come_equally_often_by_the_seed(self):
        at = settings("constant", levels=[0.1, 0.2], repeats=20)
        orders = [methods.Constant(at, random.Random(seed)).levels for seed in (1, 1, 2)]
        self.assertEqual(orders[0], orders[1])
        self.assertNotEqual(orders[0], orders[2])
        self.assertEqual(sorted(orders[0]), [0.1] * 20 + [0.2] * 20)


class Simulated(Case):
    def test_the_programmed_difference_is_found_in_60_trials(self):
        done = self.trial(self.protocol(QUEST), "--out", self.folder / "a", "--simulate", NOTICED, "--ticks", 2000)
        self.assertEqual(done.returncode, 0, done.stderr)
        block = self.about("a")["tact"]["blocks"][0]
        self.assertEqual(block["trials"], 60)
        self.assertLess(abs(block["threshold_force_ratio"] - NOTICED), 0.01)
        self.assertGreater(block["threshold_ratio"], block["threshold_force_ratio"] + 0.03, "E is not the force")
        self.assertIn("no person", self.about("a")["tact"]["observer"])


class Live(Case):
    """On the real clock; what is asserted are marks, numbers and bits, no time."""

    def setUp(self):
        super().setUp()
        self.log, self.scene = self.folder / "run.tactlog", self.folder / "scene.toml"
        self.scene.write_text(LIVER.read_text().replace('"meshes/', f'"{LIVER.parent}/meshes/'))

    def tactctl(self, *words):
        return subprocess.run([BUILD / "tactctl", self.scene, *map(str, words)], capture_output=True, text=True,
                              env=self.environment())

    @contextlib.contextmanager
    def running(self):
        """A tactd that has its report and its log when it has ended."""
        tactd = subprocess.Popen([BUILD / "tactd", self.scene, "--no-black-box", "--record", self.log, "--json",
                                  self.folder / "run.json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                 env=self.environment())
        try:
            while self.tactctl("status").returncode:
                self.assertIsNone(tactd.poll(), "tactd has ended")
            yield tactd
        finally:
            tactd.terminate()
            tactd.communicate()

    def run_beside(self, protocol, answers):
        """tact-trial's end."""
        with self.running():
            return self.trial(protocol, "--out", self.folder / "out", answers=answers)

    def check_replay(self):
        replay = subprocess.run([BUILD / "tactd", self.scene, "--replay", self.log], capture_output=True, text=True)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)

    def test_marks_numbers_and_bits(self):
        repeats = 50 if IS_LONG else 2
        protocol = self.protocol(PAIRS.format(repeats=repeats), "scene.toml")
        done = self.run_beside(protocol, "x\n" + "1\n2\n" * 3 * repeats)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        rows, ticks = self.table("out"), tact.read_ticks(self.log).ticks
        self.assertEqual(len(rows), 3 * repeats)
        event = dict(zip(ticks["tick"].tolist(), ticks["event"].tolist()))
        for row in rows:
            self.assertEqual((event[int(row["tick_1"])], event[int(row["tick_2"])]), (1, 2))
            larger = int(row["comparison_interval"]) if float(row["level"]) > 0 else 3 - int(row["comparison_interval"])
            self.assertEqual(int(row["correct"]), int(int(row["response"]) == larger))
            self.assertAlmostEqual(float(row["comparison"]), float(row["reference"]) * (1 + float(row["level"])), places=6)
        self.assertEqual(int((ticks["event"] == 3).sum()), 2 * len(rows))
        self.assertEqual(int((ticks["event"] >= 4).sum()), len(rows))
        self.check_switches(ticks)
        report = json.loads((self.folder / "run.json").read_text())
        self.assertEqual(report["thread"]["allocations"], 0)
        self.check_replay()

    def test_events_of_tactctl_answer_and_are_the_marks(self):
        protocol = self.protocol(PAIRS.format(repeats=1).replace("interval_s = 0.05", ""), "scene.toml")
        trial = [BUILD / "tact-trial", protocol, "--out", self.folder / "out", "--answers", "events"]
        with self.running(), subprocess.Popen(trial, stdout=subprocess.PIPE, text=True, env=self.environment()) as trial:
            for line in trial.stdout:
                for event in (9, 5, 3) if line.startswith("interval 1") else (3,) if line.startswith("interval 2") else \
                        (3, 4) if line.startswith("Which") else ():
                    self.assertEqual(self.tactctl("event", event).returncode, 0)
            self.assertEqual(trial.wait(), 0)
        rows, ticks = self.table("out"), tact.read_ticks(self.log).ticks
        self.assertEqual([row["response"] for row in rows], ["1"] * 3, "the 5 of before the question does not count")
        self.assertEqual(self.about("out")["tact"]["observer"], "by events of tactctl")
        marks = ticks[ticks["event"] > 0]
        self.assertEqual(marks["event"].tolist(), [1, 9, 5, 3, 2, 3, 3, 4] * 3, "no mark is there twice")
        for row, end, answer in zip(rows, marks[5::8], marks[7::8]):
            self.assertAlmostEqual(float(row["response_time"]), 1e-9 * float(answer["due_ns"] - end["due_ns"]), places=6)

    def test_switches_neither_allocate_nor_step_the_force(self):
        with self.running():
            for i in range(SWITCHES):
                E_Pa = 5000 if i % 2 else 5500
                while not (said := self.tactctl("set", f"elastic.youngs_modulus_Pa={E_Pa}")).stdout.rstrip().endswith(": set"):
                    self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        ticks, report = tact.read_ticks(self.log).ticks, json.loads((self.folder / "run.json").read_text())
        self.assertEqual(int(ticks["variant"].max()), report["variants"])
        self.check_switches(ticks, SWITCHES)
        self.assertEqual((report["thread"]["allocations"], report["dropped_records"]), (0, 0))
        self.check_replay()

    def check_switches(self, ticks, least=5):
        changed = np.flatnonzero(np.diff(ticks["variant"].astype(int))) + 1
        self.assertGreaterEqual(len(changed), least)
        force_N = np.linalg.norm(ticks["wanted_force_N"], axis=1)
        self.assertEqual(float(np.abs(force_N[changed] - force_N[changed - 1]).max()), 0.0, "a force steps")

    def test_answers_that_end_early_leave_what_was_answered(self):
        done = self.run_beside(self.protocol(PAIRS.format(repeats=2), "scene.toml"), "1\n2\n")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("the answers have ended", done.stderr)
        self.assertEqual([row["response"] for row in self.table("out")], ["1", "2"])
        self.assertFalse(self.about("out")["tact"]["whole"])
        again = self.trial(self.folder / "protocol.toml", "--out", self.folder / "out", "--simulate", 0.1)
        self.assertEqual(again.returncode, 2)
        self.assertIn("is not written over", again.stderr)


class Files(Case):
    def test_table_is_that_of_bids(self):
        block = QUEST.replace("trials = 60", "trials = 2")
        done = self.trial(self.protocol(block), "--out", self.folder / "a", "--simulate", 0.1)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows, about = self.table("a"), self.about("a")
        self.assertEqual(list(rows[0])[:3], ["onset", "duration", "trial_type"])
        self.assertEqual(set(rows[0]), set(about) - {"tact"})
        self.assertTrue(all(about[name]["Description"] for name in rows[0]))
        for row in rows:
            float(row["onset"]), float(row["duration"])
            self.assertNotIn("", row.values())
        self.trial(self.protocol(block), "--out", self.folder / "b", "--simulate", 0.1)
        self.assertEqual(rows, self.table("b"), "the same seed gives the same table")

    def test_bad_protocols_say_what_to_write(self):
        for more, said in (("", "has no block"), ("colour = 1" + QUEST, "knows no colour"),
                           ("[[block]]\nname = 'a'", "has no reference"), (QUEST + "levels = [1]", "knows no levels"),
                           (QUEST.replace("quest", "guess"), "constant, staircase, quest"),
                           (QUEST.replace("guess = 0.2", ""), "needs guess, 0.001 to 10"), (QUEST + "slope = 99", "0.5 to 20"),
                           (QUEST.replace("60", "6.5"), "must be whole"), (QUEST.replace("= 5000", "= -1"), "above 0"),
                           ("interval_s = 1e9" + QUEST, "0 to 600 s"), ("order = 'any'" + QUEST, "random, as_written"),
                           ("[", "no TOML")):
            done = self.trial(self.protocol(more), "--out", self.folder / "out", "--simulate", 0.1)
            self.assertEqual(done.returncode, 2, more)
            self.assertIn(said, done.stderr, more)
            self.assertFalse((self.folder / "out").exists())
        for arguments, said in ((["--answers", "page", "--simulate", "0.1"], "leave out one"),
                                (["--socket", "x.sock"], "--answers events or page"), (["--answers", "none"], "invalid choice")):
            done = self.trial(self.protocol(QUEST), "--out", self.folder / "out", *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)
        done = self.trial(self.protocol(QUEST, "none.toml"), "--out", self.folder / "out")
        self.assertIn("no such file", done.stderr)

    def test_without_tactd_it_says_so(self):
        done = self.trial(self.protocol(QUEST), "--out", self.folder / "out")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no tactd runs", done.stderr)


if __name__ == "__main__":
    unittest.main()
