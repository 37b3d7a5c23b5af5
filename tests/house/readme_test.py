#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""README.md stays short and narrow, prose of every *.md narrow, and every relative link leads to a file and its heading.
Every room has a README.md that names its parts, with a line `Tests: ...`, whose programs and files there are. What each
file of a room is is in its first lines (layering_test.py): tools/rooms prints them.

Reads the tree as text and prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import os
import pathlib
import posixpath
import re
import subprocess
import sys

import rooms

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MAX_LINES, MAX_COLUMNS = 110, 130  # lines of README.md; columns but of code, a lone link and, elsewhere, tables
# [text](target) and ![text](target "title"); the text may hold an image of its own
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
FENCE, CODE = re.compile(r"\s*(```|~~~)"), re.compile(r"`[^`]*`")
LONE_LINK = re.compile(r"\s*(?:(?:[*-]|\d+\.)\s+)?!?\[[^\]]*\](?:\([^)]*\)|:\s+\S+)[.,;:]?$")
HEADING = re.compile(r"#{1,6}\s+(.*?)\s*#*$")
ELSEWHERE = re.compile(r"[a-z][a-z0-9+.-]*:|//")  # a scheme, as https: and mailto:
TOPS = ("model/", "hal/", "firmware/", "host/", "tools/")  # whose rooms have a README.md
SOURCE = re.compile(r"(?:.*/)?([^/]+\.(?:h|cc)|package\.json)")
TEST_PROGRAM = re.compile(r"`(?:build/tests/)?((?:[a-z0-9]+_)+test)(?: [^`]*)?`")
TEST_FILE = re.compile(r"`((?:[\w-]+/)*\w+_test\.(?:cc|mjs))`")
MAX_PUBLIC = 10
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def prose(text):
    """Lines outside blocks of code, with their numbers."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            yield number, line


def slugs(text):
    """GitHub's anchors: lower case, spaces are hyphens, no other punctuation, twins are numbered."""
    seen = {}
    for _, line in prose(text):
        found = HEADING.match(line)
        if found:
            words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", found[1])
            slug = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
            seen[slug] = seen.get(slug, -1) + 1
            yield f"{slug}-{seen[slug]}" if seen[slug] else slug


def link_breaches(path, text, files):
    """`files`: texts by path, of what is no markdown nothing."""
    for number, line in prose(text):
        for target in LINK.findall(CODE.sub("", line)):
            if ELSEWHERE.match(target):
                continue
            name, _, fragment = target.partition("#")
            other = posixpath.normpath(posixpath.join(posixpath.dirname(path), name)) if name else path
            if other not in files:
                yield f"{path}:{number}: {target}: no such file"
            elif fragment and fragment not in slugs(files[other] or ""):
                yield f"{path}:{number}: {target}: no such heading in {other}"


def length_breaches(path, text):
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        yield f"{path}:{MAX_LINES + 1}: longer than {MAX_LINES} lines: move what a room can say to its README.md"


def width_breaches(path, text):
    for number, line in prose(text):
        is_row = path != "README.md" and line.lstrip().startswith("|")
        if len(line) > MAX_COLUMNS and not is_row and not LONE_LINK.match(line):
            yield f"{path}:{number}: longer than {MAX_COLUMNS} characters"


def room_breaches(files):
    """A room without README.md; a README.md that names no test of its room, or one that is not there."""
    for room in sorted({rooms.room_of(path) for path in files if path.startswith(TOPS) and SOURCE.fullmatch(path)}):
        if f"{room}/README.md" not in files:
            yield f"{room}/README.md:1: missing: which question does this room answer, by which files and tests?"
    yield from part_breaches(files)
    tests = [path for path in files if path.startswith("tests/") and path.endswith(("_test.cc", "_test.mjs"))]
    programs = {posixpath.dirname(path).removeprefix("tests/").replace("/", "_") + "_test" for path in tests}
    names = {*tests, *map(posixpath.basename, tests)}
    for path, text in files.items():
        if not path.startswith(TOPS) or posixpath.basename(path) != "README.md":
            continue
        if not re.search(r"^Tests: \S", text, re.M):
            yield f"{path}:1: no line that begins with `Tests:` and names the test program of this room"
        named = set(TEST_PROGRAM.findall(text))
        for name in sorted((named - programs) | (set(TEST_FILE.findall(text)) - names)):
            yield f"{path}:1: {name}: no such test"
        own = posixpath.dirname(path).replace("/", "_") + "_test"
        if own in programs and own not in named:
            yield f"{path}:1: does not name {own}"


