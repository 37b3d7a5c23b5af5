#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every equation and fact that a text names by an id, as RC-3, is listed once in a SOURCES.md. Where a
comment writes the equation out, it is the one listed there. model/CLAIMS.md has a row for every
error X1, X2, .., and a test that a document names, as `Suite.Name`, is there.

Reads the tree as text and prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import fnmatch
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOPS = ("model", "hal", "firmware", "host", "tools", "tests")
SELF = "tests/house/sources_test.py"  # names what it forbids
# Numbers that machines wrote; of the data the published cases alone name equations.
DATA = ("tests/data/", "tests/fuzz/corpus/")
CASES = "tests/data/vectors/"
ID = r"(?:(?!HZ-)[A-Z]{2}-\d+[a-z]?|X\d{1,2})"  # HZ-nn: a hazard, hazards_test.py
# "RC-3", "MA-10..15", "RC-1 .. RC-7", "X1 to X7"
NAME = re.compile(rf"\b({ID})\b(?:\s*\.\.\s*(\d+\b|{ID}\b)|\s+to\s+({ID})\b)?")
ROW = re.compile(rf"\|\s*({ID})\s*\|")
FORMULA = re.compile(rf"({ID})\s\s")
# An equation written out in a comment: "//     RC-3   F = k d,   k > 0"; its first right-hand side.
WRITTEN_OUT = re.compile(rf"\s*///?\s{{2,}}({ID})\s{{2,}}.*?=\s*(.*?)(?:,|\s{{2,}}|$)")
# Documents that a reader of the tree does not have.
FOREIGN = re.compile(r"\b(PHYSICS|REALTIME|REFERENCE|ERRATA)\b|\bDEVICES\s+\d|\.\./shared\b")
CLAIMS = "model/CLAIMS.md"
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", re.M)
# `Suite.Name`, with * for any; `...Name`: of the suite named before
TEST_NAME = re.compile(r"`((?:[A-Z]\w*|\.\.)\.[A-Z*][\w*]*)`")
MAX_LINES, MAX_COLUMNS = 300, 160


def defined_in(text):
    """What a SOURCES.md defines: first cell of a table's row, first word of a line in a code block."""
    in_block = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            in_block = not in_block
        found = (FORMULA if in_block else ROW).match(line)
        if found:
            yield found[1], number


def members(first, last):
    """MA-10 and 15, or RC-1 and RC-7: all that lies between, ends included."""
    prefix = first.rstrip("0123456789abcdefghijklmnopqrstuvwxyz")
    ends = [int(re.search(r"\d+", end)[0]) for end in (first, last)]
    return [first, *(f"{prefix}{i}" for i in range(ends[0] + 1, ends[1] + 1))]


def named_in(text):
    for number, line in enumerate(text.splitlines(), 1):
        for found in NAME.finditer(line):
            last = found[2] or found[3]
            for name in members(found[1], last) if last else [found[1]]:
                yield name, number


def id_breaches(texts):
    """Ids without a definition, with two, or with nothing that names them."""
    places, used = {}, set()
    for path, text in texts.items():
        if is_source(path):
            for name, number in defined_in(text):
                if name in places:
                    yield f"{path}:{number}: {name} is in {places[name]} too: keep one"
                places.setdefault(name, f"{path}:{number}")
    for path, text in texts.items():
        for name, number in named_in(text):
            if name not in places:
                yield f"{path}:{number}: {name} is in no SOURCES.md: add it, or name another"
            if not is_source(path):
                used.add(name)
    for name, place in places.items():
        if name not in used:
            yield f"{place}: nothing names {name}: take it out, or name it where it is used"


def without_blanks(formula):
    return re.sub(r"[\s`*\\]", "", formula)


def ends_a_term(formula, text):
    """Is in the text as a whole term."""
    at = text.find(formula)
    return at >= 0 and text[at + len(formula):][:1] not in ("/", "*", "+", "-", "^")


