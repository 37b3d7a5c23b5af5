# SPDX-License-Identifier: Apache-2.0
"""What a case is, and one run of it. The cases themselves are the tables in cases/*.py."""
import dataclasses
import functools
import importlib
import json
import pathlib

HERE = pathlib.Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]


@dataclasses.dataclass(frozen=True, eq=False)
class BackEnd:
    """A device that tactd can drive in the guest, and its other side."""
    name: str
    settings: tuple = ()        # KEY=VALUE of the scene
    sections: str = ""          # that its file needs besides
    options: tuple = ()         # of every program that opens it
    setup: str = ""             # bash, before tactd
    programs: tuple = ()        # of the build, besides tactd
    system_calls: dict = dataclasses.field(default_factory=dict)  # call: at most so many a tick
    scene: str = "model/scenes/liver.toml"

    @property
    def bus(self):
        """Of drives on CAN "can", of another device its own name: a Falcon is a bus of its own."""
        return "can" if any(setting.startswith('device.kind="can-') for setting in self.settings) else self.name

    @property
    def hand_meets(self):
        """The scene and its settings without the device: the same law, pressed by hands that do much the same."""
        return self.scene, tuple(setting for setting in self.settings if not setting.startswith("device."))


@dataclasses.dataclass(frozen=True, eq=False)
class Case:
    """One sentence that must stay true, a bash script for the guest, and what proves it."""
    name: str
    message: str
    back_end: BackEnd
    script: str                 # bash; see guest/bench.sh for what it may call
    checks: tuple = ()          # functions of a Run; each returns a list of complaints
    seeds: tuple = (1,)         # one run each; the same seed twice must give the same bits
    sweep: bool = False         # seeds 1..N, N from the command line
    fault: object = None        # a row of the fault table, see bench/faults.py
    seconds: float = 10.0       # of tactd, in guest time
    wall_limit_s: float = 300.0
    timed: bool = False         # phases against the baseline, wake-ups against measure_peer's
    long_only: bool = False     # its like runs on another back end; both with --long
    variables: dict = dataclasses.field(default_factory=dict)  # for the script and the set-up
    files: object = tuple       # a function without parameters: (host file, name below /tact) that this case alone needs

    @property
    def settings(self):
        """KEY=VALUE of the scene."""
        # A fault does not depend on the place, and tactd starts in half the time, which a guest spends mostly on it.
        is_even = self.fault is not None and not self.timed and self.back_end.scene == BackEnd.scene
        return (*self.back_end.settings, "varies_by_place=false") if is_even else self.back_end.settings

    def guest_script(self, seed):
        """The whole text that bash runs in the guest."""
        settings = list(self.settings)
        # One instruction is one nanosecond here, far slower than a PC: the scene's budget is for a PC.
        if "tick_budget_us" in (ROOT / self.back_end.scene).read_text():
            settings.append("tolerance.tick_budget_us=450")
        device = " ".join([*self.back_end.options, *(f"--set '{setting}'" for setting in settings)])
        variables = "".join(f'{name}="{value}"\n' for name, value in self.variables.items())
        return (f". /tact/guest/bench.sh\nSEED={seed} SECONDS_OF_RUN={self.seconds}\n"
                f"SCENE=/tact/{self.back_end.scene}\nadd_sections <<'END'\n{self.back_end.sections}END\n"
                f"DEVICE=({device})\n{variables}shift_phase\n{self.back_end.setup}\n{self.script}\n")


@dataclasses.dataclass
class Run:
    """A case with one seed, and what its guest left."""
    case: Case
    seed: int
    outcome: object
    complaints: list = dataclasses.field(default_factory=list)

    def text(self, name):
        return self.outcome.file.get(name, "")

    @functools.cached_property
    def report(self):
        """tactd's report; empty when it left none."""
        return parse(self.text("report.json"))

    @functools.cached_property
    def ticks(self):
        """What tact-rig-ticks read out of the tick log."""
        return parse(self.text("ticks.json"))

    @functools.cached_property
    def emulator(self):
        """What the device on the other side saw; empty without one."""
        return parse(self.text("emulator.json"))

    @functools.cached_property
    def gate(self):
        """What tact-rig-gate measured; empty where it did not run."""
        return parse(self.text("gate.json"))

    @functools.cached_property
    def jitter(self):
        """What tact-jitter measured; empty where it did not run."""
        return parse(self.text("jitter.json"))

    @functools.cached_property
    def late(self):
        """What tact-jitter late named; empty where it did not run."""
        return parse(self.text("late.json"))

    @functools.cached_property
    def threads(self):
        """{(FIFO thread, what): how often}, as the kernel's tracing counted; empty without it."""
        rows = [line.split() for line in self.text("threads.txt").splitlines()]
        return {(thread, what): int(count) for thread, what, count in rows}

    @property
    def name(self):
        return f"{self.case.name}, seed {self.seed}"


def parse(text):
    try:
        return json.loads(text)
    except ValueError:
        return {}


def all_cases():
    """Of every table in cases/, in the order of the file names."""
    found = []
    for path in sorted((HERE / "cases").glob("*.py")):
        if path.stem != "__init__":
            found += importlib.import_module(f"cases.{path.stem}").CASES
    names = [case.name for case in found]
    assert len(set(names)) == len(names), "two cases have the same name"
    return found
