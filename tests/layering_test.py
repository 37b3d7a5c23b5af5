#!/usr/bin/env python3
"""Who may include whom, what real-time functions may not name, how long a file may be.

Reads the tree as text and prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# A room may include itself and the rooms listed; host knows single files only.
ALLOWED = {
    "model": ["model/"],
    "hal": ["hal/", "model/"],
    "firmware": ["firmware/", "hal/", "model/"],
    "host": ["host/", "firmware/telemetry_record.h", "firmware/recording_format.h",
             "hal/sim/hand_target.h"],
    "tools": ["tools/", "firmware/", "hal/", "model/", "host/tracking/"],
    "tests": ["tests/", "tools/", "host/", "firmware/", "hal/", "model/"],
}
# In the body of an RT_SAFE function: allocation, locks, printing, throwing, hidden calls.
FORBIDDEN = re.compile(
    r"\b(new|delete|throw|malloc|printf|puts|dynamic_cast)\b"
    r"|std::(vector|string|function|map|mutex|lock_guard|unique_lock|cout|cerr|make_unique|make_shared)\b"
    r"|fmt::|\.(push_back|emplace_back|resize|reserve|lock)\(")
# What physics has no use for: threads, clocks, descriptors.
FOREIGN_TO_MODEL = re.compile(
    r"\s*#include <(thread|mutex|condition_variable|chrono|future|semaphore|unistd\.h|fcntl\.h|"
    r"pthread\.h|sched\.h|poll\.h|signal\.h|csignal|sys/[a-z]+\.h|linux/[a-z]+\.h|time\.h|ctime)>")
MAX_LINES = 300
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def blank(match):
    """Comments and strings keep their line breaks and lose their words."""
    return re.sub(r"[^\n]", " ", match.group())


def include_breaches(path, room, text):
    for number, line in enumerate(text.splitlines(), 1):
        if room == "model" and FOREIGN_TO_MODEL.match(line):
            yield f"{path}:{number}: model/ knows no thread, clock or descriptor: {line.strip()}"
        found = re.match(r'\s*#include "([^"]+)"', line)
        if found and not any(found[1].startswith(a) for a in ALLOWED[room]):
            yield f"{path}:{number}: {room}/ may not include {found[1]}"


def body_end(text, start):
    depth = 0
    for i in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i
    return len(text)


def real_time_breaches(path, text):
    code = COMMENT.sub(blank, text)
    for found in re.finditer(r"\bRT_SAFE(?:\s+override|\s+final)*\s*\{", code):
        start = found.end() - 1
        for bad in FORBIDDEN.finditer(code, start, body_end(code, start)):
            number = code.count("\n", 0, bad.start()) + 1
            yield f"{path}:{number}: '{bad.group()}' in an RT_SAFE function"


def main():
    breaches, files, bodies = [], 0, 0
    for room in ALLOWED:
        for path in sorted((ROOT / room).rglob("*")):
            if "node_modules" in path.parts or path.suffix not in (
                    ".h", ".cc", ".ts", ".mjs", ".py", ".sh"):
                continue
            text = path.read_text()
            name = path.relative_to(ROOT)
            files += 1
            if text.count("\n") > MAX_LINES:
                breaches.append(f"{name}:1: longer than {MAX_LINES} lines: split it by idea")
            if path.suffix in (".h", ".cc"):
                bodies += len(re.findall(r"\bRT_SAFE\b", text))
                breaches += include_breaches(name, room, text)
                breaches += real_time_breaches(name, text)
    print(*breaches, sep="\n", end="\n" if breaches else "")
    print(f"layering: {files} files, {bodies} RT_SAFE marks, {len(breaches)} breaches")
    if files < 50 or bodies < 50:
        print("layering: too few files or marks: the check does not see the tree")
        return 1
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
