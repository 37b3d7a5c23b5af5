#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One term for one thing: words that the field's own terms have replaced are in no identifier, comment or text, and a
test's name has at most 60 characters.

Prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import re
import subprocess
import sys

CODE, TEXT = (".cc", ".h"), (".cc", ".h", ".md", ".py", ".toml", ".json", ".ts", ".mjs", ".txt", ".cmake")
OTHERS = ("CHANGELOG.md", "package-lock.json", "words_test.py")  # what was, what others wrote, the words themselves
# In identifiers of C++: a part of a name, and the field's term.
PARTS = {
    "feel": "render_force", "felt": "rendered", "judge": "limit (the gate), check, evaluate", "tell": "publish, report, log",
    "told": "reported", "cure": "remedy", "slack_m": "depth_offset_m", "dent": "indentation", "wish": "request",
    "sentence": "message", "heat": "thermal, mean_square", "lip": "cut_edge", "fader": "ramp",
    "lifeline": "liveness", "temper": "input strategy", "mischief": "fault injection", "promises": "invariants",
    "patience": "timeout", "tally": "counters", "strays": "unknown_frames", "maker_library": "vendor_sdk",
}
TYPES = {"SphereTouch": "SphereContact", "TouchState": "ContactState", "GateVerdict": "LimitedForce",
         "SiteLaw": "ContactLaw", "Place": "SurfacePoint", "LoopWatch": "LoopMonitor", "StallWatch": "StallDetector",
         "LateWatch": "OverrunCounter", "EdgeWatch": "EdgeMonitor", "InterruptWatch": "InterruptFlag", "StopWatch": "StopTimer",
         "GateWatch": "GateMonitor", "Outlets": "Sinks", "OperatorDesk": "RequestHandler",
         "LastWords": "ShutdownFrames", "MakerLibrary": "VendorSdk"}
# Anywhere: whole words.
WORDS = {"cure": "remedy", "cures": "remedies", "maker's library": "vendor SDK", "last words": "shutdown frames",
         "anew": "again", "mend": "repair", "mends": "repairs"}
STRINGS = re.compile(r'//[^\n]*|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
PART = re.compile(r"(?<![A-Za-z0-9])(" + "|".join(PARTS) + r")(?![A-Za-z0-9])")
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
WORD = re.compile(r"\b(" + "|".join(WORDS) + r")\b", re.I)
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*\w+,\s*(\w+)\)", re.M)


def breaches(name, text):
    if name.endswith(CODE):
        code = STRINGS.sub(lambda found: "\n" * found[0].count("\n"), text)
        for number, line in enumerate(code.splitlines(), 1):
            for identifier in IDENTIFIER.findall(line):
                part = PART.search(identifier.replace("_", " ")) or PART.search(identifier)
                if identifier in TYPES:
                    yield f"{name}:{number}: {identifier}: the field's term is {TYPES[identifier]}"
                elif part:
                    yield f"{name}:{number}: {identifier}: for {part[1]} the field's term is {PARTS[part[1]]}"
        for found in TEST.finditer(text):
            if len(found[1]) > 60:
                yield f"{name}:{text[:found.start()].count(chr(10)) + 1}: the name has {len(found[1])} characters, at most 60"
    for found in WORD.finditer(text):
        word = found[1].lower()
        yield f"{name}:{text[:found.start()].count(chr(10)) + 1}: for \"{word}\" the field's term is \"{WORDS[word]}\""


# Each rule on a breach of its own.
TRIED = {
    "a.cc": ("int felt_N;", "Contact::feel(x);", "SphereTouch t;", "TEST(A, " + 61 * "n" + ") {}"),
    "a.md": ("the cure is", "starts anew"),
}
CLEAN = {"a.cc": ("int secure;", "// dent", '"felt"', "TEST(A, " + 60 * "n" + ") {}"), "a.md": ("secure, incident",)}


def main():
    found = [f"words_test.py:1: lets {text} pass" for name, texts in TRIED.items() for text in texts
             if not list(breaches(name, text))]
    found += [f"words_test.py:1: refuses {text}" for name, texts in CLEAN.items() for text in texts
              if list(breaches(name, text))]
    files = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split()
    files = [name for name in files if name.endswith(TEXT) and not name.endswith(OTHERS)]
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
