# SPDX-License-Identifier: Apache-2.0
"""The table in hal/README.md of what a device costs a tick, made from the baseline of the bench."""
from bench.baseline import read, read_cycles

# back end: its name for a reader, and the system calls of the loop's thread and of its own
CAUSES = {
    "sim-delta": ("`sim-delta`", "0"),
    "sim-delta with lines": ("`sim-delta` with safety lines", "2 ioctl (4 with a scope line)"),
    "odrive06": ("`can-odrive`, 0.6", "recvmmsg, sendmmsg"),
    "odrive05": ("`can-odrive`, 0.5", "recvmmsg, sendmmsg"),
    "cia402": ("`can-cia402`", "recvmmsg, sendmmsg"),
    "moteus": ("`can-moteus`", "recvmmsg, sendmmsg"),
    "falcon": ("`falcon`", "1 ioctl; its thread 3"),
    "force-dimension": ("`force-dimension`, stub", "0; its thread the library's"),
    "phantom": ("`phantom`, stub", "0; its thread the library's"),
}


def table(baseline):
    """Markdown: a row for each device, in us."""
    known, cycles = read(baseline)[0], read_cycles(baseline)
    lines = ["| back end | system calls a tick | tick, median / 99.9 % / longest | read | write | "
             "bus cycle, median / 99 %; the emulator's part |", "|---|---|---|---|---|---|"]
    for name, (words, calls) in CAUSES.items():
        if name in known:
            of = known[name]
            tick = " / ".join(us(of["total"].get(key)) for key in ("median_ns", "p99.9_ns", "longest_ns"))
            lines.append(f"| {words} | {calls} | {tick} us | {us(of['read']['median_ns'])} us | "
                         f"{us(of['write']['median_ns'])} us | {cycle(cycles.get(name))} |")
    return "\n".join(lines) + "\n"


def us(of_ns):
    return "-" if of_ns is None else f"{of_ns / 1000:.1f}"


def cycle(of):
    return "-" if of is None else f"{of['median_us']} / {of['p99_us']} us, {of['own_us']} us of it"
