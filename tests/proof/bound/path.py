# SPDX-License-Identifier: Apache-2.0
"""The longest path as a linear program (implicit path enumeration).

A variable counts how often each edge of each function is taken in the whole phase; what enters a block leaves it; a
function is entered as often as its callers call it; the edges back to a loop's header are taken at most `bound` times
for each time that the loop is entered. Whole numbers are not required, which can only make the result larger.
"""
import collections

import numpy
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

from loops import entering, loops, parent
from machine import Function, Refused
from source import match_loops


class Program:
    """What an entry reaches. `resolve(function, address, lines)` names the targets of an indirect call, `cost(name)`
    the instructions of an imported function; None: the call does not return, and no path passes it."""

    def __init__(self, code, lines, source, resolve, cost):
        self.code, self.lines, self.source = code, lines, source
        self.resolve, self.cost = resolve, cost
        self.functions, self.loops, self.bounds = {}, {}, {}
        self.targets, self.limits, self.wrong = {}, {}, []

    def reach(self, entries):
        """`entries`: {address: address of the call at which it ends, or None}"""
        waiting = list(entries)
        while waiting:
            entry = waiting.pop()
            if entry in self.functions:
                continue
            function = self.functions[entry] = Function(self.code, entry, entries.get(entry))
            try:
                found = loops(entry, function.edges, function.name)
                self.loops[entry] = found
                self.bounds[entry] = match_loops(function, found, self.lines, self.source)
            except Refused as wrong:
                self.wrong.append(str(wrong))
            for at, target in function.calls.items():
                targets = self.targets_of(function, at, target)
                self.targets[at] = targets
                self.lines.load([at])
                self.limits[at] = self.source.of_call(self.lines.at(at))
                waiting += [t for t in targets if isinstance(t, int)]
        if self.wrong:
            raise Refused("\n".join(self.wrong))
        self.refuse_recursion(entries)

    def passes(self, entry, loop):
        """How often control may go back to the header for each time that the loop is entered. Where a loop is left at
        its end alone, the first pass needs no way back."""
        bound = self.bounds[entry][loop.header]
        each = self.source.value(bound.each, bound.file)
        edges = self.functions[entry].edges
        ends = {block for block, _ in loop.back}
        left = {block for block in loop.blocks if not loop.blocks.issuperset(edges[block])}
        return max(each - 1.0, 0.0) if left <= ends else each

    def in_body(self, entry, at, block):
        """The loop in whose body a call is, or None: there it is made once a pass."""
        around = [loop for loop in self.loops[entry] if block in loop.blocks]
        if not around:
            return None
        loop = min(around, key=lambda o: len(o.blocks))
        bound, frames = self.bounds[entry][loop.header], self.lines.at(at)
        chain = self.source.chain(frames)
        is_body = any(file == bound.file and bound.head < line <= bound.last for file, line in frames)
        return loop if is_body and chain and chain[-1] == bound else None

    def targets_of(self, function, at, target):
        try:
            if target is None:
                return self.resolve(function, at)
            return [target]
        except Refused as wrong:
            self.wrong.append(str(wrong))
            return []

    def refuse_recursion(self, entries):
        state = {}
        calls = {entry: sorted({t for at in f.calls for t in self.targets[at] if isinstance(t, int)})
                 for entry, f in self.functions.items()}
        for start in entries:
            stack = [(start, iter(calls[start]))]
            state[start] = 1
            while stack:
                here, rest = stack[-1]
                for callee in rest:
                    if state.get(callee) == 1:
                        raise Refused(f"recursion: {self.functions[here].name} calls {self.functions[callee].name}")
                    if callee not in state:
                        state[callee] = 1
                        stack.append((callee, iter(calls[callee])))
                        break
                else:
                    state[here] = 2
                    stack.pop()


