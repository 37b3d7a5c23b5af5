#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/checks/stages.sh gives a second try to tests that wait for a real clock, and to no other: each ends as it must. Stages
that run at the same time are each reported and counted; a second try has no other stage beside it, and Ctrl-C ends all.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RUN = """logs=$PWD
. "$0"
tests() { inner() { ctest_twice "$PWD" -j 2 -L "$which"; }; inner; }
begin_counts
run_stage tests
report_counts tests"""
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
    (0, "+clock", "no", "none"): (1, "0 passed, 1 failed", False),
}


# `tests` and `browser` meet, or nothing of it passes; their reports, in order, and the sum.
HEAD = """logs=$PWD long=no
. "$0"
meet() { touch "$1"; for i in {1..400}; do [ -e "$2" ] && return; sleep .05; done; return 1; }
begin_counts
"""
BESIDE = {
    """tests() { meet a b; }; browser() { meet b a; }; run_with tests browser; report_counts tests browser""":
        (0, "2 passed, 0 failed"),
    """tests() { meet a b; }; browser() { meet b a; false; }; run_with tests browser; report_counts tests browser""":
        (1, "1 passed, 1 failed"),
    """tests() { meet a b; false; }; browser() { meet b a; }; page() { :; }
run_with tests page browser; report_counts page tests browser""":
        (1, "2 passed, 1 failed"),
    """build() { false; }; format() { :; }; tests() { after_build true; touch tried; }; browser() { after_build true; }
run_with build format; run_with tests browser; test ! -e tried && report_counts build format tests browser""":
        (1, "1 passed, 3 failed"),
    # a stage that never ran
    """tests() { :; }; run_with tests page; report_counts tests page browser""": (1, "1 passed, 2 failed"),
    # each tries once more, when the other has ended or waits, too
    """try() { [ ! -e one ] || echo both >>broken; touch one; sleep .3; rm one; }
tests() { meet a b; once_more tests try; }; browser() { meet b a; once_more browser try; sleep .3; touch ended; }
other() { sleep .2; touch alone; }; tests2() { meet c d; once_more slow test -e ended2; }
browser2() { meet d c; sleep .5; touch ended2; }
run_with tests browser; run_with tests2 browser2; report_counts tests browser tests2 browser2; test ! -e broken""":
        (0, "4 passed, 0 failed"),
    # what takes the time that others leave prevents no second try
    """slow() { sleep 30; }; tests() { once_more quick true; }
run_beside --idle slow; lane=$!; run_stage tests; kill $(descendants $lane) $lane; report_counts tests""":
        (0, "1 passed, 0 failed"),
}
INTERRUPTED = """trap 'kill $(descendants $$) 2>/dev/null; exit 130' INT TERM
deep() { bash -c 'trap "" INT; (sleep 300.25 & wait) & wait'; }
tests() { deep; }; page() { deep; }; browser() { :; }
run_with tests page browser"""


def play(command, folder):
    return subprocess.Popen(["bash", "-c", HEAD + command, ROOT / "tools/checks/stages.sh"], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def beside_breaches():
    for command, wanted in BESIDE.items():
        with tempfile.TemporaryDirectory() as folder, play(command, folder) as bash:
            output = bash.communicate(timeout=60)[0]
        ended = (bash.returncode, next((line for line in reversed(output.splitlines()) if " passed, " in line), ""))
        if ended != wanted:
            yield f"tools/checks/stages.sh:1: {command}: {ended}, not {wanted}\n{output}"


def children(pid):
    """None of a process that has ended."""
    try:
        texts = [file.read_text() for file in pathlib.Path(f"/proc/{pid}/task").glob("*/children")]
    except OSError:
        texts = []
    for child in map(int, " ".join(texts).split()):
        yield from (child, *children(child))


def is_running(pid):
    """Neither gone nor a zombie that was not reaped."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def interrupt_breaches():
    with tempfile.TemporaryDirectory() as folder, play(INTERRUPTED, folder) as bash:
        for _ in range(400):
            started = list(children(bash.pid))
            if sum("sleep\x00300.25" in command_line(pid) for pid in started) == 2:
                break
            time.sleep(0.05)
        bash.send_signal(signal.SIGTERM)
        if bash.wait(timeout=60) != 130:
            yield f"tools/checks/stages.sh:1: interrupted, it ends with {bash.returncode}"
    time.sleep(0.2)
    if len(started) < 6 or any(map(is_running, started)):
        yield f"tools/checks/stages.sh:1: of {len(started)} processes some outlive an interrupt"


def command_line(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_text()
    except OSError:
        return ""


def try_breaches():
    for (fails, label, long, which), wanted in ENDS.items():
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "CTestTestfile.cmake").write_text(COUNTS.format(fails=fails, label=label))
            command = f"long={long} which={which}\n{RUN}"
            done = subprocess.run(["bash", "-c", command, ROOT / "tools/checks/stages.sh"], cwd=folder, text=True,
                                  capture_output=True, check=False)
        lines = done.stdout.splitlines()
        ended = (done.returncode, lines[-1] if lines else "", 'flaky: Suite.Waits/"a"' in lines)
        if ended != wanted:
            yield (f"tools/checks/stages.sh:1: fails {fails} times, label {label or 'none'}, long {long}: {ended}, not {wanted}"
                   f"\n{done.stdout}{done.stderr}")


def main():
    found = [*try_breaches(), *beside_breaches(), *interrupt_breaches()]
    print(*found, sep="\n", end="\n" if found else "")
    print(f"stages: {len(ENDS) + len(BESIDE)} ends, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