def formula_breaches(texts):
    """Equations that a comment writes otherwise than their SOURCES.md."""
    listed = {name: text.splitlines()[number - 1] for path, text in texts.items() if is_source(path)
              for name, number in defined_in(text)}
    for path, text in texts.items():
        if not path.endswith((".h", ".cc")):
            continue
        for number, line in enumerate(text.splitlines(), 1):
            found = WRITTEN_OUT.match(line)
            if found and not ends_a_term(without_blanks(found[2]), without_blanks(listed.get(found[1], found[2]))):
                yield f"{path}:{number}: {found[1]} is another equation than in SOURCES.md: '{found[2]}'"


BARE = re.compile(rf"\s*///?\s*{ID}\.?\s*$")


def bare_breaches(path, text):
    """A comment that is an id alone sends the reader away: the equation is above its line."""
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        goes_on = number > 1 and lines[number - 2].lstrip().startswith("//")
        if BARE.match(line) and not goes_on:
            yield f"{path}:{number}: an id alone: write its equation, or what it says, behind it"


def foreign_breaches(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        found = FOREIGN.search(line)
        if found:
            yield f"{path}:{number}: {found[0]}: no reader has this; put the fact into a SOURCES.md"


def shape_breaches(path, text):
    lines = text.splitlines()
    if len(lines) >= MAX_LINES:
        yield f"{path}:1: {MAX_LINES} lines or more: split it by room"
    for number, line in enumerate(lines, 1):
        if len(line) > MAX_COLUMNS and not line.startswith("|"):
            yield f"{path}:{number}: longer than {MAX_COLUMNS} columns outside a table"


def claim_breaches(texts):
    """Tests that a document names and that are not there; errors of the sources without a row among the claims."""
    tests = [f"{suite}.{name}" for path, text in texts.items() if path.endswith("_test.cc")
             for suite, name in TEST.findall(text)]
    for path, text in texts.items():
        if not path.endswith(".md"):
            continue
        for number, line in enumerate(text.splitlines(), 1):
            for name in TEST_NAME.findall(line):
                if not fnmatch.filter(tests, name.replace("...", "*.", 1)):
                    yield f"{path}:{number}: {name}: no such test"
    rows = {name for name, _ in defined_in(texts.get(CLAIMS, ""))}
    for path, text in texts.items():
        if is_source(path):
            for name, number in defined_in(text):
                if name[0] == "X" and name not in rows:
                    yield f"{path}:{number}: {name} has no row in {CLAIMS}: how far off is it, which test shows it?"


def is_source(path):
    return path.endswith("SOURCES.md")


def is_read(path):
    return path != SELF and (path.startswith(CASES) or not path.startswith(DATA))


def tree():
    """Every text of the tree by its path."""
    names = ["README.md", "CMakeLists.txt"]
    for top in TOPS:
        for folder, folders, files in os.walk(ROOT / top):
            folders[:] = [name for name in folders if name not in ("node_modules", "__pycache__")]
            names += [str((pathlib.Path(folder) / name).relative_to(ROOT)) for name in files]
    texts = {name: text_of(ROOT / name) for name in sorted(names) if is_read(name)}
    return {name: text for name, text in texts.items() if text is not None}


def text_of(path):
    """Nothing for bytes that are no text."""
    data = path.read_bytes()
    try:
        return None if b"\0" in data else data.decode()
    except UnicodeDecodeError:
        return None


def breaches(texts):
    yield from id_breaches(texts)
    yield from formula_breaches(texts)
    yield from claim_breaches(texts)
    for path, text in texts.items():
        yield from foreign_breaches(path, text)
        yield from bare_breaches(path, text)
        if is_source(path):
            yield from shape_breaches(path, text)


def blind_rules():
    """Each rule against a breach of it, and against its remedy: the names of those that err."""
    source = "a/SOURCES.md"
    good = "| id | what |\n|---|---|\n| RC-1 | F |\n| RC-2 | G |\n```\nRC-3   H\nX1  I\n```\n"
    names = "// RC-1 .. RC-3, X1"
    cases = {
        "undefined": (good, names + ", RC-4"),
        "undefined claim": (good, names + ", X2"),
        "undefined letter": (good, names + ", RC-3b"),
        "undefined in a range": (good, "// RC-1 to RC-4, X1"),
        "undefined in a range of numbers": (good, "// RC-1..4, X1"),
        "undefined in a SOURCES.md": (good + "see RC-9\n", names),
        "a definition is no prose": (good + "RC-4   J\n", names + ", RC-4"),
        "a definition is a first cell": (good + "| what | RC-4 |\n", names + ", RC-4"),
        "twice": (good + "| RC-1 | again |\n", names),
        "twice, table and formula": (good + "```\nRC-2   again\n```\n", names),
        "unnamed": (good, "// RC-1, RC-2, X1"),
        "named by a SOURCES.md alone": (good + "as RC-3\n", "// RC-1, RC-2, X1"),
        "another formula": (good + "| RC-4 | F = k d / 2 | N |\n", names + "\n//   RC-4   F = k d,   k > 0"),
        "an id alone": (good, names + "\nint a;\n// RC-1\nint b;"),
        "long line": (good + "x" * (MAX_COLUMNS + 1) + "\n", names),
        "long file": (good + "\n" * MAX_LINES, names),
        **{word: (good, f"{names} ({word})") for word in
           ("PHYSICS 4.2", "REALTIME 4", "DEVICES 3.4", "REFERENCE", "ERRATA", "../shared/seeds")},
    }
    claims = {CLAIMS: "| X1 | fails | `Suite.Name` |\n", "c_test.cc": "TEST_F(Suite,\n       Name) {}\n"}
    blind = [name for name, (text, comment) in cases.items()
             if not list(breaches({source: text, "b.h": comment, **claims}))]
    formula = "| RC-4 | F = k d / (1 + r k) | N |\n"
    if list(breaches({source: good + formula, "b.h": names + "\n//   RC-4   F = k d/(1 + r k),   k > 0", **claims})):
        blind.append("takes for a breach: the same formula with other blanks")
    bad_claims = {"error without a row": "see X1 and `Suite.Name`\n",
                  "test that is none": "| X1 | `Suite.Nam` |\n", "suite that is none": "| X1 | `Suit.Name` |\n",
                  "test behind another that is none": "| X1 | `Suite.Name`, `...Other` |\n",
                  "tests that are none": "| X1 | `Suite.Other*` |\n"}
    blind += [name for name, text in bad_claims.items()
              if len(list(breaches({source: good, "b.h": names, **claims, CLAIMS: text}))) != 1]
    for text in ("`Suite.*`", "`Suite.Name`, `...Name`", "`Suite.N*`, `file.h`, `CLAIMS.md`, Any.Thing"):
        if list(breaches({source: good, "b.h": names, **claims, "d.md": text})):
            blind.append(f"takes for a breach: {text}")
    for comment in (names, "// RC-1 to RC-3, X1", "// RC-1..3, X1; DEVICES = []", "// X1, RC-3, RC-2, RC-1"):
        if list(breaches({source: good, "b.h": comment, **claims})):
            blind.append(f"takes for a breach: {comment}")
    return blind


def main():
    texts = tree()
    found = list(breaches(texts))
    print(*found, sep="\n", end="\n" if found else "")
    sources = [path for path in texts if is_source(path)]
    ids = sum(1 for path in sources for _ in defined_in(texts[path]))
    print(f"sources: {len(texts)} texts, {len(sources)} SOURCES.md, {ids} ids, {len(found)} breaches")
    for rule in blind_rules():
        found.append(rule)
        print(f"sources: a breach of this rule is not seen: {rule}")
    if len(texts) < 500 or len(sources) < 5 or ids < 100:
        print("sources: too few texts, sources or ids: the check does not see the tree")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
