#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tree: what is at the top, how large a file may be, and that every stage of
tools/check runs in a workflow.

Prints every breach as file: sentence. Exit status 0 or 1.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOP = {"CMakeLists.txt", "LICENSE", "README.md", "firmware", "hal", "host", "model", "tests", "tools"}
MAX_BYTES = 1_000_000
PUSH, NIGHT = ".github/workflows/check.yml", ".github/workflows/nightly.yml"


def top_breaches(paths):
    for name in sorted({path.split("/", 1)[0] for path in paths}):
        if name not in TOP and not name.startswith("."):
            yield f"{name}: does not belong at the top: {' '.join(sorted(TOP))} and files that begin with a dot"


def size_breaches(bytes_of):
    for path, size in bytes_of.items():
        if size > MAX_BYTES:
            yield f"{path}: {size} bytes, {MAX_BYTES} at most: make it by a command, or keep its numbers alone"


def stages_of(check):
    """Of tools/check: those of each push, and those that --all and --long add."""
    lists = dict(re.findall(r"^(quick|more|hours)='([^']*)'$", check, re.M))
    return {name: set(words.split()) for name, words in lists.items()}


WHOLE = {"tests", "browser"}  # stages of each push that are whole with --only alone


def stage_breaches(check, push, night):
    stages = stages_of(check)
    if set(stages) != {"quick", "more", "hours"}:
        yield "tools/check: its lists of stages are not where this test looks for them"
        return
    if not re.search(r"^\s*- run: \./tools/check \$\{\{ matrix.arguments \}\}$", push, re.M):
        yield f"{PUSH}: does not run ./tools/check with its arguments"
    found = re.search(r'^\s*arguments: \["", ([^\]]*)\]', push, re.M)
    pushed = {name.removeprefix("--only ") for name in re.split(r",\s*", found[1])} if found else set()
    for name in sorted((stages["more"] | WHOLE) ^ pushed):
        yield f"{PUSH}: --only {name}: its list is not that of ./tools/check --all"
    if "./tools/check --long --only ${{ matrix.stage }}" not in night:
        yield f"{NIGHT}: does not run ./tools/check --long --only STAGE"
    found = re.search(r"^\s*stage: \[([^\]]*)\]", night, re.M)
    nightly = set(re.split(r",\s*", found[1])) if found else set()
    wanted = stages["more"] | stages["hours"] | WHOLE
    for name in sorted(wanted - nightly):
        yield f"{NIGHT}: does not run the stage {name} of tools/check"
    for name in sorted(nightly - wanted):
        yield f"{NIGHT}: {name} is no stage of tools/check --long"


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    check = "quick='format tests browser'\nmore='asan'\nhours='soak'\n"
    push = '        arguments: ["", --only tests, --only browser, --only asan]\n' \
           '      - run: ./tools/check ${{ matrix.arguments }}\n'
    run = "      - run: ./tools/check --long --only ${{ matrix.stage }}\n"
    night = "        stage: [tests, browser, asan, soak]\n" + run
    cases = {
        "an unlisted file": top_breaches(["README.md", "notes.txt"]),
        "an unlisted folder": top_breaches(["scratch/a.cc"]),
        "a large file": size_breaches({"model/a.obj": MAX_BYTES + 1}),
        "a push without check": stage_breaches(check, "- run: true\n", night),
        "a stage that no night runs": stage_breaches(check, push, "        stage: [asan]\n" + run),
        "a night without its stage": stage_breaches(check, push, "        stage: [tests, browser, asan, soak, tsan]\n" + run),
        "a night without --long": stage_breaches(check, push, night.replace("--long ", "")),
        "a push without asan": stage_breaches(check, push.replace(", --only asan", ""), night),
        "lists that moved": stage_breaches("", push, night)}
    blind = [name for name, found in cases.items() if not list(found)]
    for name, found in {"a tree in order": top_breaches([".gitignore", "LICENSE", "hal/can/a.cc"]),
                        "stages in order": stage_breaches(check, push, night)}.items():
        blind += [f"takes for a breach: {name}: {breach}" for breach in found]
    return blind


def main():
    listed = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    paths = [path for path in listed.stdout.split("\0") if (ROOT / path).is_file()]
    found = [*top_breaches(paths), *size_breaches({path: (ROOT / path).stat().st_size for path in paths}),
             *stage_breaches(*((ROOT / name).read_text() for name in ("tools/check", PUSH, NIGHT)))]
    found += [f"tests/house/tree_test.py: a breach of this rule is not seen: {rule}" for rule in blind_rules()]
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    print(f"tree: {len(paths)} files, {len(found)} breaches")
    if len(paths) < 500:
        print("tree: too few files: the check does not see the tree")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
