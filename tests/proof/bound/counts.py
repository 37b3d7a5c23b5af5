# SPDX-License-Identifier: Apache-2.0
"""What a run has executed, by callgrind: one dump for each time that a function was entered. A loop that went round
more often than its bound, a call that went elsewhere than allowed, or a path longer than the bound is a complaint."""
import collections
import pathlib
import re
import subprocess
import tempfile

from loops import entering

JUMP = re.compile(r"^j(?:ump|cnd)=(\d+)(?:/(\d+))? (\S+)")


class Counts:
    """Of one dump: executions of each instruction and of each jump, calls of each instruction."""

    def __init__(self, text, program):
        self.times = collections.Counter()
        self.taken = collections.Counter()
        self.called = collections.Counter()
        self.objects = collections.Counter()  # instructions by program or library
        own, after_call, jump, file = False, False, None, ""
        for line in text.splitlines():
            if line.startswith("ob="):
                file = line[3:]
                own = pathlib.Path(file).name == program
            elif line.startswith("calls="):
                words = line.split()
                after_call = (int(words[0][6:]), int(words[1], 16))
            elif line.startswith("j"):
                match = JUMP.match(line)
                jump = (int(match[1]), int(match[3], 16)) if match else None
            elif line.startswith("0x"):
                words = line.split()
                at = int(words[0], 16)
                if after_call:
                    if own:
                        self.called[at, after_call[1]] += after_call[0]
                    after_call = False
                elif jump:
                    if own:
                        self.taken[at, jump[1]] += jump[0]
                    jump = None
                else:
                    self.objects[file] += int(words[2])
                    if own:
                        self.times[at] += int(words[2])

    def edge(self, function, block, after):
        """How often control went from a block to the next one."""
        tail = function.block[block][-1]
        afters = function.edges[block]
        if len(afters) == 1:
            return self.times[tail]
        if (tail, after) in self.taken or len(afters) != 2:
            return self.taken[tail, after]
        other = next(a for a in afters if a != after)
        return self.times[tail] - self.taken[tail, other]


def dumps(command, function, folder):
    """Runs a command under callgrind; a Counts for each time that `function` was entered."""
    with tempfile.TemporaryDirectory(dir=folder) as out:
        done = subprocess.run(["valgrind", "--tool=callgrind", "--dump-instr=yes", "--collect-jumps=yes",
                               "--compress-strings=no", "--compress-pos=no", f"--dump-before={function}",
                               f"--dump-after={function}", f"--toggle-collect={function}",
                               f"--callgrind-out-file={out}/dump", *map(str, command)],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{command[0]} failed under valgrind\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
        name = pathlib.Path(command[0]).name
        for path in sorted(pathlib.Path(out).glob("dump.*")):
            counts = Counts(path.read_text(), name)
            if counts.times:
                yield counts


def complaints(program, counts):
    """Loops that went round more often than their bound in this dump."""
    wrong = []
    for entry, function in program.functions.items():
        entered = counts.times[entry] - sum(counts.edge(function, b, entry) for b, afters in function.edges.items()
                                            if entry in afters)
        for loop in program.loops[entry]:
            back = sum(counts.edge(function, *edge) for edge in loop.back)
            edges, begins = entering(entry, function.edges, loop)
            came = sum(counts.edge(function, *edge) for edge in edges) + (entered if begins else 0)
            bound = program.bounds[entry][loop.header]
            each = program.passes(entry, loop)
            if back > each * came:
                wrong.append(f"{bound.file}:{bound.first}: bound {bound.each}, {each:g} ways back, but {back} passes after "
                             f"{came} entries ({function.name})")
        for at in function.calls:
            for bound in program.limits[at]:
                if counts.times[at] > program.source.value(bound.each, bound.file) * entered:
                    wrong.append(f"{bound.file}:{bound.first}: bound {bound.each}, but {counts.times[at]} calls in {entered}")
    for (at, target), times in counts.called.items():
        known = program.targets.get(at)
        if known is not None and times and all(isinstance(t, int) for t in known) and target not in known:
            wrong.append(f"the call at {at:#x} went to {target:#x}, which is not among its targets")
    return wrong
