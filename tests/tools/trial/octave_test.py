#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The QUEST of tact-trial gives the thresholds of Psychtoolbox's QUEST, in Octave, for the same answers.

    python3 tests/tools/trial/octave_test.py BUILD_DIR

Needs octave and octave-psychtoolbox-3. Exit status 0 or 1.
"""
import math
import pathlib
import random
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/trial"))
sys.dont_write_bytecode = True
import methods  # noqa: E402

PSYCHTOOLBOX, SEQUENCES, TRIALS, TOLERANCE = "/usr/share/psychtoolbox-3/Quest", 40, 60, 0.02


class Quest(unittest.TestCase):
    def test_thresholds_are_those_of_psychtoolbox(self):
        own, script = [], [f"addpath('{PSYCHTOOLBOX}');"]
        for seed in range(SEQUENCES):
            rng = random.Random(seed)
            guess, slope, probability = rng.uniform(0.05, 0.5), rng.uniform(2.0, 5.0), rng.uniform(0.7, 0.9)
            truth = guess * 10.0**rng.uniform(-0.4, 0.4)
            settings = {key: value[0] for key, value in methods.SETTINGS["quest"].items()}
            quest = methods.Quest(settings | {"guess": guess, "slope": slope, "probability": probability, "most": 10.0}, None)
            script.append(f"q = QuestCreate({math.log10(guess):.17g}, {settings['guess_sd_log10']}, {probability:.17g}, "
                          f"{slope:.17g}, {methods.SLIP}, {methods.GUESS}, {quest.GRID}, {2 * quest.SIDE * quest.GRID});")
            for _ in range(TRIALS):
                level = quest.next()
                correct = rng.random() < methods.weibull(math.log10(level / truth), slope, probability)
                quest.add(level, correct)
                script.append(f"q = QuestUpdate(q, {math.log10(level):.17g}, {int(correct)});")
            own.append((quest.estimate(), quest.sd()))
            script.append("printf('%.17g %.17g\\n', QuestMean(q), QuestSd(q));")
        octave = subprocess.run(["octave-cli", "--no-init-file", "--quiet"], input="\n".join(script), capture_output=True,
                                text=True)
        self.assertEqual(octave.returncode, 0, octave.stderr)
        theirs = [tuple(map(float, line.split())) for line in octave.stdout.splitlines()]
        self.assertEqual(len(theirs), SEQUENCES, octave.stderr)
        worst = max(abs(threshold / 10.0**mean - 1.0) for (threshold, _), (mean, _) in zip(own, theirs))
        print(f"worst of {SEQUENCES} thresholds after {TRIALS} answers: {100.0 * worst:.2f} % from Psychtoolbox's")
        self.assertLess(worst, TOLERANCE)
        self.assertLess(max(abs(sd - other) for (_, sd), (_, other) in zip(own, theirs)), 0.005)


if __name__ == "__main__":
    sys.argv[1:] = sys.argv[2:]
    unittest.main()
