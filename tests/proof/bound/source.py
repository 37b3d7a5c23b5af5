# SPDX-License-Identifier: Apache-2.0
"""Loop bounds written in the source, and which loop of the machine code each of them is about.

    // bound: 3 (axes)                       at most 3 passes each time that the loop is entered
    // bound: count; pairs in all (i < j)    and at most `pairs` each time that the loop around it is entered
    // bound: 1 a call (by the state)        the calls in this statement: each at most once in a call of its function

The comment is above the loop or at its end of line; above a statement it is about the loops that the compiler
makes of that statement, such as those of std::copy. A bound is a number or an expression in constants of the source
and in what the case gives, such as the number of spheres.
"""
import collections
import pathlib
import re
import subprocess

from loops import parent
from machine import Refused

MARK = re.compile(r"//\s*bound:\s*([^;()]+?)(?:;\s*([^()]+?)\s+in all)?\s*(?:\(.*\))?\s*$")
A_CALL = " a call"
CONSTANT = re.compile(r"constexpr\s+[\w:]+\s+(k\w+)\s*=\s*([\w\s+*/'-]+);")
TRIVIA = re.compile(r"//.*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])+'")

LOOP = re.compile(r"^\s*(?:\} *else *)?(?:for|while|do)\b")

# `each` is None for a loop without a bound
Bound = collections.namedtuple("Bound", "file first head last each whole")


class Source:
    """The bounds of a source tree."""

    def __init__(self, root, names):
        self.root, self.files, self.used = pathlib.Path(root).resolve(), {}, set()
        self.names = dict(names)
        self.constants = {}

    def value(self, expression, file):
        """Of a bound, in passes."""
        names = {**self.constants_of(file), **self.names}
        try:
            return float(eval(expression.removesuffix(A_CALL), {"__builtins__": {"min": min, "max": max}}, names))  # noqa: S307
        except Exception as wrong:
            raise Refused(f"{file}: bound {expression}: {wrong}") from None

    def constants_of(self, file):
        """Of that file and of the headers that it includes."""
        if file in self.constants:
            return self.constants[file]
        found = self.constants[file] = {}
        path = self.root / file
        text = path.read_text() if path.is_file() else ""
        for header in re.findall(r'#include "([^"]+)"', text):
            found.update(self.constants_of(header))
        own = {}
        for name, expression in CONSTANT.findall(text):
            try:
                value = eval(expression.replace("'", ""), {"__builtins__": {}}, {**found, **own})  # noqa: S307
            except Exception:
                continue
            own[name] = value if own.get(name, value) == value else None  # two of one name: neither
        found.update(own)
        return found

    def bounds_of(self, file):
        """Of a file: its bounds, and its loops without one."""
        if file not in self.files:
            path = self.root / file
            lines = path.read_text().splitlines() if path.is_file() and not file.startswith("/") else []
            found = [self.bound(file, lines, k, match) for k, line in enumerate(lines)
                     for match in [MARK.search(line)] if match]
            known = {b.first for b in found}
            for k, line in enumerate(lines):
                if LOOP.match(line) and k + 1 not in known:
                    found.append(Bound(file, k + 1, *(1 + n for n in extent(lines, k)), None, None))
            self.files[file] = found
        return self.files[file]

    def bound(self, file, lines, k, match):
        first = k
        while not TRIVIA.sub("", lines[first]).strip():
            first += 1
        head, last = extent(lines, first)
        return Bound(file, first + 1, head + 1, last + 1, match[1].strip(), match[2])

    def chain(self, frames):
        """The loops and bounds around an instruction, from the outermost to the innermost."""
        found = []
        for file, line in frames:
            within = [b for b in self.bounds_of(file)
                      if b.first <= line <= b.last and not (b.each or "").endswith(A_CALL)]
            found += sorted(within, key=lambda b: (-b.first, b.last))
        return found[::-1]

    def of_call(self, frames):
        """The bounds of calls in whose statements a call is."""
        return [b for file, line in frames for b in self.bounds_of(file)
                if b.first <= line <= b.last and (b.each or "").endswith(A_CALL)]


