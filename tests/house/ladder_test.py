#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The patches of .github/ladder/, which CONTRIBUTING.md walks through, apply to this tree.

Prints every breach as file: sentence. Exit status 0 or 1. With --compile, g++ also reads each source
that a patch changes, in a copy of the tree, and the folder that tools/run configures there has every
target of both. With --build, the commands of the guide are run in this tree, on top of tools/run.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NAMES = ("hello_law.patch", "hello_device.patch")


def refusal(patch):
    """What git says to a patch that does not apply; nothing when it does."""
    output = subprocess.run(["git", "-c", "safe.directory=*", "apply", "--check", "--whitespace=error", str(patch)],
                            cwd=ROOT, capture_output=True, text=True)
    return output.stderr.strip() if output.returncode else ""


def breaches():
    guide = (ROOT / ".github/CONTRIBUTING.md").read_text()
    for name in NAMES:
        patch = ROOT / ".github/ladder" / name
        if f"(ladder/{name})" not in guide:
            yield f".github/CONTRIBUTING.md: no link to ladder/{name}"
        if not patch.is_file():
            yield f".github/ladder/{name}: no such file"
        elif refused := refusal(patch):
            yield f".github/ladder/{name}: {refused}: apply what is left of it by hand, and make it again with git diff"


def not_compiled():
    """In a copy of the tree, each patch after the other: the sources that g++ refuses."""
    # What no C++ source reads, and what another stage may write meanwhile.
    unread = shutil.ignore_patterns("node_modules", "dist", "*.obj", "faults.json*", "__pycache__")
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for top in ("firmware", "hal", "host", "model", "tests", "tools"):
            shutil.copytree(ROOT / top, copy / top, ignore=unread)
        for name in NAMES:
            patch = ROOT / ".github/ladder" / name
            subprocess.run(["git", "apply", "--include=*/*", str(patch)], cwd=copy, check=True, capture_output=True)
            for source in re.findall(r"^\+\+\+ b/(\S+\.cc)$", patch.read_text(), re.M):
                output = subprocess.run(["g++", "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I.", source],
                                        cwd=copy, capture_output=True, text=True)
                if output.returncode:
                    yield f".github/ladder/{name}: {output.stderr.strip()}"
        yield from not_declared(copy)


def not_declared(copy):
    """Targets of the guide that are not in the folder that tools/run configures; ninja itself builds nothing."""
    for name in ("CMakeLists.txt", ".git", ".github"):
        (copy / name).symlink_to(ROOT / name)
    configured = subprocess.run(
        ["bash", "-c", 'root=$PWD; . tools/packages.sh; ninja() { :; }; build_programs "$root/build" tactd'],
        cwd=copy, capture_output=True, text=True)
    if configured.returncode:
        yield f"tools/packages.sh: {configured.stderr.strip()}"
        return
    for command in commands():
        for words in re.findall(r"ninja -C build ([\w ]+)", command):
            output = subprocess.run(["ninja", "-C", "build", "-n", *words.split()], cwd=copy, capture_output=True, text=True)
            if output.returncode:
                yield f".github/CONTRIBUTING.md: after tools/run, {(output.stdout + output.stderr).strip().splitlines()[-1]}"


def commands():
    """The blocks of the guide that apply a patch, build, run, and take it back."""
    guide = (ROOT / ".github/CONTRIBUTING.md").read_text()
    return [block for block in re.findall(r"^```\n(.*?)^```", guide, re.S | re.M) if "git apply .github/ladder/" in block]


def not_built():
    for block in commands():
        output = subprocess.run(["bash", "-exc", block], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if output.returncode:
            yield f".github/CONTRIBUTING.md: {output.stdout[-2000:].strip()}"


def is_blind():
    """A patch of a line that the tree does not have must be refused."""
    with tempfile.NamedTemporaryFile("w", suffix=".patch") as patch:
        patch.write("--- a/README.md\n+++ b/README.md\n@@ -1 +1 @@\n-# no such line\n+# x\n")
        patch.flush()
        return not refusal(patch.name)


def main():
    found = list(breaches())
    if sys.argv[1:] == ["--compile"] and not found:
        found += not_compiled()
    if sys.argv[1:] == ["--build"] and not found:
        found += not_built()
    if is_blind():
        found.append("a patch that does not apply is not seen")
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    print(f"ladder: {len(NAMES)} patches, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