def part_breaches(files):
    """A part of a room that the room's README.md does not name, as `part/`."""
    for room, parts in rooms.PARTS.items():
        path = f"{room}/README.md"
        for part in parts if path in files else []:
            if f"`{part}/`" not in files[path]:
                yield f"{path}:1: does not name {part}/: what is there?"


def silent_files():
    """What tools/rooms has no sentence for, of the headers of all rooms."""
    listed = subprocess.run([str(ROOT / "tools/rooms"), *rooms.ROOMS], capture_output=True, text=True, check=True)
    words = [line.split(maxsplit=1) for line in listed.stdout.splitlines()]
    yield from (f"tools/rooms says nothing of {row[0]}" for row in words if len(row) < 2)
    if len(words) < 200:
        yield f"tools/rooms names {len(words)} files: it does not see the rooms"


def public_breaches(path, text, cmake):
    """The headers that tact offers other programs: few, and each with its row."""
    headers = re.search(r"set\(public_headers([^)]*)\)", cmake)[1].split()
    if len(headers) > MAX_PUBLIC:
        yield f"tools/cmake/library.cmake:1: {len(headers)} public headers: {MAX_PUBLIC} at most"
    for name in sorted({*headers} ^ {*re.findall(r"^\| `(\w+(?:/\w+)+\.h)` \|", text, re.M)}):
        yield f"{path}:1: {name}: is a public header of tools/cmake/library.cmake, or has a row: both, or none"


def host_breaches(path, text):
    """What host/ includes of other folders, as tests/house/rooms.py allows it."""
    single = {f"{other}/{name}" for (room, other), headers in rooms.SINGLE_HEADERS.items()
              if room.startswith("host/") for name in headers}
    whole = {other for room, row in rooms.ROOMS.items() if room.startswith("host/") for other in row
             if not other.startswith("host/") and (room, other) not in rooms.SINGLE_HEADERS}
    if f"{COUNTS[len(single)]} headers" not in text:
        yield f"{path}:1: host/ includes {COUNTS[len(single)]} headers of other folders: {', '.join(sorted(single))}"
    for other in sorted(whole):
        if other not in text:
            yield f"{path}:1: does not say that host/ includes {other}"


def breaches(files):
    yield from length_breaches("README.md", files["README.md"])
    yield from room_breaches(files)
    for path in ("README.md", "host/README.md"):
        if path in files:
            yield from host_breaches(path, files[path])
    for path, text in files.items():
        if text is not None:
            yield from width_breaches(path, text)
            yield from link_breaches(path, text, files)


def tree():
    """Every file and folder of the tree, and the text of what is markdown."""
    files = {}
    for folder, folders, names in os.walk(ROOT):
        top = pathlib.Path(folder) == ROOT
        folders[:] = [name for name in folders if name not in ("node_modules", "__pycache__", ".git") and
                      not (top and name.startswith("build"))]
        for path in (pathlib.Path(folder) / name for name in ["", *names]):
            files[path.relative_to(ROOT).as_posix()] = path.read_text() if path.suffix == ".md" else None
    return dict(sorted(files.items()))


