# SPDX-License-Identifier: Apache-2.0
"""The chart as rows, CSV, JSON and text. Numbers have six digits, so CSV and JSON agree."""
import json
import math

import errors
import run

AGAIN = "make it again: tact-lab chart SCENE --reference FILE --out DIR"
WORDS = ("kind", "family", "size", "form", "given", "failure", "scene_hash", "reference_hash", "revision", "machine")
SIZES = ("table_knots", "size_count")
TIMES = ("tick_median_us", "tick_p999_us", "instructions", "ticks", "paused")


def cell_text(cell):
    return cell if isinstance(cell, str) else f"{cell + 0.0:.6g}"  # no -0


def word(text):
    """A cell of CSV."""
    return text.translate(str.maketrans(',"\n', ";;;")) or "-"


def number(value):
    """null of a job and a word of a chart, as inf, are not measured."""
    return value if isinstance(value, (int, float)) else math.nan


def chart_row(measured, job):
    """One law and size, by its columns."""
    here, noticeable = job["provenance"], job["noticeable_ratio"]
    found = errors.summarize(measured["samples"], noticeable)
    tool = {"force_rms_ratio": math.nan, "own_largest_ratio": math.nan}
    if measured["tool_N"]:
        tool = errors.summarize_tool(errors.tool_samples(measured["tool_N"], job["places"]), noticeable)
    shape = {name: found.pop(name) for name in ("shape_rms_ratio", "shape_worst_ratio", "cases")}
    numbers = {**found, "tool_rms_ratio": tool["force_rms_ratio"], "tool_own_worst_ratio": tool["own_largest_ratio"], **shape,
               **{name: number(measured[name]) for name in ("settle_ticks", "memory_bytes")}}
    times = {name: number(measured[name]) for name in TIMES}
    if measured["failure"]:  # a zero would look like the best of all
        numbers, times = dict.fromkeys(numbers, math.nan), dict.fromkeys(times, math.nan)
    return {"kind": "tact", "family": measured["family"], "size": measured["size"], "form": word(measured["form"]),
            **{name: measured[name] for name in SIZES}, **numbers, "given": "parameters of the scene",
            "failure": word(measured["failure"]), "scene_hash": here["scene"], "reference_hash": here["reference"],
            "revision": word(here["revision"]), "machine": word(here["machine"]), **times}


def read_rows(rows, path):
    """Those of a chart.json, which may come from anywhere."""
    columns = (*WORDS, *SIZES, *TIMES, "force_rms_ratio", "own_worst_ratio", "tool_rms_ratio", "tool_own_worst_ratio",
               "shape_rms_ratio", "memory_bytes")
    for row in rows:
        for column in columns:
            if column not in row or (column in WORDS and not isinstance(row[column], str)):
                raise run.Failure(f"{path}: a row has no {column}; {AGAIN}")
    return [{name: cell if name in WORDS else number(cell) for name, cell in row.items() if name != "job"} for row in rows]


def local_error(row):
    """The largest of any press, of the force there: of the whole tool where it was measured, else of one sphere."""
    tool = row["tool_own_worst_ratio"]
    return tool if math.isfinite(tool) else row["own_worst_ratio"]


def front_rows(rows):
    """Those of tact that no other law beats in time and local error, fastest first. Of two within 10 % of each other in time
    the nearer one stays."""
    laws = [row for row in rows if row["kind"] == "tact"]
    front = errors.front_of([(row["tick_median_us"], local_error(row)) for row in laws])
    kept = []
    for row in (laws[i] for i in reversed(front)):  # from the slow end: each against the last that stayed
        if not kept or (1.0 + errors.SAME_TIME_RATIO) * row["tick_median_us"] < kept[-1]["tick_median_us"]:
            kept.append(row)
    return kept[::-1]


def peers_ahead(rows):
    """Peers that beat a law of the front under one sphere in both, by however little; empty is what tact promises."""
    def point(row):
        return row["tick_median_us"], row["own_worst_ratio"]
    laws = [point(row) for row in rows if row["kind"] == "tact"]
    front = [laws[i] for i in errors.front_of(laws)]
    return [row for row in rows if row["kind"] == "peer" and any(point(row)[0] < us and point(row)[1] < error
                                                                 for us, error in front)]


