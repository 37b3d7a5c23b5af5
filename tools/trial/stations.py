# SPDX-License-Identifier: Apache-2.0
"""Where the intervals of a trial are presented: at the tactd that runs, or to an observer that is simulated."""
import math
import pathlib
import random
import re
import subprocess
import tempfile
import time

import numpy as np
import tact
from answers import END, MARKS
from methods import weibull
from protocol import Wrong


class Running:
    """The tactd that runs the scene, by tactctl; `answers` is a source of answers.py."""

    def __init__(self, protocol, tactctl, answers, show):
        self.protocol, self.tactctl, self.answers, self.show = protocol, [*tactctl, str(protocol.scene)], answers, show
        self.begun_ns = None
        self.ask("status")

    def ask(self, *words):
        """What tactd answers; a refusal is an error."""
        done = subprocess.run([*self.tactctl, *words], capture_output=True, text=True)
        if done.returncode:
            raise Wrong(f"tactctl {self.protocol.scene} {' '.join(words)}: {(done.stderr or done.stdout).strip()}")
        return done.stdout.strip()

    def use(self, values):
        """These numbers of the law, in use when it returns: the loop takes them while the tool is out of contact."""
        words = [f"{key}={value:.9g}" for key, value in values.items()]
        asked = False
        while not self.ask("set", *words).endswith(": set"):
            if not asked:
                self.show("lift the tool out of the tissue")
            asked = True

    def mark(self, name):
        """The tick that carries the mark, and s since the first mark."""
        now_ns = time.monotonic_ns()
        self.begun_ns = self.begun_ns or now_ns
        said = self.ask("event", str(MARKS[name]))
        found = re.search(r"in tick (\d+)", said)
        if not found:
            raise Wrong(f"tactctl {self.protocol.scene} event: answered {said!r}, which names no tick")
        return int(found[1]), 1e-9 * (now_ns - self.begun_ns)

    def heard(self, *wanted):
        """A word of a person, and s since the first mark."""
        word, at_ns = self.answers.next(wanted)
        if at_ns is not None:  # its mark is in the log
            return word, 1e-9 * (at_ns - self.begun_ns)
        return word, self.mark("interval_end" if word == END else f"answer_{word}")[1]

    def interval(self, number, values):
        self.use(values)
        tick, onset_s = self.mark(f"interval_{number}")
        self.answers.ready()
        self.show(f"interval {number}" + ("" if self.protocol.interval_s else f": {self.answers.how_to_end}"))
        if self.protocol.interval_s:
            time.sleep(self.protocol.interval_s)
            _, end_s = self.mark("interval_end")
        else:
            _, end_s = self.heard(END)
        return {"tick": tick, "onset_s": onset_s, "end_s": end_s}

    def answer(self, intervals):
        """1 or 2, and s since the last interval."""
        self.answers.ready()
        self.show(self.protocol.question)
        said, at_s = self.heard("1", "2")
        return int(said), at_s - intervals[-1]["end_s"]

    def pause(self):
        time.sleep(self.protocol.pause_s)

    def force_ratio(self, block, level):
        """Of a person's hand it is in the tick log."""
        return None


class Simulated:
    """An observer without a person. It answers by the forces of the scene's own hand, from a log that tactd --replay has found
    to be the same bit for bit: right with the probability of a Weibull curve, at `threshold` more force with `probability`."""

    def __init__(self, protocol, tactd, threshold, ticks, slope=3.5, probability=0.75):
        self.protocol, self.tactd, self.threshold, self.ticks = protocol, tactd, threshold, ticks
        self.slope, self.probability, self.known = slope, probability, {}
        self.random, self.at_s = random.Random(f"observer {protocol.seed}"), 0.0

    def force_N(self, values):
        """RMS of the force over the run, in simulated time."""
        words = tuple(f"{key}={value:.9g}" for key, value in values.items())
        if words not in self.known:
            with tempfile.TemporaryDirectory() as folder:
                log = pathlib.Path(folder, "run.tactlog")
                sets = [word for each in words for word in ("--set", each)]
                self.run(self.protocol.scene, *sets, "--free-run", "--ticks", self.ticks, "--no-telemetry", "--no-black-box",
                         "--record", log)
                self.run(self.protocol.scene, "--replay", log)
                self.known[words] = float(np.sqrt((tact.read_ticks(log).ticks["force_N"]**2).sum(axis=1).mean()))
        return self.known[words]

    def run(self, *arguments):
        done = subprocess.run([*self.tactd, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode:
            raise Wrong(f"tactd {' '.join(map(str, arguments))}: {(done.stderr or done.stdout).strip()[-300:]}")

    def interval(self, number, values):
        force_N, onset_s = self.force_N(values), self.at_s
        self.at_s += 1.0
        return {"tick": "n/a", "onset_s": onset_s, "end_s": self.at_s, "force_N": force_N}

    def answer(self, intervals):
        first, second = (interval["force_N"] for interval in intervals)
        if min(first, second) <= 0.0:
            raise Wrong(f"{self.protocol.scene}: its hand finds no force in {self.ticks} ticks; give more by --ticks")
        more = abs(math.log(second / first))
        stronger = 2 if second > first else 1
        share = weibull(math.log10(more / math.log1p(self.threshold)), self.slope, self.probability) if more > 0.0 else 0.5
        return (stronger if self.random.random() < share else 3 - stronger), 0.0

    def pause(self):
        self.at_s += self.protocol.pause_s

    def force_ratio(self, block, level):
        """How much more force the level gives than the reference."""
        values = ({**block.set, self.protocol.parameter: block.reference * more} for more in (1.0 + level, 1.0))
        return self.force_N(next(values)) / self.force_N(next(values)) - 1.0
