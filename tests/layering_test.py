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
# The emulators stand on the other side of the kernel: what they shared with a driver they could not
# find wrong. Of ours they know the words of vectors alone.
EMULATORS = "tests/rig/emulators/"
CANARIES = "tests/canaries/"  # break the rules so that tests/canaries/run sees them told
ALLOWED_TO_EMULATORS = [EMULATORS, "model/types.h"]
# Where a call that the compiler or the real-time sanitizer cannot judge is vouched for.
VOUCHES = {
    "hides a call from the compiler's check": (
        re.compile(r'ignored\s+"-Wfunction-effects"|-Wno-function-effects'),
        {"firmware/clock.cc", "firmware/ring.cc", "hal/monotonic.h", "hal/gpio/gpio_lines.cc",
         "hal/can/can_socket.cc", "hal/falcon/usbfs_port.cc", "hal/falcon/libusb_pipe.cc",
         # broken devices and a fake kernel, which only tests have
         "tests/watched_loop.h", "tests/usbfs_bus.h"}),
    "hides a call from the real-time sanitizer": (
        re.compile(r"ScopedDisabler|__rtsan_disable|rtsan_interface|no_sanitize\w*\W+realtime"),
        {"hal/can/can_socket.cc"}),
}
# What carries bytes is no business of what reads them.
TRANSPORT = re.compile(r"\s*#include <((?:sys|linux|libusb[^/>]*)/[^>]+|(?:libusb|gpiod)[^>]*)>")
MAX_LINES = 300
OURS = re.compile(r'\s*#include "([^"]+)"')
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def blank(match):
    """Comments and strings keep their line breaks and lose their words."""
    return re.sub(r"[^\n]", " ", match.group())


def include_breaches(path, room, text):
    for number, line in enumerate(text.splitlines(), 1):
        if room == "model" and FOREIGN_TO_MODEL.match(line):
            yield f"{path}:{number}: model/ knows no thread, clock or descriptor: {line.strip()}"
        found = OURS.match(line)
        if not found:
            continue
        if str(path).startswith(EMULATORS):
            if not any(found[1].startswith(a) for a in ALLOWED_TO_EMULATORS):
                yield f"{path}:{number}: an emulator shares no code with tact: {found[1]}"
        elif not any(found[1].startswith(a) for a in ALLOWED[room]):
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


def protocol_files():
    """What of hal the fuzzers feed (CMakeLists.txt), with its headers."""
    listed = re.search(r"DECODER_SOURCES[^)]*\)", (ROOT / "CMakeLists.txt").read_text())[0]
    for pattern in re.findall(r"hal/\S+\.cc", listed):
        for path in sorted(ROOT.glob(pattern)):
            for name in (path, path.with_suffix(".h")):
                yield str(name.relative_to(ROOT))


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    emulator = EMULATORS + "x.cc"
    texts = {"a.h": '#include "b.h"\n', "b.h": "#include <linux/can.h>\n"}
    cases = {
        "room": include_breaches("model/x.cc", "model", '#include "hal/device.h"\n'),
        "physics": include_breaches("model/x.cc", "model", "#include <thread>\n"),
        "emulator and hal": include_breaches(emulator, "tests", '#include "hal/can/can_frame.h"\n'),
        "emulator and firmware": include_breaches(emulator, "tests", '#include "firmware/clock.h"\n'),
        "emulator and model": include_breaches(emulator, "tests", '#include "model/contact.h"\n'),
        "emulator and tests": include_breaches(emulator, "tests", '#include "tests/can_bench.h"\n'),
        "real time": real_time_breaches("x.cc", "void f() RT_SAFE { new int; }\n"),
        "compiler": vouch_breaches("x.cc", '#pragma clang diagnostic ignored "-Wfunction-effects"\n'),
        "sanitizer": vouch_breaches("x.cc", "const __rtsan::ScopedDisabler off;\n"),
        "stale shim": vouch_breaches("firmware/clock.cc", ""),
        "transport": transport_breaches("a.h", texts.get, set()),
        "libusb": transport_breaches("c.h", {"c.h": "#include <libusb-1.0/libusb.h>\n"}.get, set()),
        "gpiod": transport_breaches("c.h", {"c.h": "#include <gpiod.h>\n"}.get, set()),
        "socket": transport_breaches("c.h", {"c.h": "#include <sys/socket.h>\n"}.get, set()),
    }
    return [name for name, breaches in cases.items() if not list(breaches)]


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
            if path.suffix in (".h", ".cc") and not str(name).startswith(CANARIES):
                bodies += len(re.findall(r"\bRT_SAFE\b", text))
                breaches += include_breaches(name, room, text)
                breaches += real_time_breaches(name, text)
                breaches += vouch_breaches(name, text)
    breaches += vouch_breaches("CMakeLists.txt", (ROOT / "CMakeLists.txt").read_text())
    protocols, seen = list(protocol_files()), set()
    for name in protocols:
        if name not in seen:
            breaches += transport_breaches(name, lambda path: (ROOT / path).read_text(), seen)
    print(*breaches, sep="\n", end="\n" if breaches else "")
    print(f"layering: {files} files, {bodies} RT_SAFE marks, {len(breaches)} breaches")
    for rule in blind_rules():
        breaches.append(rule)
        print(f"layering: the rule on {rule} does not see a breach of it")
    if files < 50 or bodies < 50 or len(protocols) < 20:
        print("layering: too few files or marks: the check does not see the tree")
        return 1
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