def extent(lines, first):
    """Last line of a loop's head and of its body, or of a statement."""
    depth, head, is_loop, seen = 0, None, None, ""
    for k in range(first, len(lines)):
        for c in TRIVIA.sub("", lines[k]):
            seen += c
            if is_loop is None and not (seen[-1].isalnum() or seen[-1] in "_ "):
                is_loop = seen[:-1].strip() in ("for", "while", "do")
            if c in "([{":
                depth += 1
            elif c in ")]}":
                depth -= 1
                if depth < 0:
                    return (head if head is not None else k), k
                if depth == 0 and c == ")" and is_loop and head is None:
                    head = k
                elif depth == 0 and c == "}" and is_loop and head is not None:
                    return head, k
            elif c == ";" and depth == 0:
                return (head if head is not None else k), k
        seen += " "
    raise Refused(f"line {first + 1}: no end")


class Lines:
    """From addresses to (file, line), the innermost first, inlined callers after it."""

    def __init__(self, program, root):
        self.root, self.known = str(pathlib.Path(root).resolve()) + "/", {}
        self.tool = subprocess.Popen(["addr2line", "-a", "-i", "-e", str(program)], text=True,
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def close(self):
        self.tool.communicate()

    def load(self, addresses):
        wanted = sorted(set(addresses) - set(self.known))
        if not wanted:
            return
        self.tool.stdin.write("".join(f"{at:#x}\n" for at in [*wanted, 0]))  # 0: the end of the answers
        self.tool.stdin.flush()
        frames, text = None, None
        while True:
            text = self.tool.stdout.readline()
            if text.startswith("0x"):
                at = int(text, 16)
                if at == 0:
                    self.tool.stdout.readline()
                    return
                frames = self.known[at] = []
                continue
            file, _, number = text.partition(" (")[0].strip().rpartition(":")
            if number.isdigit() and int(number):
                frames.append((file.removeprefix(self.root), int(number)))

    def at(self, address):
        return self.known[address]


def match_loops(function, found, lines, source):
    """{header: Bound}: which bound each loop of a function has. One without is refused by file and line."""
    lines.load(at for loop in found for head in loop.blocks for at in function.block[head])
    bounds, wrong = {}, []
    for loop in found:  # outer ones first
        inner = set().union(*(o.blocks for o in found if o.blocks < loop.blocks))
        own = [at for head in loop.blocks - inner for at in function.block[head]]
        around = parent(loop, found)
        taken = bounds.get(around.header) if around else None
        best = innermost(common_start([source.chain(lines.at(at)) for at in own if lines.at(at)]))
        if best is None or best == taken:  # a few instructions of other lines are among them
            best = by_jumps(function, loop, own, lines, source)
        mixed = not loop.is_plain and any(best in chain[:-1] for chain in (source.chain(lines.at(at)) for at in own))
        if best is None or best == taken or mixed:
            wrong.append(describe(function, loop, lines, own))
        bounds[loop.header] = best
    if wrong:
        raise Refused("\n".join(wrong))
    return bounds


def innermost(chain):
    """The last of a chain, if it has a bound."""
    return chain[-1] if chain and chain[-1].each else None


def by_jumps(function, loop, own, lines, source):
    """The loop in which the jumps back are, if nearly all of its other instructions are, too."""
    tails = [function.block[block][-1] for block, _ in loop.back]
    best = innermost(common_start([source.chain(lines.at(at)) for at in tails]))
    within = sum(best in source.chain(lines.at(at)) for at in own)
    return best if best and within >= 0.8 * len(own) else None


def common_start(chains):
    common = chains[0] if chains else []
    for chain in chains:
        common = common[:next((k for k, (a, b) in enumerate(zip(common, chain)) if a != b), min(len(common), len(chain)))]
    return common


def describe(function, loop, lines, own):
    where = collections.Counter(frame for at in own for frame in lines.at(at))
    text = ", ".join(f"{file}:{line}" for (file, line), _ in where.most_common(6))
    return f"no bound: loop at {loop.header:#x} in {function.name}: {text or 'no line is known'}"
