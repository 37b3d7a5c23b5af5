#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Who may include whom, what real-time functions may not name, that nothing throws, how long a file may be.

Reads the tree as text and prints every breach as file:line: sentence. Exit status 0 or 1.
"""
import pathlib
import re
import sys

import rooms

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOPS = ("model", "hal", "firmware", "host", "tools", "tests")
# In the body of an RT_SAFE function: allocation, locks, printing, throwing, hidden calls.
FORBIDDEN = re.compile(
    r"\b(new|delete|throw|malloc|printf|puts|dynamic_cast)\b"
    r"|std::(vector|string|function|map|mutex|lock_guard|unique_lock|cout|cerr|make_unique|make_shared)\b"
    r"|fmt::|\.(push_back|emplace_back|resize|reserve|lock)\(")
LOOP = re.compile(r"\b(?:for|while) \(((?:[^()]|\([^()]*\))*)\)")
# i < 3, i < kRows, i < a.size(), x : axes, x : {1, 2}
HEAD_BOUND = re.compile(r"[<>]=? ?(?:\d+|[\w:.]*\bk[A-Z]\w*)|[<>]=? [\w.]+\.size\(\)|: [\w.]+$|: \{")
# What physics has no use for: threads, clocks, descriptors.
FOREIGN_TO_MODEL = re.compile(
    r"\s*#include <(thread|mutex|condition_variable|chrono|future|semaphore|unistd\.h|fcntl\.h|"
    r"pthread\.h|sched\.h|poll\.h|signal\.h|csignal|sys/[a-z]+\.h|linux/[a-z]+\.h|time\.h|ctime)>")
# The emulators stand on the other side of the kernel: what they shared with a driver they could not
# find wrong. Of ours they know the words of vectors alone.
EMULATORS = "tests/rig/emulators/"
CANARIES = "tests/canaries/"  # break the rules so that tests/canaries/run sees them reported
ALLOWED_TO_EMULATORS = [EMULATORS, "model/types.h"]
# Where a call that the compiler or the real-time sanitizer cannot check is vouched for.
VOUCHES = {
    "hides a call from the compiler's check": (
        re.compile(r'ignored\s+"-Wfunction-effects"|-Wno-function-effects'),
        {"firmware/loop/clock.cc", "firmware/loop/ring.cc", "hal/monotonic.h",
         "hal/gpio/libgpiod_1.cc", "hal/gpio/libgpiod_2.cc", "hal/can/can_socket.cc",
         "hal/falcon_usb/usbfs_port.cc",
         # broken devices and a fake kernel, which only tests have
         "tests/support/monitored_loop.h", "tests/hal/falcon_usb/usbfs_bus.h"}),
    "hides a call from the real-time sanitizer": (
        re.compile(r"ScopedDisabler|__rtsan_disable|rtsan_interface|no_sanitize\w*\W+realtime"),
        {"hal/can/can_socket.cc"}),
}
# Files, numbers of a command line and nested text come in by model/io/ alone.
BY_IO = re.compile(r"\b[io]?fstream\b|\bfopen\(|\bCLI::(Range|Bound|Number|PositiveNumber|NonNegativeNumber|ExistingFile)\b"
                   r"|\bjson::parse\(|\.dump\(|\btoml::parse(_file)?\(")
IO = "model/io/"
# What evaluates the gate shares no formula with it: a wrong one would agree with itself.
JUDGES = ("model/limit_witness.h", "model/limit_witness.cc", "tests/support/gate_rules.h", "tests/soak/energy_ledger.h",
          "tests/soak/invariants.h", "tests/soak/invariants.cc")
OF_THE_GATE = re.compile(r"\b(limits_in_use|brake_energy_J|slew_beside_ramp_N\w*|thermal_steepness|limit_surplus"
                         r"|limit_magnitude|approach|given_energy_J)\(|\bEnergyTank\b|\bThermalLimit\b")
# Threads start in one place, which returns an Error where the system refuses one and lets no exception out.
BY_THREAD = re.compile(r"\bstd::j?thread\b(?!::hardware_concurrency)|\bpthread_create\(|\bstd::async\b|\bthread_pool\b")
THREAD = ("hal/threads/thread.h", "hal/threads/thread.cc")
# What carries bytes is no business of what reads them.
TRANSPORT = re.compile(r"\s*#include <((?:sys|linux|libusb[^/>]*)/[^>]+|(?:libusb|gpiod)[^>]*)>")
MAX_LINES, MAX_COLUMNS = 300, 100
LICENCE = "SPDX-License-Identifier: Apache-2.0"
SOURCES = (".h", ".cc", ".ts", ".mjs", ".py", ".sh", ".txt", ".cmake")
# Sources in other words; scenes that only tests read say their error in their first line.
CONFIGURATION = (".css", ".gp", ".html", ".toml", ".proto", ".yml", ".rules", ".link", ".network", ".ifupdown", ".conf")
UNSIGNED = "tests/data/scenes/"
OURS = re.compile(r'\s*#include "([^"]+)"')
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def blank(match):
    """Comments and strings keep their line breaks and lose their words."""
    return re.sub(r"[^\n]", " ", match.group())


def foreign_breaches(path, text):
    """What no sentence of rooms.py says: threads in physics, our code in an emulator."""
    for number, line in enumerate(text.splitlines(), 1):
        found = OURS.match(line)
        if path.startswith("model/") and not path.startswith(IO) and FOREIGN_TO_MODEL.match(line):
            yield f"{path}:{number}: model/ knows no thread, clock or descriptor: {line.strip()}"
        if found and path.startswith(EMULATORS) and not found[1].startswith(tuple(ALLOWED_TO_EMULATORS)):
            yield f"{path}:{number}: an emulator shares no code with tact: {found[1]}"


def io_breaches(path, text):
    if path.startswith((IO, "tests/")):
        return
    code = COMMENT.sub(blank, text)
    for found in BY_IO.finditer(code):
        yield f"{path}:{code.count(chr(10), 0, found.start()) + 1}: {found.group()}: use {IO}"


def oracle_breaches(path, text):
    if path not in JUDGES:
        return
    code = COMMENT.sub(blank, text)
    for found in OF_THE_GATE.finditer(code):
        yield f"{path}:{code.count(chr(10), 0, found.start()) + 1}: {found.group()}: an oracle uses no formula of the gate"


def thread_breaches(path, text):
    if path.startswith("tests/") or path in THREAD:
        return
    code = COMMENT.sub(blank, text)
    for found in BY_THREAD.finditer(code):
        yield f"{path}:{code.count(chr(10), 0, found.start()) + 1}: {found.group()}: use {THREAD[0]}"


def throw_breaches(path, text):
    if path.startswith(("tests/", "tools/python/")):  # a module of Python raises what Python catches
        return
    code = COMMENT.sub(blank, text)
    for found in re.finditer(r"\bthrow\b", code):
        yield f"{path}:{code.count(chr(10), 0, found.start()) + 1}: throws: return a Result (model/result.h)"


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


def unbounded_loops(path, text):
    """A loop of an RT_SAFE function whose bound no reader sees in its head: neither a number nor a constant."""
    code, lines = COMMENT.sub(blank, text), text.split("\n")
    for found in re.finditer(r"\bRT_SAFE(?:\s+override|\s+final)*\s*\{", code):
        start = found.end() - 1
        for loop in LOOP.finditer(code, start, body_end(code, start)):
            number = code.count("\n", 0, loop.start())
            near = lines[max(0, number - 2):number + 2]
            if not HEAD_BOUND.search(loop.group(1)) and not any("bound:" in line for line in near):
                yield f"{path}:{number + 1}: a loop of an RT_SAFE function without a bound in its head: write // bound: ..."


def vouch_breaches(path, text):
    for what, (words, allowed) in VOUCHES.items():
        found = words.search(text)
        if found and str(path) not in allowed:
            yield f"{path}:{text.count(chr(10), 0, found.start()) + 1}: {what}; only the listed shims may"
        if not found and str(path) in allowed:
            yield f"{path}:1: is listed as a shim that {what}, and does not: take it off the list"


def transport_breaches(path, text_of, seen):
    """What a protocol file includes, itself or by way of another of ours."""
    seen.add(path)
    for number, line in enumerate(text_of(path).splitlines(), 1):
        found, ours = TRANSPORT.match(line), OURS.match(line)
        if found:
            yield f"{path}:{number}: transport in what a protocol file reads: <{found[1]}>"
        elif ours and ours[1] not in seen:
            yield from transport_breaches(ours[1], text_of, seen)


def unlicensed(path, text):
    is_source = not path.endswith(".txt") or path.endswith("CMakeLists.txt")
    if is_source and not any(LICENCE in line for line in text.splitlines()[:2]):
        yield f"{path}:1: begins without {LICENCE}"


def misnamed(path, text):
    """A header below the licence says its name and what it is; tools/rooms prints that."""
    name = path.rsplit("/", 1)[1]
    if path.endswith(".h") and not re.match(rf"// [^\n]*\n// {re.escape(name)} - \S", text):
        yield f"{path}:2: does not say what it is: // {name} - what"


def long_comments(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s*//", line) and len(line) > MAX_COLUMNS:
            yield f"{path}:{number}: a comment of {len(line)} columns: {MAX_COLUMNS} at most"


def protocol_files():
    """What of hal the fuzzers feed, with its headers."""
    for name in re.findall(r"hal/\S+\.cc", (ROOT / "tests/fuzz/CMakeLists.txt").read_text()):
        yield from (name, name.removesuffix("cc") + "h")


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    emulator = EMULATORS + "x.cc"
    texts = {"a.h": '#include "b.h"\n', "b.h": "#include <linux/can.h>\n"}
    cases = {
        "physics": foreign_breaches("model/x.cc", "#include <thread>\n"),
        "emulator and hal": foreign_breaches(emulator, '#include "hal/can/can_frame.h"\n'),
        "emulator and firmware": foreign_breaches(emulator, '#include "firmware/loop/clock.h"\n'),
        "emulator and model": foreign_breaches(emulator, '#include "model/contact/contact.h"\n'),
        "emulator and tests": foreign_breaches(emulator, '#include "tests/support/can_bench.h"\n'),
        "stream": io_breaches("tools/x.cc", "std::ifstream file(path);\n"),
        "number": io_breaches("tools/x.cc", "option->check(CLI::Range(0, 1));\n"),
        "parser": io_breaches("host/x.cc", "const auto j = nlohmann::json::parse(text);\n"),
        "JSON that may throw": io_breaches("tools/x/x.cc", "print(report.dump(2));\n"),
        "oracle": oracle_breaches("tests/support/gate_rules.h", "limits_in_use(limits, 1.0)"),
        "thread": thread_breaches("host/x.cc", "std::thread t(f);\n"),
        "thread of POSIX": thread_breaches("hal/x.cc", "pthread_create(&t, nullptr, f, nullptr);\n"),
        "throw": throw_breaches("tools/x.cc", "void f() { throw 1; }\n"),
        "real time": real_time_breaches("x.cc", "void f() RT_SAFE { new int; }\n"),
        "loop": unbounded_loops("x.cc", "void f(int n) RT_SAFE {\n\n\n  for (int i = 0; i < n; ++i) g();\n}\n"),
        "compiler": vouch_breaches("x.cc", '#pragma clang diagnostic ignored "-Wfunction-effects"\n'),
        "sanitizer": vouch_breaches("x.cc", "const __rtsan::ScopedDisabler off;\n"),
        "another's name": misnamed("a/x.h", f"// {LICENCE}\n// y.h - what\n"),
        "no name": misnamed("a/x.h", f"// {LICENCE}\n#pragma once\n"),
        "licence": unlicensed("x.cc", "#pragma once\n"),
        "wide comment": long_comments("x.cc", "// " + "x" * 98 + "\n"),
        "stale shim": vouch_breaches("firmware/loop/clock.cc", ""),
        "transport": transport_breaches("a.h", texts.get, set()),
        "libusb": transport_breaches("c.h", {"c.h": "#include <libusb-1.0/libusb.h>\n"}.get, set()),
        "gpiod": transport_breaches("c.h", {"c.h": "#include <gpiod.h>\n"}.get, set()),
        "socket": transport_breaches("c.h", {"c.h": "#include <sys/socket.h>\n"}.get, set()),
    }
    return [name for name, breaches in cases.items() if not list(breaches)]


def is_judged(path):
    """By its ending; a script without one by its first bytes."""
    if path.suffix in SOURCES + CONFIGURATION:
        return True
    return path.suffix == "" and path.is_file() and path.read_bytes()[:2] == b"#!"


def main():
    breaches, files, marks, texts = [], 0, 0, {}
    for top in (*TOPS, ".github"):
        for path in sorted((ROOT / top).rglob("*")):
            name = str(path.relative_to(ROOT))
            if "node_modules" in path.parts or not is_judged(path):
                continue
            text = path.read_text()
            if path.suffix == ".css" and text.count("\n") > MAX_LINES:
                breaches.append(f"{name}:1: longer than {MAX_LINES} lines: split it by panel")
            if path.suffix in CONFIGURATION:
                breaches += [] if name.startswith(UNSIGNED) else unlicensed(name, text)
                continue
            files += 1
            if text.count("\n") > MAX_LINES:
                breaches.append(f"{name}:1: longer than {MAX_LINES} lines: split it by idea")
            breaches += unlicensed(name, text)
            if name.startswith(rooms.PAGE) and path.suffix == ".ts":
                breaches += rooms.page_breaches(name, text)
            if path.suffix in (".h", ".cc"):  # clang-format leaves comments as they are
                breaches += long_comments(name, text)
                breaches += misnamed(name, text)
                breaches += throw_breaches(name, text)
                breaches += thread_breaches(name, text)
                breaches += oracle_breaches(name, text)
            if top != "tests" and (path.suffix in (".h", ".cc") or path.name == "CMakeLists.txt"):
                texts[name] = text
            if path.suffix in (".h", ".cc") and not name.startswith(CANARIES):
                marks += len(re.findall(r"\bRT_SAFE\b", text))
                breaches += foreign_breaches(name, text)
                breaches += rooms.part_breaches(name, text)
                breaches += real_time_breaches(name, text)
                breaches += unbounded_loops(name, text) if top == "hal" else []  # elsewhere tests/proof/bound asks
                breaches += io_breaches(name, text)
                breaches += vouch_breaches(name, text)
    breaches += rooms.breaches(texts)
    breaches += vouch_breaches("CMakeLists.txt", (ROOT / "CMakeLists.txt").read_text())
    protocols, seen = list(protocol_files()), set()
    for name in protocols:
        if name not in seen:
            breaches += transport_breaches(name, lambda path: (ROOT / path).read_text(), seen)
    print(*breaches, sep="\n", end="\n" if breaches else "")
    print(f"layering: {files} files, {marks} RT_SAFE marks, {len(breaches)} breaches")
    for rule in [*blind_rules(), *rooms.blind_rules()]:
        breaches.append(rule)
        print(f"layering: a breach of this rule is not seen: {rule}")
    if files < 50 or marks < 50 or len(protocols) < 20:
        print("layering: too few files or marks: the check does not see the tree")
        return 1
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
