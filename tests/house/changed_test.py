#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/checks/changed.sh leaves out no test that something has changed for: on a scratch tree, programs of one line, each kind
of change asks for the tests that it must. A commit alone asks for none. And no test reads a text that counts for none.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# ninja's part, played: what is another configuration's is not reported.
ASK = """root=$PWD build=$PWD/build again=yes
tracked() { git -C "$root" "$@"; }
. "$0"
built_programs() { (cd build; find * -perm -u+x -type f ! -name 'tact-old*' | sort); }
"""
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
UNREAD = re.compile(r"\b(?:README|CHANGELOG|CONTRIBUTING|decisions)\.md\"|host/web/(?!src/link/records)")


def is_program(name):
    return name.startswith("build/") and not name.endswith((".txt", ".ninja"))


def write(folder, name, is_new=False, revision="1a2b3c"):
    """A file as it was when the stage passed, or as it is since; a program prints the revision."""
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    changed = "changed" if is_new else "as it was"
    text = f'DEFINES = TACT_GIT_REVISION="\\"{revision}\\\\0"' if name.endswith(".ninja") else f"{changed} {revision:\0<20}"
    file.write_text(text if is_program(name) or name.endswith(".ninja") else changed)
    file.chmod(0o755 if is_program(name) else 0o644)
    os.utime(file, (3000, 3000) if is_new else (1000, 1000))


def ask(folder, command):
    return subprocess.run(["bash", "-euc", ASK + command, ROOT / "tools/checks/changed.sh"], cwd=folder, capture_output=True,
                          text=True, check=True).stdout.strip()


def scratch_tree(folder):
    """Everything as it was when the stage passed: the names of its files."""
    names = {name for names in CHANGES for name in names if not name.startswith("new_")} | {"build/build.ninja"}
    for name in names:
        write(folder, name)
    (folder / "tools/checks").mkdir(exist_ok=True)
    (folder / "tools/checks/program_digests.py").write_text((ROOT / "tools/checks/program_digests.py").read_text())
    for room, programs in (("model_law", ""), ("firmware_gate", "tactd")):
        (folder / f"build/tests/{room}_test.programs").write_text(programs + "\n")
    (folder / ".gitignore").write_text("build/\n")
    for name in (".gitignore", "tools/checks/program_digests.py"):
        os.utime(folder / name, (1000, 1000))
    subprocess.run(["git", "-C", folder, "init", "-q"], check=True)
    subprocess.run(["git", "-C", folder, "add", *(["model", "host", "tools"])], check=True)
    return names


def breaches():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        names = scratch_tree(folder)
        if (output := ask(folder, "changed_tests")) != ".":
            yield f"tools/checks/changed.sh:1: nothing has passed yet: tries '{output}', not all"
        ask(folder, "begin_stage tests \"$(program_digests)\"; pass_stage tests")
        os.utime(folder / "build/passed.tests", (2000, 2000))
        for newer, wanted in CHANGES.items():
            for file in newer:
                write(folder, file, is_new=True)
            if (output := ask(folder, "changed_tests")) != wanted:
                yield f"tools/checks/changed.sh:1: {', '.join(newer) or 'nothing'} is newer: tries '{output}', not '{wanted}'"
            for file in newer:
                write(folder, file)
            for file in set(newer) - names:
                (folder / file).unlink()
        for file in filter(lambda name: name.startswith("build/"), names):
            write(folder, file, revision="1a2b3c-dirty")
        if output := ask(folder, "changed_tests"):
            yield f"tools/checks/changed.sh:1: only the revision is another: tries '{output}', not nothing"
        if ask(folder, "program_changed tests tactd && echo yes || echo no; newer_of tests model/law/law.h") != "no":
            yield "tools/checks/changed.sh:1: a program or a file counts as changed that is not"
        for file in ("build/tactd", "model/law/law.h"):
            write(folder, file, is_new=True)
        if ask(folder, "program_changed tests tactd && newer_of tests model/law/law.h") != "model/law/law.h":
            yield "tools/checks/changed.sh:1: a program or a file that has changed does not count"
    for path in sorted([*ROOT.glob("tests/**/*.cc"), *ROOT.glob("tests/**/*.h"), *ROOT.glob("tests/tools/**/*.py")]):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if UNREAD.search(line.split("//")[0]):
                yield (f"{path.relative_to(ROOT)}:{number}: reads a text that tools/checks/changed.sh takes for one that no "
                       "test reads")


def main():
    found = list(breaches())
    print(*found, sep="\n", end="\n" if found else "")
    print(f"changed: {len(CHANGES)} kinds of changes, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