def blind_rules():
    """Each rule against a breach of it, and against its remedy: the names of those that err."""
    room = "# A room\n## Two  words, `a_b`: [c-d](b.png)\n## Twin\n## Twin\n```\n# Code\n```\n"
    wide, named = "x" * MAX_COLUMNS, "five headers, model/io, model/reader, firmware/protocol"
    good = ("[a](a/README.md) ![b](a/b.png \"t\") [c](#top) [d](a/README.md#twin-1) `[e](none)` [f](https://g/h)\n"
            "[i](a/README.md#two--words-a_b-c-d) [![j](a/b.png)](a/README.md)\n# Top\n```\n[k](none)\n```\n"
            f"```\n{wide}x\n```\n* [{wide}](a/b.png)\n[{wide}]: https://g/h\n{wide}\n{named}\n")
    bad = {"missing file": "[a](a/none.md)", "missing file behind a title": '[a](none.json "x .1f")',
           "missing heading": "[a](a/README.md#none)", "third twin": "[a](a/README.md#twin-2)",
           "heading in code": "[a](a/README.md#code)", "own heading": "[a](#none)",
           "folder above": "[a](../a/README.md)", "no markdown": "[a](a/b.png#top)",
           "picture in a link": "[![a](none.png)](a/README.md)", "second link": "[a](a/README.md) [b](none)",
           "long line": wide + "x", "long line with a link": f"{wide} [a](a/b.png)",
           "long line in a list": f"* {wide}", "long row of a table": f"| {wide} |",
           "many lines": "\n" * MAX_LINES}
    files = {"a/README.md": room, "a/b.png": None, "hal/a/b.h": None, "tests/hal/a/b_test.cc": None,
             "hal/a/README.md": "Tests: `build/tests/hal_a_test`; `b_test.cc`, `tests/hal/a/b_test.cc`.\n"}
    blind = [name for name, line in bad.items() if not list(breaches({**files, "README.md": good + line + "\n"}))]
    if not list(breaches({**files, "README.md": good, "a/c.md": f"{wide}x\n"})):
        blind.append("long line elsewhere")
    if list(breaches({**files, "README.md": good, "a/c.md": f"| {wide} |\n" * (MAX_LINES + 1)})):
        blind.append("takes for a breach: many lines or a long row elsewhere")
    whole = "tests/rig/emulators"
    rooms_of = {"room without README.md": {"hal/c/d.cc": None}, "page without README.md": {"host/c/package.json": None},
                "no line of tests": {"hal/a/README.md": "The tests: `hal_a_test`\n"},
                "empty line of tests": {"hal/a/README.md": "Tests: \n\n`hal_a_test`\n"},
                "own program is not named": {"hal/a/README.md": "Tests: `b_test.cc`\n"},
                "program that is none": {"hal/a/README.md": "Tests: `hal_a_test`, `build/tests/hal_b_test`\n"},
                "file that is none": {"hal/a/README.md": "Tests: `hal_a_test`, `c_test.cc`\n"},
                "file elsewhere": {"hal/a/README.md": "Tests: `hal_a_test`, `tests/hal/b/b_test.cc`\n"},
                "part that is not named": {f"{whole}/README.md": "".join(f"`{part}/` " for part in [*rooms.PARTS[whole]][1:])},
                "another number of headers": {"host/README.md": f"Tests: none. {named.replace('five', 'three')}\n"},
                "room of host is not named": {"host/README.md": "Tests: none. five headers, model/io, firmware/protocol\n"}}
    for name, other in rooms_of.items():
        if len(list(breaches({**files, "README.md": good, **other}))) != 1:
            blind.append(name)
    row, public = "| `a/b.h` | c |\n", "set(public_headers\n  a/b.h)"
    blind += [name for name, text, cmake in (
        ("header without a row", "", public), ("row without a header", row, "set(public_headers)"),
        ("many headers", row, public[:-1] + " a/b.h" * MAX_PUBLIC + ")")) if not list(public_breaches("a", text, cmake))]
    blind += [f"takes for a breach: {found}" for found in public_breaches("a", row, public)]
    blind += [f"takes for a breach: {found}" for found in breaches({**files, "README.md": good})]
    return blind


def main():
    files = tree()
    examples = "tools/examples/README.md"
    found = [*breaches(files), *silent_files(),
             *public_breaches(examples, files[examples], (ROOT / "tools/cmake/library.cmake").read_text())]
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    texts = [text for text in files.values() if text is not None]
    links = sum(len(LINK.findall(text)) for text in texts)
    print(f"readme: {len(texts)} texts, {links} links, {len(found)} breaches")
    for rule in blind_rules():
        found.append(rule)
        print(f"readme: a breach of this rule is not seen: {rule}")
    if len(texts) < 20 or links < 50:
        print("readme: too few texts or links: the check does not see the tree")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