class Longest:
    """The linear program of one entry, and its solution."""

    def __init__(self, program, entry):
        self.program, self.entry = program, entry
        self.variable, self.cost = {}, []
        self.rows = {"equal": [], "least": []}
        self.build()
        self.solve()

    def var(self, key, cost=0.0):
        if key not in self.variable:
            self.variable[key] = len(self.cost)
            self.cost.append(cost)
        return self.variable[key]

    def build(self):
        entries = {self.entry: [(self.var("root"), 1.0)]}
        self.rows["equal"].append(([(self.var("root"), 1.0)], 1.0))
        for entry in self.callers_first():
            self.add_function(entry, entries)

    def callers_first(self):
        order, seen = [], set()

        def visit(entry):
            seen.add(entry)
            function = self.program.functions[entry]
            for at in function.calls:
                for target in self.program.targets[at]:
                    if isinstance(target, int) and target not in seen:
                        visit(target)
            order.append(entry)
        visit(self.entry)
        return order[::-1]

    def add_function(self, entry, entries):
        function, self.later = self.program.functions[entry], []
        entered = entries.get(entry, [])
        into = collections.defaultdict(list)
        out = collections.defaultdict(list)
        for block, afters in function.edges.items():
            for after in afters or ["exit"]:
                v = self.var((entry, block, after))
                out[block].append(v)
                into[after].append((v, block))
        for block, body in function.block.items():
            count = self.var((entry, block), function.length(block))
            self.rows["equal"].append(([(count, 1.0)] + [(v, -1.0) for v in out[block]], 0.0))
            came = [(v, -1.0) for v, _ in into[block]]
            if block == entry:
                came += [(v, -factor) for v, factor in entered]
            self.rows["equal"].append(([(count, 1.0)] + came, 0.0))
            for at in body:
                if at in function.calls:
                    self.add_call(entry, block, at, entries, entered)
        for loop in self.program.loops[entry]:
            self.add_loop(entry, loop, entered)
        for count, each, loop in self.later:
            self.rows["least"].append(([(count, 1.0)] + [(v, -each * f) for v, f in self.entering(entry, loop, entered)], 0.0))
            self.add_whole(entry, loop, entered, [(count, 1.0)])

    def add_call(self, entry, block, at, entries, entered):
        count = self.variable[(entry, block)]
        targets = self.program.targets[at]
        choices = []
        for target in targets:
            figure = None if isinstance(target, int) else self.program.cost(target)
            if not isinstance(target, int) and figure is None:
                continue  # does not return
            v = self.var((at, target), figure or 0.0)
            choices.append((v, -1.0))
            if isinstance(target, int):
                entries.setdefault(target, []).append((v, 1.0))
        self.rows["equal"].append(([(count, 1.0)] + choices, 0.0))
        for bound in self.program.limits[at]:
            most = self.program.source.value(bound.each, bound.file)
            self.rows["least"].append(([(count, 1.0)] + [(v, -most * f) for v, f in entered], 0.0))
        loop = self.program.in_body(entry, at, block)
        if loop:
            bound = self.program.bounds[entry][loop.header]
            self.later.append((count, self.program.source.value(bound.each, bound.file), loop))

    def entering(self, entry, loop, entered):
        edges, begins = entering(entry, self.program.functions[entry].edges, loop)
        return [(self.variable[(entry, *edge)], 1.0) for edge in edges] + (list(entered) if begins else [])

    def add_loop(self, entry, loop, entered):
        back = [(self.variable[(entry, *edge)], 1.0) for edge in loop.back]
        each = self.program.passes(entry, loop)
        self.rows["least"].append((back + [(v, -each * f) for v, f in self.entering(entry, loop, entered)], 0.0))
        self.add_whole(entry, loop, entered, back)

    def add_whole(self, entry, loop, entered, counted):
        """Of what is counted, the passes of a loop for each time that the loop around it is entered."""
        bound, around = self.program.bounds[entry][loop.header], parent(loop, self.program.loops[entry])
        if bound.whole is None or around is None:
            return
        whole = self.program.source.value(bound.whole, bound.file)
        self.rows["least"].append((counted + [(v, -whole * f) for v, f in self.entering(entry, around, entered)], 0.0))

    def solve(self):
        matrices = {kind: self.matrix(rows) for kind, rows in self.rows.items()}
        least, most = matrices["least"], matrices["equal"]
        done = linprog(-numpy.array(self.cost), A_ub=least[0], b_ub=least[1], A_eq=most[0], b_eq=most[1],
                       bounds=(0, None), method="highs")
        if done.status != 0:
            raise Refused(f"no longest path: {done.message}")
        self.bound = int(numpy.floor(-done.fun + 1e-6 * max(1.0, -done.fun)))
        self.count = done.x

    def matrix(self, rows):
        if not rows:
            return None, None
        where = [(k, v, f) for k, (terms, _) in enumerate(rows) for v, f in terms]
        return (csr_matrix(([f for *_, f in where], ([k for k, *_ in where], [v for _, v, _ in where])),
                           shape=(len(rows), len(self.cost))), [right for _, right in rows])

    def shares(self):
        """{function or imported name: (times, instructions)} on the longest path."""
        shares = {}
        for key, v in self.variable.items():
            if not isinstance(key, tuple) or self.count[v] < 1e-6:
                continue
            if len(key) == 2 and self.cost[v]:
                name = key[1] if isinstance(key[1], str) else self.program.functions[key[0]].name
                times = self.count[v] if isinstance(key[1], str) or key[0] == key[1] else 0
                old = shares.get(name, (0, 0))
                shares[name] = (old[0] + times, old[1] + self.count[v] * self.cost[v])
        return shares
