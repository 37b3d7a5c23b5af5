#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No two files say the same at length: the longest run of tokens that two of them share, regardless of names and
numbers, is shorter than LIMITS has it, or the pair is EXCUSED with its reason.

Runs Debian's sim_c++ (similarity-tester) on the C++ without its #include lines and prints every breach as file:line:
sentence. A file is not held against itself: what repeats there is a table. Exit status 0 or 1.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SHIPPED, TESTS = ("model", "hal", "firmware", "host", "tools"), ("tests",)
# Tokens that two files may share. Below, two tables of keys or of columns look alike; and tests begin alike.
LIMITS = {SHIPPED: 100, TESTS: 200}
# Pairs that share more, the tokens of all such runs together, and why that is no function of its own.
EXCUSED = {
    ("model/contact/moved_contact.h", "model/contact/rest_contact.h"):
        (140, "declare the same interface, two forms of an organ; each override is one line"),
    ("hal/force_dimension/sdk_library.cc", "hal/phantom/hd_library.cc"):
        (203, "tables of names: functions of two libraries"),
}
INCLUDE = re.compile(r"^[ \t]*#include[^\n]*", re.M)
# "a.cc: line 8-45|b.cc: line 9-43[193]"
RUN = re.compile(r"(\S+): line (\d+)-\d+\s*\|(\S+): line (\d+)-\d+\s*\[(\d+)\]")


def runs_in(texts, limit):
    """(tokens, a, line, b, line) of every run of `limit` tokens or more that two files share; a before b."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in texts.items():
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(INCLUDE.sub("", text))
        names = "".join(f"{path}\n" for path in sorted(texts))
        listed = subprocess.run(["sim_c++", "-i", "-s", "-n", "-T", "-r", str(limit)], input=names, cwd=folder,
                                capture_output=True, text=True, check=True)
    for a, line_a, b, line_b, tokens in RUN.findall(listed.stdout):
        yield (int(tokens), *sorted(((a, int(line_a)), (b, int(line_b)))))


def breaches(texts, limit, excused):
    shared = {}
    for tokens, (a, line), (b, other_line) in runs_in(texts, limit):
        shared[a, b] = shared.get((a, b), 0) + tokens
        if (a, b) not in excused:
            yield f"{a}:{line}: shares {tokens} tokens with {b}:{other_line}: make it one function of both"
    for (a, b), (tokens, _) in excused.items():
        if (a, b) not in shared:
            yield f"{a}:1: shares no {limit} tokens with {b}: take the pair off the list of the excused"
        elif shared[a, b] > tokens:
            yield f"{a}:1: shares {shared[a, b]} tokens with {b}, excused {tokens}: make it one function of both"


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    def body(name, count, terms="x * 3 + y"):
        return f"double {name}(double x, double y) {{\n" + count * f"  y += {terms};\n" + "  return y;\n}\n"
    one, long, other = body("f", 8), body("f", 12), body("f", 8, "x / (y - 2.0)")
    renamed = body("g", 8).replace("x", "depth_m").replace("3", "12")
    twice = {"a.cc": one + other, "b.cc": "int i;\n" + one, "c.cc": one + "int i;\n" + other}
    pair, limit = ("a.cc", "b.cc"), 60
    reason = (80, "a reason")
    includes = "".join(f'#include "model/{name}.h"\n' for name in "abcdefghijklmnop")
    cases = {
        "a clone": breaches({"a.cc": one, "b.cc": one}, limit, {}),
        "a clone with other names and numbers": breaches({"a.cc": one, "b.cc": renamed}, limit, {}),
        "a clone in two folders": breaches({"hal/b/a.h": one, "host/a.cc": "int i;\n" + one}, limit, {}),
        "a clone of three": breaches(twice, limit, {pair: reason, ("b.cc", "c.cc"): reason}),
        "an excuse without a clone": breaches({"a.cc": one, "b.cc": other}, limit, {pair: reason}),
        "an excuse of a file that is none": breaches({"a.cc": one}, limit, {pair: reason}),
        "more than is excused": breaches({"a.cc": long, "b.cc": long}, limit, {pair: reason})}
    blind = [name for name, found in cases.items() if not list(found)]
    for name, found in {"an excused pair": breaches({"a.cc": one, "b.cc": one}, limit, {pair: reason}),
                        "a short run": breaches({"a.cc": body("f", 3), "b.cc": body("f", 3)}, limit, {}),
                        "one file": breaches({"a.cc": one + one}, limit, {}),
                        "includes": breaches({"a.cc": includes, "b.cc": includes}, limit, {}),
                        "two functions": breaches({"a.cc": one, "b.cc": other}, limit, {})}.items():
        blind += [f"takes for a breach: {name}: {breach}" for breach in found]
    return blind


def tree(tops):
    return {str(path.relative_to(ROOT)): path.read_text() for top in tops for end in ("h", "cc")
            for path in (ROOT / top).rglob(f"*.{end}") if "node_modules" not in path.parts}


def release_lacks(package):
    """By the lists of apt, which list nothing of a package that there is not."""
    return shutil.which("apt-cache") and not subprocess.run(["apt-cache", "show", package], capture_output=True).stdout


def main():
    if shutil.which("sim_c++") is None:
        if release_lacks("similarity-tester"):
            print("clones: left out: this release of Debian has no similarity-tester")
            return 0
        print("clones: sim_c++ is missing: apt-get install similarity-tester")
        return 1
    found, files = [], {tops: tree(tops) for tops in LIMITS}
    for tops, limit in LIMITS.items():
        found += breaches(files[tops], limit, EXCUSED if tops == SHIPPED else {})
    found += [f"tests/house/clones_test.py: a breach of this rule is not seen: {rule}" for rule in blind_rules()]
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    print(f"clones: {sum(map(len, files.values()))} files, {len(EXCUSED)} excused pairs, {len(found)} breaches")
    if any(len(texts) < 400 for texts in files.values()):
        print("clones: too few files: the check does not see the tree")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
