#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One term for one thing: words that the field's own terms have replaced are in no identifier, comment, text, file name or
folder name of the tree, and a test's name has at most 60 characters.

It reads every file that git lists but those of NOT_READ. Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import io
import keyword
import re
import subprocess
import sys
import tokenize

CODE, SLASHES = (".cc", ".h"), (".cc", ".h", ".c", ".inc", ".pml", ".ts", ".mjs")  # the latter: comments begin with //
HASHES = (".sh", ".cmake", "CMakeLists.txt")  # comments begin with #
# What was, what others wrote, and the words themselves; then what is no text.
NOT_READ = ("CHANGELOG.md", "LICENSE", "package-lock.json", "house/words_test.py",
            ".png", ".xz", ".compliance", "p15_binary_garbage.obj")
# In identifiers: a part of a name between underscores or capitals, and the field's term.
PARTS = {
    "feel": "render_force", "felt": "rendered", "judge": "limit (the gate), check, evaluate", "tell": "publish, report, log",
    "told": "reported", "cure": "remedy", "slack_m": "depth_offset_m", "dent": "indentation", "wish": "request",
    "sentence": "message", "heat": "thermal, mean_square", "lip": "cut_edge", "fader": "ramp",
    "lifeline": "liveness", "temper": "input strategy", "mischief": "fault injection", "promises": "invariants",
    "patience": "timeout", "tally": "counters", "strays": "unknown_frames", "maker_library": "vendor_sdk",
    "tells": "reports", "feels": "renders", "whatever": "any", "whoever": "any", "nobody": "none", "somebody": "another",
    "sunk": "displacement", "stray": "unknown", "unpaid": "unexplained", "stands": "is", "loose": "unlinked", "anew": "again",
    "touches": "is in contact, uses",
}
NAMES = {"library_": "handle_", "at_once": "processes, initial", "AT_ONCE": "processes", "Grid": "Extent, ReleaseSchedule",
         "Skin": "Boundary, Surface"}
TYPES = {"SphereTouch": "SphereContact", "TouchState": "ContactState", "GateVerdict": "LimitedForce",
         "SiteLaw": "ContactLaw", "Place": "SurfacePoint", "LoopWatch": "LoopMonitor", "StallWatch": "StallDetector",
         "LateWatch": "OverrunCounter", "EdgeWatch": "EdgeMonitor", "InterruptWatch": "InterruptFlag", "StopWatch": "StopTimer",
         "GateWatch": "GateMonitor", "Outlets": "Sinks", "OperatorDesk": "RequestHandler",
         "LastWords": "ShutdownFrames", "MakerLibrary": "VendorSdk"}
# Anywhere: whole words. `skin` is an organ, not the surface of one; nobody is a user of Debian; "strays" is a counter of reports.
WORDS = {"told": "reported", "tell": "report", "tells": "reports", "telling": "specific", "feels": "gets, renders",
         "whatever": "any", "whoever": "the one who", "nobody": "no person, none", "somebody": "another", "sunk": "displaced",
         "stray": "unknown", "strays": "unknown frames", "unpaid": "unexplained", "stands": "is", "loose": "unlinked",
         "touches": "is in contact, uses", "the skin": "the surface",
         "dent": "indentation", "dents": "indentations", "lips": "cut edges", "the give": "the compliance",
         "own give": "own compliance", "a give": "a compliance",
         "cure": "remedy", "cures": "remedies", "maker's library": "vendor SDK", "last words": "shutdown frames",
         "anew": "again", "held site": "held sphere", "mend": "repair", "mends": "repairs"}
STRINGS = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
SCRIPT_STRINGS = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.S)
HASH_STRINGS = re.compile(r"""(?<![\w$])#[^\n]*|"(?:\\.|[^"\\])*"|'[^']*'""", re.S)
PART = re.compile(r"\b(" + "|".join(PARTS).replace("_", " ") + r")\b")
CAPITAL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
COMPOUND = re.compile(r"\b[A-Za-z]\w*(?:_[a-z]|[a-z][A-Z])\w*")  # in a text a name, not a word
WORD = re.compile(r"(?<!user )(?<!=)(?<![\"\w])(" + "|".join(WORDS) + r")\b", re.I)
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*\w+,\s*(\w+)\)", re.M)


