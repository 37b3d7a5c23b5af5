#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether the longest path is one, on a small program, and whether tactd keeps its bounds.

usage: tests/proof/bound/bound_test.py [tactd]
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import counts  # noqa: E402
from machine import Code, Refused  # noqa: E402
from path import Longest, Program  # noqa: E402
from source import Lines, Source  # noqa: E402

ROOT = HERE.parents[2]
TACTD = sys.argv.pop() if len(sys.argv) > 1 and not sys.argv[-1].startswith("-") else None
SMALL = """
volatile int a[64];
__attribute__((noinline)) int leaf(int x) { return a[x & 63] * x; }
__attribute__((noinline)) int triangle(int n) {
  int sum = 0;
  for (int i = 0; i < n; ++i) {  // bound: rows
    // bound: rows; pairs in all
    for (int j = 0; j <= i; ++j) {
      sum += leaf(j);
    }
    sum -= 3;
  }
  return sum;
}
__attribute__((noinline)) int choice(int n) {
  switch (n) {
    case 0: return 5;
    case 1: return leaf(1) + 2;
    case 2: return leaf(2) + leaf(3);
    case 3: return leaf(4) * 2;
    case 4: return leaf(7) - 1;
    default: return 0;
  }
}
__attribute__((noinline)) int entry(int n) { return triangle(n) + choice(n); }
int main(void) { int all = 0; for (int n = 0; n <= 8; ++n) all += entry(n); return all == 1; }
"""
PAIRS = {"rows": 8, "pairs": 36}


@unittest.skipUnless(shutil.which("valgrind"), "needs valgrind")
class Small(unittest.TestCase):
    """A program of which each path can be counted."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def build(self, text):
        source, self.path = pathlib.Path(self.folder.name, "small.c"), pathlib.Path(self.folder.name, "small")
        source.write_text(text)
        subprocess.run(["gcc", "-O2", "-g1", source, "-o", self.path], check=True)

    def program(self, names, entry="entry"):
        code, lines = Code(self.path), Lines(self.path, self.folder.name)
        self.addCleanup(lines.close)
        start = next(at for at in code.lines if code.name(at) == entry)

        def unknown(function, at):
            raise Refused(f"an indirect call in {function.name} at {at:#x}")
        program = Program(code, lines, Source(self.folder.name, names), unknown, lambda name: 0)
        program.reach({start: None})
        return program, start

    def seen(self):
        return list(counts.dumps([self.path], "entry", self.folder.name))

    def refused(self, text, names=PAIRS):
        self.build(text)
        with self.assertRaises(Refused) as refused:
            program, start = self.program(names)
            Longest(program, start)
        return str(refused.exception)

    def test_bound_is_no_less_than_any_run_and_near_it(self):
        self.build(SMALL)
        program, start = self.program(PAIRS)
        longest = max(sum(run.objects.values()) for run in self.seen())
        bound = Longest(program, start).bound
        self.assertGreaterEqual(bound, longest)
        self.assertLess(bound, 1.3 * longest)

    def test_run_keeps_right_bounds(self):
        self.build(SMALL)
        program, _ = self.program(PAIRS)
        self.assertEqual([], [wrong for run in self.seen() for wrong in counts.complaints(program, run)])

    def test_bound_that_is_too_small_is_found_in_a_run(self):
        self.build(SMALL)
        program, _ = self.program({"rows": 6, "pairs": 21})
        wrong = [wrong for run in self.seen() for wrong in counts.complaints(program, run)]
        self.assertTrue(any("small.c:6: bound rows" in text for text in wrong), wrong)

    def test_loop_without_bound_is_refused_by_line(self):
        self.assertIn("small.c:6", self.refused(SMALL.replace("  // bound: rows\n", "\n")))

    def test_inner_loop_without_bound_is_refused(self):
        self.assertIn("no bound", self.refused(SMALL.replace("    // bound: rows; pairs in all\n", "\n")))

    def test_unknown_name_in_a_bound_is_refused(self):
        self.assertIn("rows", self.refused(SMALL, {"pairs": 36}))

    def test_recursion_is_refused(self):
        self.assertIn("recursion", self.refused(SMALL.replace(
            "return a[x & 63] * x;", "return x ? leaf(x / 2) * a[x & 63] + 1 : 0;")
            .replace("int leaf(int x) {", "int leaf(int x) { asm volatile(\"\");")))

    def test_call_through_a_pointer_is_refused(self):
        text = SMALL.replace("int main", "int (*volatile any)(int) = leaf;\nint main").replace(
            "__attribute__((noinline)) int entry", "extern int (*volatile any)(int);\n__attribute__((noinline)) int entry")
        self.assertIn("indirect call", self.refused(text.replace("+ choice(n);", "+ choice(n) + any(n);")))


class Committed(unittest.TestCase):
    """The table of firmware/README.md."""

    def test_bound_is_no_less_than_the_longest_on_the_bench(self):
        seen = json.loads((ROOT / "tests/data/bench_baseline.json").read_text())["back_ends"]
        for bench, phases in json.loads((ROOT / "tests/data/tick_bounds.json").read_text()).items():
            for phase, bound in phases.items():
                self.assertGreaterEqual(bound, seen[bench][phase]["longest_ns"], f"{bench}: {phase}")

    @unittest.skipUnless(TACTD, "needs a tactd")
    def test_tactd_keeps_its_bounds(self):
        subprocess.run([sys.executable, HERE / "run", "--program", TACTD, "--check"], check=True)


if __name__ == "__main__":
    unittest.main()
