# SPDX-License-Identifier: Apache-2.0
"""report.html of jitter.json: the answer, the histogram, durations, late ticks, the PC. tact-jitter starts this;
`python3 jitter_page.py DIR` makes the page and its picture again."""
import math
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # where page.py lies, built and installed

import page  # noqa: E402

SHARES = ("p50", "p90", "p99", "p99.9", "p99.99", "p99.999")
DRAWN = ("wake", "peer_wake", "total", "deadline_to_force")
LISTED = 20  # late ticks
FIRST_US, PER_DECADE = 0.1, 20  # below lies the clock's own reading; twenty buckets a decade show a width of 12 %


def in_us(duration_ns):
    """Three digits: more would be the clock's noise."""
    if duration_ns is None:
        return "-"
    us = 1e-3 * duration_ns
    return f"{us:.0f}" if us >= 100 else f"{us:.3g}"


def histogram_csv(all_series, keys):
    """Both axes are logarithmic: from_us, then the samples of each series."""
    samples = []
    for key in keys:
        bins = {}
        for low_ns, high_ns, count in all_series[key]["buckets_ns"]:
            us = max(1e-3 * ((low_ns + high_ns) // 2), FIRST_US)
            # A value on an edge belongs to the bucket above it, for any rounding of the logarithm.
            at = int(math.log10(us / FIRST_US) * PER_DECADE + 1e-9)
            bins[at] = bins.get(at, 0) + count
        samples.append(bins)
    last = max((max(bins, default=-1) for bins in samples), default=-1) + 1  # empty: steps end there
    rows = [["from_us", *keys]]
    rows += [[f"{FIRST_US * 10 ** (at / PER_DECADE):.6g}", *(str(bins.get(at, 0)) for bins in samples)]
             for at in range(last + 1)]
    return "".join(",".join(row) + "\n" for row in rows)


def picture_of(data, folder):
    keys = [key for key in data["series_order"] if key in DRAWN]
    page.write(folder / "histogram.csv", histogram_csv(data["series"], keys))
    return page.draw(
        folder, "histogram", "histogram.gp", width_px=1000, height_px=520,
        run=f"{data['ticks']} ticks at {data['rate_Hz']:g} Hz, {'load ' + data['load'] if data['load'] else 'idle'}",
        series=[data["series"][key]["title"] for key in keys],
        peer=keys.index("peer_wake") + 1 if "peer_wake" in keys else 0)


def series_row(key, one):
    cells = [one["samples"], *(in_us(one[f"{share}_ns"]) for share in SHARES), in_us(one["max_ns"])]
    # cyclictest reports buckets: no tick and no time.
    cells += ["", ""] if key == "peer_wake" else [f"{one['max_at_s']:.3f}", one["max_tick"]]
    return {"title": one["title"], "cells": cells}


def late_row(late):
    return {"why": late["kernel_counted"], "at_s": f"{late['at_s']:.3f}", "tick": late["tick"],
            "worst_us": in_us(late["deadline_to_force_ns"]), "wake_us": in_us(late["phases_ns"]["wake"]),
            "skipped": late["skipped_before"]}


def costs(thread, kernel):
    def count(value):
        return "not readable here" if value is None else value
    yield "heap calls of the loop", "not counted" if thread["allocations"] is None else thread["allocations"]
    yield "page faults, minor and major", f"{thread['minor_page_faults']} and {thread['major_page_faults']}"
    yield "switches, its own and forced", (f"{thread['voluntary_context_switches']} and "
                                           f"{thread['involuntary_context_switches']}")
    yield "migrations to another core", count(kernel["migrations"])
    yield "us ready while another ran", count(kernel["waited_ns"] if kernel["waited_ns"] is None else in_us(kernel["waited_ns"]))
    yield "ms taken by a hypervisor, whole core", count(kernel["steal_ms"])
    yield "system management interrupts", count(kernel["smi"])
    for source, number in sorted(kernel["interrupts"].items(), key=lambda one: (one[1], one[0]), reverse=True):
        yield "interrupts of its core: " + source, number


def facts(pc):
    yield "kernel", f"{pc['kernel_release']} {pc['kernel_version']}"
    yield "booted with", pc["boot_parameters"]
    yield "CPU", f"{pc['cpu']}, microcode {pc['microcode']}, {pc['cores']} online"
    yield "clock", pc["clock_source"]
    yield "tact", pc["git_revision"]
    yield "compiler", pc["compiler"]
    yield "scene", pc["scene_hash"] or "none"


def peer_of(data):
    if data["compared_with_peer"] is None:
        return None
    gate = data["peer_gate"]
    colors = {None: "unknown", True: "green", False: "red"}  # too few turns are neither green nor red
    return {"compared": data["compared_with_peer"],
            "gate": gate and {"color": colors[gate["passed"]], "sentence": gate["sentence"]}}


def rows(pairs):
    return [{"name": name, "value": value} for name, value in pairs]


def html_of(data, picture):
    late = data["late_ticks"][:LISTED]
    return page.page_of("jitter.html", data | {
        "histogram": page.inline_svg(picture, 0) if picture else "", "columns": ["samples", *SHARES, "largest", "at, s", "tick"],
        "cpu": data["environment"]["cpu"], "series": [series_row(key, data["series"][key]) for key in data["series_order"]],
        "late_ticks": data["over_threshold"], "threshold_us": in_us(data["threshold_ns"]), "late_listed": len(late),
        "has_marker": data["marked_in_ftrace"], "has_late": bool(late), "late": [late_row(one) for one in late],
        "costs": rows(costs(data["thread"], data["kernel"])), "facts": rows(facts(data["environment"])), "peer": peer_of(data)})


if __name__ == "__main__":
    sys.exit(page.main("tact-jitter", "jitter.json", "report.html", picture_of, html_of))