def identifiers(name, text):
    """Each as (line, identifier)."""
    shebang = text.partition("\n")[0] if text.startswith("#!") else ""
    if name.endswith(".py") or "python" in shebang:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.NAME and not keyword.iskeyword(token.string):
                yield token.start[0], token.string
        return
    pattern = IDENTIFIER
    if name.endswith((".ts", ".mjs")):
        left_out = SCRIPT_STRINGS
    elif name.endswith(SLASHES):
        left_out = STRINGS
    elif name.endswith(HASHES) or shebang:
        left_out = HASH_STRINGS
    else:
        left_out, pattern = None, COMPOUND
    code = left_out.sub(lambda found: "\n" * found[0].count("\n"), text) if left_out else text
    yield from ((number, word) for number, line in enumerate(code.splitlines(), 1) for word in pattern.findall(line))


def part_of(name):
    """What the field says for a part of a name; None where it is the field's own."""
    part = PART.search(re.sub(r"[_./-]", " ", CAPITAL.sub(" ", name)).lower())
    return part and (PARTS.get(part[1]) or PARTS[part[1].replace(" ", "_")])


def breaches(name, text):
    if term := part_of(name):
        yield f"{name}:1: the name of the file or of a folder: the field's term is {term}"
    for number, identifier in identifiers(name, text):
        if term := TYPES.get(identifier) or NAMES.get(identifier) or part_of(identifier):
            yield f"{name}:{number}: {identifier}: the field's term is {term}"
    for found in TEST.finditer(text) if name.endswith(CODE) else ():
        if len(found[1]) > 60:
            yield f"{name}:{text[:found.start()].count(chr(10)) + 1}: the name has {len(found[1])} characters, at most 60"
    for found in WORD.finditer(text):
        word = found[1].lower()
        yield f"{name}:{text[:found.start()].count(chr(10)) + 1}: for \"{word}\" the field's term is \"{WORDS[word]}\""


# Each rule on a breach of its own.
TRIED = {
    "a.cc": ("int felt_N;", "Contact::feel(x);", "SphereTouch t;", "TEST(A, " + 61 * "n" + ") {}", "TEST(A, IsToldOnce) {}",
             "int unpaid_m;", "void* library_;", "// nobody reads it"),
    "a.py": ("told = 1\n", "def at_once(): pass\n", "AT_ONCE = 1\n", "# a text that is told\n", "class Skin: pass\n"),
    "a.md": ("the cure is", "starts anew", "the tool feels 2 N", "along the skin", "the key `told_ms`"),
    "a.ts": ("const kTold_ms = 1;", "patience_ms: number"), "a.mjs": ("await feltForce()",), "a.pml": ("bool told", "// nobody"),
    "a.inc": ("// stands",), "a.c": ("int felt;",), "a.css": ("/* stands */", ".told_row {}"), "a.h2m": ("touches nothing",),
    "a.patch": ("promise: a dent", "+ SphereTouch t;"), "a.in": ("# nobody",), "a.sh": ("judge() {", "# told"),
    "a.cmake": ("set(told_N 1)", "# mends"), "a.json": ("{\"told_ms\": 1}",), "a.service": ("# whoever",),
    "a": ("#!/bin/sh\njudge=1", "#!/usr/bin/env python3\ntold = 1\n", "told"),
    "a/told/b.cc": ("",), "a/is_told.patch": ("",), "judge": ("",),
}
CLEAN = {"a.cc": ("int secure;", '"felt"', "TEST(A, " + 60 * "n" + ") {}", "auto at = file.tellg();", '{"strays", 1}'),
         "a.py": ("'--reuid=nobody'\n",),
         "a.ts": ("say('felt');", "// a felt force"), "a.sh": ("echo \"felt\" # felt",), "a/secure.cc": ("",),
         "a.md": ("secure, incident", "`skin`, heart", "the user nobody", "one sentence")}


def main():
    found = [f"words_test.py:1: lets {text} pass" for name, texts in TRIED.items() for text in texts
             if not list(breaches(name, text))]
    found += [f"words_test.py:1: refuses {text}" for name, texts in CLEAN.items() for text in texts
              if list(breaches(name, text))]
    files = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.splitlines()
    files = [name for name in files if not name.endswith(NOT_READ)]
    for name in files:
        try:
            with open(name, encoding="utf-8") as file:
                found += breaches(name, file.read())
        except FileNotFoundError:
            continue  # deleted, not yet committed
    print(*found, sep="\n", end="\n" if found else "")
    print(f"words: {len(files)} files, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
