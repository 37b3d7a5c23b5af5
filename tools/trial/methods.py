# SPDX-License-Identifier: Apache-2.0
"""Which comparison comes next: constant stimuli, a staircase, QUEST. None knows of tact.

A level is the comparison over the reference less 1: 0.07 is 7 % more; of constant stimuli it may be below 0. Each method has
next(), a level or None at the end, add(level, correct), and estimate(), of the threshold, or None.
"""
import math

import numpy as np


class Constant:
    """Each level equally often, in random order. estimate(): the Weibull curve of greatest likelihood at `probability`."""

    def __init__(self, settings, random):
        self.levels = [level for level in settings["levels"] for _ in range(settings["repeats"])]
        random.shuffle(self.levels)
        self.answers, self.probability, self.slope = [], settings["probability"], settings["slope"]

    def next(self):
        return self.levels[len(self.answers)] if len(self.answers) < len(self.levels) else None

    def add(self, level, correct):
        self.answers.append((level, correct))

    def estimate(self):
        if not self.answers:
            return None
        level = np.array([abs(level) for level, _ in self.answers])
        correct = np.array([correct for _, correct in self.answers])
        tried = np.geomspace(0.2 * level.min(), 5.0 * level.max(), 2000)
        share = weibull(np.log10(level[None] / tried[:, None]), self.slope, self.probability)
        return float(tried[np.log(np.where(correct, share, 1.0 - share)).sum(axis=1).argmax()])


class Staircase:
    """One up, two down: harder after two right answers in a row, easier after a wrong one; converges to 70.7 % right
    [Levitt, J. Acoust. Soc. Am. 49 (1971) 467]. estimate(): geometric mean of the levels at the last even number of reversals.
    """

    def __init__(self, settings, random):
        self.level, self.step, self.least = settings["start"], settings["step"], settings["least"]
        self.most_reversals, self.dropped = settings["reversals"], settings["dropped_reversals"]
        self.most_trials, self.trials, self.right, self.way, self.reversals = settings["trials"], 0, 0, 0, []

    def next(self):
        return self.level if len(self.reversals) < self.most_reversals and self.trials < self.most_trials else None

    def add(self, level, correct):
        self.trials += 1
        self.right = self.right + 1 if correct else 0
        way = -1 if self.right == 2 else 0 if correct else 1
        if way == 0:
            return
        if self.way and way != self.way:
            self.reversals.append(level)
        self.right, self.way = 0, way
        self.level = max(self.least, self.level * self.step**way)

    def estimate(self):
        kept = self.reversals[self.dropped:]
        kept = kept[len(kept) % 2:]
        return math.exp(sum(map(math.log, kept)) / len(kept)) if kept else None


class Quest:
    """The posterior of the threshold T = log10 of a level, Gauss prior, Weibull curve
    [Watson and Pelli, Percept. Psychophys. 33 (1983) 113]; the next level is its mean [King-Smith et al., Vision Res. 34 (1994)].

        p(x) = delta gamma + (1 - delta) (1 - (1 - gamma) exp(-10^(beta (x - T + e))))
    x log10 of the level; beta slope; gamma share of guessing; delta share of slips; e such that p(T) = probability.
    """
    GRID = 0.01  # log10
    SIDE = 250  # of the grid, to either side of the guess

    def __init__(self, settings, random):
        self.slope, self.probability, self.trials = settings["slope"], settings["probability"], settings["trials"]
        self.most, self.count = settings["most"], 0
        away = self.GRID * np.arange(-self.SIDE, self.SIDE + 1)
        self.threshold = math.log10(settings["guess"]) + away
        self.log_posterior = -0.5 * (away / settings["guess_sd_log10"])**2

    def mean(self):
        share = np.exp(self.log_posterior - self.log_posterior.max())
        return float(share @ self.threshold / share.sum())

    def sd(self):
        share = np.exp(self.log_posterior - self.log_posterior.max())
        return float(math.sqrt(share @ (self.threshold - self.mean())**2 / share.sum()))

    def next(self):
        """On the grid, so that few levels are prepared."""
        at = self.GRID * round(self.mean() / self.GRID)
        return min(self.most, 10.0**at) if self.count < self.trials else None

    def add(self, level, correct):
        share = weibull(math.log10(abs(level)) - self.threshold, self.slope, self.probability)
        self.log_posterior += np.log(share if correct else 1.0 - share)
        self.count += 1

    def estimate(self):
        return 10.0**self.mean()


GUESS, SLIP = 0.5, 0.01  # gamma of two intervals, delta


def weibull(log_ratio, slope, probability):
    """Share of right answers at log10 of level over threshold, at which it is `probability`."""
    at_threshold = -math.log((1.0 - (probability - SLIP * GUESS) / (1.0 - SLIP)) / (1.0 - GUESS))
    rate = at_threshold * 10.0**(slope * np.asarray(log_ratio))
    return SLIP * GUESS + (1.0 - SLIP) * (1.0 - (1.0 - GUESS) * np.exp(-rate))


METHODS = {"constant": Constant, "staircase": Staircase, "quest": Quest}
# Each setting with default (None: needed), least and most.
SETTINGS = {
    "constant": {"levels": (None, 1e-3, 10.0), "repeats": (10, 1, 1000), "probability": (0.75, 0.55, 0.98),
                 "slope": (3.5, 0.5, 20)},
    "staircase": {"start": (None, 1e-3, 10.0), "step": (1.26, 1.01, 4.0), "least": (0.005, 1e-4, 1.0), "reversals": (8, 2, 100),
                  "dropped_reversals": (2, 0, 50), "trials": (100, 1, 10000)},
    "quest": {"guess": (None, 1e-3, 10.0), "guess_sd_log10": (0.3, 0.01, 3.0), "trials": (60, 1, 10000),
              "most": (1.0, 1e-3, 10.0), "probability": (0.75, 0.55, 0.98), "slope": (3.5, 0.5, 20)}}
