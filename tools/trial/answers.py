# SPDX-License-Identifier: Apache-2.0
"""How a person answers: by lines, by events of tactctl, or by keys of the page. None of them moves anything.

Each source has ready(), from which on an answer counts, and next(wanted): one of the words of `wanted` and when it was given,
ns of CLOCK_MONOTONIC; None: now, and no mark of it is in the tick log yet. Words are "1", "2" and END, of an interval.
"""
import queue
import subprocess
import threading

import tact
from protocol import Wrong

END = "end"
MARKS = {"interval_1": 1, "interval_2": 2, "interval_end": 3, "answer_1": 4, "answer_2": 5}


class Lines:
    """Lines of a stream, also of a pedal that types. They may be typed ahead."""
    by, how_to_end = "lines", "a line (Enter) ends it"

    def __init__(self, lines, show):
        self.lines, self.show = lines, show

    def ready(self):
        pass

    def line(self):
        line = self.lines.readline()
        if not line:
            raise Wrong("the answers have ended before the protocol; what was answered is in the table")
        return line.strip()

    def next(self, wanted):
        while (said := self.line()) not in wanted:
            if END in wanted:
                return END, None
            self.show(f"answer {' or '.join(wanted)}")
        return said, None

    def close(self):
        pass


class Keys(Lines):
    """Digits that a person types at the page of a tact-view that it starts; what that one says otherwise is shown."""
    by, how_to_end = "keys of the page", "any digit ends it"

    def __init__(self, tact_view, show):
        super().__init__(None, show)
        self.keys = queue.Queue()
        self.viewer = subprocess.Popen([*tact_view, "--keys", "--port", "0"], stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self.follow, daemon=True).start()

    def follow(self):
        for line in self.viewer.stdout:
            word, _, key = line.strip().partition(" ")
            if word == "key":
                self.keys.put(key)
            else:
                self.show(line.strip())
        self.keys.put(None)

    def ready(self):
        while not self.keys.empty():
            if self.keys.get() is None:
                self.keys.put(None)
                return

    def line(self):
        key = self.keys.get()
        if key is None:
            raise Wrong("tact-view has ended; what was answered is in the table")
        return key

    def close(self):
        self.viewer.terminate()
        self.viewer.wait()


class Events:
    """tactctl SCENE event N, with the number of the mark: it is the mark. A frame of telemetry has the newest one."""
    by, how_to_end = "events of tactctl", f"tactctl SCENE event {MARKS['interval_end']} ends it"
    WORDS = {MARKS["interval_end"]: END, MARKS["answer_1"]: "1", MARKS["answer_2"]: "2"}

    def __init__(self, socket):
        self.run, self.before_ns = tact.live(socket, newest=True), 0

    def newest(self):
        for frame in self.run:
            return int(frame["event"]["number"]), int(frame["event"]["due_ns"])
        raise Wrong("tactd has ended; what was answered is in the table")

    def ready(self):
        _, self.before_ns = self.newest()

    def next(self, wanted):
        while True:
            number, due_ns = self.newest()
            if due_ns != self.before_ns and self.WORDS.get(number) in wanted:
                return self.WORDS[number], due_ns

    def close(self):
        self.run.close()
