#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/stages.sh gives a second try to tests that wait for a real clock, and to no other: each ends as it must.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RUN = """logs=$PWD
. "$0"
tests() { inner() { ctest_twice "$PWD" -j 2 -L "$which"; }; inner; }
begin_counts
run_stage tests
tell_counts tests"""
# Fails as often as it says, then passes.
COUNTS = """add_test(Suite.Waits/"a" sh "-c" "echo >>tries; test $(wc -l <tries) -gt {fails}")
set_tests_properties(Suite.Waits/"a" PROPERTIES LABELS room{label})
add_test(Suite.Good true)
set_tests_properties(Suite.Good PROPERTIES LABELS room)
"""
# (how often it fails, its label, --long, whose label is asked for): exit status, the sum, is it called flaky?
ENDS = {
    (0, "+clock", "no", "."): (0, "2 passed, 0 failed", False),
    (1, "+clock", "no", "."): (0, "2 passed, 0 failed", True),
    (2, "+clock", "no", "."): (1, "1 passed, 1 failed", False),
    (1, "+clock", "yes", "."): (1, "1 passed, 1 failed", False),
    (1, "", "no", "."): (1, "1 passed, 1 failed", False),
    (0, "+clock", "no", "nobody"): (1, "0 passed, 1 failed", False),
}


def main():
    found = []
    for (fails, label, long, which), wanted in ENDS.items():
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "CTestTestfile.cmake").write_text(COUNTS.format(fails=fails, label=label))
            command = f"long={long} which={which}\n{RUN}"
            done = subprocess.run(["bash", "-c", command, ROOT / "tools/stages.sh"], cwd=folder, text=True,
                                  capture_output=True, check=False)
        lines = done.stdout.splitlines()
        ended = (done.returncode, lines[-1] if lines else "", 'flaky: Suite.Waits/"a"' in lines)
        if ended != wanted:
            found.append(f"tools/stages.sh:1: fails {fails} times, label {label or 'none'}, long {long}: {ended}, not {wanted}"
                         f"\n{done.stdout}{done.stderr}")
    print(*found, sep="\n", end="\n" if found else "")
    print(f"stages: {len(ENDS)} ends of a test, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
