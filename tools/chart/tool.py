# SPDX-License-Identifier: Apache-2.0
"""The whole tool under each law as the scene has it: tool.csv, tool.json, SCENE.accuracy and text."""
import datetime
import math

import errors
import tables


def laws_of(job):
    """(what was measured, its samples, its errors); of a law that failed two None."""
    for row in job["rows"]:
        samples = None if row["failure"] else errors.tool_samples(row["tool_N"], job["places"])
        yield row, samples, samples and errors.summarize_tool(samples, job["noticeable_ratio"])


def rows_of(laws):
    """One for each law, place and depth."""
    return [{"law": row["family"], "place": s["place"], "depth_m": s["depth_m"], "force_N": s["force_N"],
             "reference_N": s["reference_N"], "own_error_ratio": s["local"],
             "reference_error_ratio": tables.number(s["reference_error_ratio"])}
            for row, samples, _ in laws for s in samples or []]


def plain(value):
    """NaN, as of no unseen place, is null."""
    return value if value is not None and math.isfinite(value) else None


def summary_of(row, found):
    if row["failure"]:
        return {"law": row["family"], "failure": row["failure"]}
    return {"law": row["family"],
            **{name: plain(found[name]) for name in ("force_rms_ratio", "force_worst_ratio", "unseen_rms_ratio",
                                                     "within_jnd_ratio")},
            "own_worst_ratio_at_mm": {f"{1e3 * depth:g}": own for depth, own in found["own_worst_ratio"].items()},
            "place_rms_ratio": found["place_rms_ratio"],
            **{name: plain(row[name]) for name in ("tick_median_us", "tick_p999_us", "instructions")}}


def json_text(laws, job):
    return tables.json_text("tact-tool-chart", 2, rows_of(laws), job, dropped=job["dropped"],
                            laws=[summary_of(row, found) for row, _, found in laws])


def dropped_text(job):
    """For a terminal: the places that do not count, each with its reason."""
    return "".join(f"{at['place']} does not count: at {1e3 * at['depth_m']:g} mm the linear force is "
                   f"{100 * at['linear_error_ratio']:+.1f} % off that at finite strain\n" for at in job.get("dropped", []))


def reference_text(job):
    places, dropped = len(job["places"]), len(job["dropped"])
    left = f", {dropped} left out by finite strain" if dropped else ""
    return f"linear finite elements at {places} places{left}"


def accuracy_text(laws, job):
    """What tactd --check may report of each law that was measured (model/scene/accuracy_file.h)."""
    out = '# How true the force of the whole tool is: tact-lab chart --tool-reference\nschema = "tact-accuracy/2"\n'
    for row, _, found in laws:
        if row["failure"]:
            continue
        own = found["own_worst_ratio"]
        out += (f'\n[{row["family"]}]\nlaw_hash = "{row["law_hash"]}"\n'
                f'reference = "{reference_text(job)}"\n'
                f'date = "{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}"\n'
                f'{"large_strain_off = true  # the scene has it on" + chr(10) if row["large_strain_off"] else ""}'
                f'force_rms_ratio = {found["force_rms_ratio"]:.4f}  # of the peak\n'
                f'within_noticeable_ratio = {found["within_jnd_ratio"]:.4f}  # share of places and depths\n'
                f'depth_m = [{", ".join(map(repr, own))}]\n'
                f'own_worst_ratio = [{", ".join(f"{value:.4f}" for value in own.values())}]'
                "  # of the force at the same place and depth\n")
    return out


def text(laws, places):
    """For a terminal: each law, then its local error at each place and depth."""
    depths = [f"{1e3 * case['depth_m']:g} mm" for case in places[0]["cases"]]
    lines = [f"{'law':<14} {'RMS %':>8} {'worst %':>8} {'unseen %':>9}" + "".join(f" {mm:>8}" for mm in depths) +
             f" {'median us':>10} {'p99.9 us':>9} {'instr.':>8}"]
    for row, samples, found in laws:
        if row["failure"]:
            lines.append(f"{row['family']:<14} not measured: {row['failure']}")
            continue
        rms, worst, unseen = (100 * found[name] for name in ("force_rms_ratio", "force_worst_ratio", "unseen_rms_ratio"))
        instructions = tables.shown(tables.number(row["instructions"]), 1, 0)
        lines.append(f"{row['family']:<14} {rms:>8.2f} {worst:>8.2f} {unseen:>9.2f}" +
                     "".join(f" {100 * own:>+8.1f}" for own in found["own_worst_ratio"].values()) +
                     f" {row['tick_median_us']:>10.3f} {row['tick_p999_us']:>9.3f} {instructions:>8}")
        for place, of_place in found["place_rms_ratio"].items():
            lines.append(f"  {place:<12} {100 * of_place:>8.2f} {'':>8} {'':>9}" +
                         "".join(f" {100 * s['local']:>+8.1f}" for s in samples if s["place"] == place))
    return "\n".join([*lines, "RMS and worst: % of the largest force of the reference, at a place % of its own largest.",
                      "1 mm and so on: % of the local force there, for a law the worst place's. Time: detect, render, limit.",
                      ""])
