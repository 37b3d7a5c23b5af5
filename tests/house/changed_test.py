#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/changed.sh leaves out no test that something has changed for: on a scratch tree with programs that are empty files,
each kind of change asks for the tests that it must. And no test reads a text that counts for none.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# ninja's part, played: programs are their own objects; what is another configuration's is not told.
ASK = """root=$PWD build=$PWD/build
tracked() { git -C "$root" "$@"; }
. "$0"
built_programs() { (cd build; find * -perm -u+x -type f ! -name 'tact-old*' | sort); }
objects_of() { printf "$build/%s\\n" "$@"; }
changed_tests"""
LAW, GATE, SCRIPTS = "^(model_law)([+]|$)", "^(firmware_gate)([+]|$)", "[+]programs"
# A file that is newer than the last pass, and what must be tried then.
CHANGES = {
    (): "",
    ("build/tests/model_law_test",): LAW,
    ("build/tests/model_law_test", "build/tests/firmware_gate_test"): "^(firmware_gate|model_law)([+]|$)",
    ("build/tactd",): f"{GATE}|{SCRIPTS}",  # which the tests of firmware_gate run
    ("build/libtact-stub-dhd.so", "build/tests/model_law_test"): f"{LAW}|{SCRIPTS}",
    ("build/install_manifest.txt",): "",
    ("build/tact-old",): "",  # of another configuration
    ("model/law/law.h",): "",  # its programs are newer as soon as they are built
    ("model/scenes/liver.toml",): ".",
    ("host/PROTOCOL.md",): ".",
    ("tools/run",): ".",
    ("new_and_not_tracked.json",): ".",
    ("model/README.md",): "",
    ("host/web/src/main.ts",): "",
}
UNREAD = re.compile(r"\b(?:README|CHANGELOG|CONTRIBUTING|decisions)\.md\"|host/web/")


def asked(folder, newer, passed=True):
    """What changed_tests tells of a tree where these files are newer than the last pass."""
    for name in {name for names in CHANGES for name in names if not name.startswith("new_")} | set(newer):
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("")
        file.chmod(0o755 if name.startswith("build/") and not name.endswith(".txt") else 0o644)
        os.utime(file, (3000, 3000) if name in newer else (1000, 1000))
    for room, programs in (("model_law", ""), ("firmware_gate", "tactd")):
        (folder / f"build/tests/{room}_test.programs").write_text(programs + "\n")
    (folder / ".gitignore").write_text("build/\n")
    os.utime(folder / ".gitignore", (1000, 1000))
    subprocess.run(["git", "-C", folder, "init", "-q"], check=True)
    subprocess.run(["git", "-C", folder, "add", *(["model", "host", "tools"])], check=True)
    if passed:
        (folder / "build/passed.tests").write_text("")
        os.utime(folder / "build/passed.tests", (2000, 2000))
    return subprocess.run(["bash", "-euc", ASK, ROOT / "tools/changed.sh"], cwd=folder, capture_output=True, text=True,
                          check=True).stdout.strip()


def breaches():
    for newer, wanted in CHANGES.items():
        with tempfile.TemporaryDirectory() as folder:
            told = asked(pathlib.Path(folder), newer)
            if told != wanted:
                yield f"tools/changed.sh:1: {', '.join(newer) or 'nothing'} is newer: tries '{told}', not '{wanted}'"
    with tempfile.TemporaryDirectory() as folder:
        if (told := asked(pathlib.Path(folder), (), passed=False)) != ".":
            yield f"tools/changed.sh:1: nothing has passed yet: tries '{told}', not all"
    for path in sorted([*ROOT.glob("tests/**/*.cc"), *ROOT.glob("tests/**/*.h"), *ROOT.glob("tests/tools/**/*.py")]):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if UNREAD.search(line.split("//")[0]):
                yield f"{path.relative_to(ROOT)}:{number}: reads a text that tools/changed.sh takes for one that no test reads"


def main():
    found = list(breaches())
    print(*found, sep="\n", end="\n" if found else "")
    print(f"changed: {len(CHANGES)} kinds of changes, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