def source_of_peers(rows):
    """Where and when they were measured; empty without peers."""
    return next((f"peers: measured before, by revision {row['revision']}, on {row['machine']}"
                 for row in rows if row["kind"] == "peer"), "")


def csv_text(rows, job):
    here = job["provenance"]
    head = {"command": job["command"], **{name: here[name] for name in ("scene", "reference", "revision", "machine")}}
    lines = [f"# {name}: {value}" for name, value in head.items()]
    lines.append(",".join(["job", *(rows[0] if rows else [])]))
    lines += [",".join([str(k), *map(cell_text, row.values())]) for k, row in enumerate(rows)]
    return "\n".join(lines) + "\n"


def json_text(form, version, rows, job, **more):
    here = job["provenance"]

    def cell(value):
        text = cell_text(value)
        return text if isinstance(value, str) or not math.isfinite(value) else float(text)
    return json.dumps({"format": form, "version": version, "command": job["command"], "scene": here["scene"],
                       "reference": here["reference"], "revision": here["revision"], "machine": here["machine"], **more,
                       "rows": [{"job": k, **{name: cell(value) for name, value in row.items()}} for k, row in enumerate(rows)]},
                      indent=1, ensure_ascii=False) + "\n"


# Column of the text: head, width, column of the row, factor, decimals.
TEXT = [("force %", 8, "force_rms_ratio", 100, 2), ("worst %", 8, "force_worst_ratio", 100, 2),
        ("held o %", 8, "held_out_rms_ratio", 100, 2), ("1 mm", 7, "own_worst_1mm_ratio", 100, 1),
        ("2 mm", 7, "own_worst_2mm_ratio", 100, 1), ("5 mm", 7, "own_worst_5mm_ratio", 100, 1),
        ("10 mm", 7, "own_worst_10mm_ratio", 100, 1), ("in JND %", 8, "within_jnd_ratio", 100, 0),
        ("shape %", 8, "shape_rms_ratio", 100, 2), ("tool %", 7, "tool_rms_ratio", 100, 2),
        ("local %", 7, "tool_own_worst_ratio", 100, 1), ("median us", 9, "tick_median_us", 1, 3),
        ("p99.9 us", 9, "tick_p999_us", 1, 3), ("instr.", 8, "instructions", 1, 0), ("memory kB", 9, "memory_bytes", 1e-3, 1)]


def shown(value, factor, decimals):
    return f"{factor * value:.{decimals}f}" if math.isfinite(value) else "-"


def chart_text(rows):
    """For a terminal; the front is marked."""
    front = front_rows(rows)
    lines = [" ".join([f"{'law and size':<40}", *(f"{head:>{width}}" for head, width, *_ in TEXT)])]
    for row in rows:
        mark = "peer " if row["kind"] == "peer" else "* " if any(row is other for other in front) else "  "
        name = f"{mark}{row['family']} {row['size']}"
        if row["failure"] != "-":
            lines.append(f"{name:<40} not measured: {row['failure']}")
            continue
        cells = (f"{shown(row[column], factor, decimals):>{width}}" for _, width, column, factor, decimals in TEXT)
        lines.append(" ".join([f"{name:<40}", *cells]))
    lines += [source_of_peers(rows)] if source_of_peers(rows) else []
    return "\n".join([*lines, "* on the front of tact: no other law is both faster and, at its largest local error, nearer.",
                      "The reference is linear: compliance is checked with large_strain off.",
                      "force, worst: one sphere, of the peak; 1 mm and so on: of the local force at the worst site.",
                      "tool, local: the whole tool, RMS of the peak and the largest local error.",
                      "Time of a law: detect, render, limit of the whole tool; of a peer: its own answer to one sphere.",
                      "instr. -: too many to step through, and this processor lets no user count."]) + "\n"
