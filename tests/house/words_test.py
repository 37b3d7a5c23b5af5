#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One term for one thing: words that the field's own terms have replaced are in no identifier of C++ and Python, no
comment and no text, and a test's name has at most 60 characters.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import io
import keyword
import re
import subprocess
import sys
import tokenize

CODE, TEXT = (".cc", ".h"), (".cc", ".h", ".md", ".py", ".toml", ".json", ".ts", ".mjs", ".txt", ".cmake")
OTHERS = ("CHANGELOG.md", "package-lock.json", "words_test.py")  # what was, what others wrote, the words themselves
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
         "anew": "again", "mend": "repair", "mends": "repairs"}
STRINGS = re.compile(r'//[^\n]*|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
PART = re.compile(r"\b(" + "|".join(PARTS).replace("_", " ") + r")\b")
CAPITAL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
WORD = re.compile(r"(?<!user )(?<!=)(?<![\"\w])(" + "|".join(WORDS) + r")\b", re.I)
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*\w+,\s*(\w+)\)", re.M)


def identifiers(name, text):
    """Each as (line, identifier)."""
    if name.endswith(CODE):
        code = STRINGS.sub(lambda found: "\n" * found[0].count("\n"), text)
        yield from ((number, word) for number, line in enumerate(code.splitlines(), 1) for word in IDENTIFIER.findall(line))
    elif name.endswith(".py"):
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.NAME and not keyword.iskeyword(token.string):
                yield token.start[0], token.string


def breaches(name, text):
    for number, identifier in identifiers(name, text):
        part = PART.search(CAPITAL.sub(" ", identifier).replace("_", " ").lower())
        term = TYPES.get(identifier) or NAMES.get(identifier)
        if term or part:
            term = term or PARTS.get(part[1]) or PARTS[part[1].replace(" ", "_")]
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
    "a.md": ("the cure is", "starts anew", "the tool feels 2 N", "along the skin"),
}
CLEAN = {"a.cc": ("int secure;", '"felt"', "TEST(A, " + 60 * "n" + ") {}", "auto at = file.tellg();", '{"strays", 1}'),
         "a.py": ("'--reuid=nobody'\n",),
         "a.md": ("secure, incident", "`skin`, heart", "the user nobody")}


def main():
    found = [f"words_test.py:1: lets {text} pass" for name, texts in TRIED.items() for text in texts
             if not list(breaches(name, text))]
    found += [f"words_test.py:1: refuses {text}" for name, texts in CLEAN.items() for text in texts
              if list(breaches(name, text))]
    files = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split()
    files = [name for name in files if name.endswith(TEXT) and not name.endswith(OTHERS) and not name.startswith("tests/data/")]
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
