# SPDX-License-Identifier: Apache-2.0
"""The least law and size that is good enough, of a chart. tact-lab plan runs this; --help there says what.

    /usr/bin/python3 -I plan.py JOB.json

    enough   force_error <= wanted, shape_error <= wanted, tick p99.9 <= budget; of the whole tool the local error at the
             worst place and depth <= wanted, too
    least    by time, then by memory, then by the smaller force error

If none is enough, the nearest: the one whose worst excess over a limit, as a ratio, is smallest, then by time and memory; that
is said. Times of two within 10 % count as equal: a clock resolves no less, and the next measurement would turn them round.
Exit status: 0 good, 1 no law was measured or Ctrl-C, 2 bad input. tact-lab makes JOB.json.
"""
import hashlib
import json
import math
import pathlib
import sys

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "reference")]

import errors  # noqa: E402
import run  # noqa: E402
import tables  # noqa: E402
import tool  # noqa: E402

LABEL = "tact-lab plan"


def candidates_of(rows):
    """Tact's own that were measured; tactd has no peers. `local`: of the whole tool, None of one sphere."""
    for row in rows:
        if row["kind"] != "tact" or row["failure"] != "-":
            continue
        whole = math.isfinite(row["tool_rms_ratio"])
        size = "" if row["size"] == "as the scene says" else " " + row["size"]
        yield {"row": row, "law": row["family"], "name": row["family"] + size,
               "force": row["tool_rms_ratio" if whole else "force_rms_ratio"],
               "local": row["tool_own_worst_ratio"] if whole else None, "shape": row["shape_rms_ratio"],
               "us": row["tick_median_us"], "p999_us": row["tick_p999_us"], "bytes": row["memory_bytes"]}


def is_measured(c):
    return all(math.isfinite(c[name] or 0.0) for name in ("force", "local", "shape", "us", "p999_us"))


def excess_ratio(c, tolerance):
    """The largest of its errors and its time over their limits; at most 1: it is enough."""
    wanted = tolerance["force_error_ratio"]
    return max(c["force"] / wanted, (c["local"] or 0.0) / wanted, c["shape"] / tolerance["shape_error_ratio"],
               c["p999_us"] / tolerance["tick_budget_us"])


def text_of(c):
    force = (f"force of one sphere {100 * c['force']:.2g} %" if c["local"] is None else
             f"force of the whole tool {100 * c['force']:.2g} %, local error at worst {100 * c['local']:.2g} %")
    return (f"{c['name']}: {force}, shape {100 * c['shape']:.2g} %, {c['us']:.3g} us (p99.9 {c['p999_us']:.3g} us), "
            f"{1e-3 * c['bytes']:.3g} kB")


def lacks(c, tolerance):
    """What it lacks, each with its remedy."""
    force, shape, budget = (tolerance[name] for name in ("force_error_ratio", "shape_error_ratio", "tick_budget_us"))
    if c["force"] > force:
        yield (f"force error {c['force']:.3g} above tolerance.force_error_ratio = {force:.3g}: fit the law (tact-lab fit), "
               f"describe a nearer one ([compliance]) or allow {c['force']:.3g}")
    if (c["local"] or 0.0) > force:
        yield f"{c['local']:.3g} of the local force at the worst place, above tolerance.force_error_ratio"
    if c["shape"] > shape:
        yield (f"shape error {c['shape']:.3g} above tolerance.shape_error_ratio = {shape:.3g}: describe a law with a wider shape "
               f"([compliance]) or allow {c['shape']:.3g}")
    if c["p999_us"] > budget:
        yield f"p99.9 of {c['p999_us']:.3g} us above tolerance.tick_budget_us = {budget:.3g}: allow more or use a faster machine"


def least_of(candidates):
    """The fastest, memory deciding among times that do not differ."""
    fastest_us = min(c["us"] for c in candidates)
    return min((c for c in candidates if c["us"] <= (1.0 + errors.SAME_TIME_RATIO) * fastest_us),
               key=lambda c: (c["bytes"], c["force"]))


def choose(candidates, tolerance):
    """(chosen or None, runner-up or None, is it enough?, why)."""
    measured = [c for c in candidates if is_measured(c)]
    if not measured:
        return None, None, False, "no law of the scene could be measured"
    enough = [c for c in measured if excess_ratio(c, tolerance) <= 1.0]
    if not enough:
        least = min(excess_ratio(c, tolerance) for c in measured)
        chosen = least_of([c for c in measured if excess_ratio(c, tolerance) <= least])
        return chosen, None, False, (f"no law meets [tolerance]; nearest is {text_of(chosen)}. "
                                     f"{'; '.join(lacks(chosen, tolerance))}")
    chosen = least_of(enough)
    why = (f"{len(enough)} of {len(candidates)} measured laws and sizes meet [tolerance]; of these it is the fastest, within "
           f"{100 * errors.SAME_TIME_RATIO:g} % the smallest. {text_of(chosen)}")
    # One of another law says more than another size of the same.
    others = [c for c in enough if c["law"] != chosen["law"]] or [c for c in enough if c is not chosen]
    if not others:
        return chosen, None, True, why
    runner_up = least_of(others)
    return chosen, runner_up, True, f"{why}. Runner-up: {text_of(runner_up)}"


def check_fits(rows, job):
    """The chart of another scene or machine: its times say nothing here."""
    again = f"tact-lab chart {job['scene']} --reference FILE --out DIR"
    for row in (row for row in rows if row["kind"] != "peer"):  # peers are not chosen, and were measured elsewhere
        # Before the machine: a changed scene is the likelier slip, and its remedy the same.
        if row["scene_hash"] != job["provenance"]["scene"]:
            raise run.Failure(f"{job['chart']}: the chart of another scene, or of this one before a change; chart it again: "
                              f"{again}")
        if row["machine"] != tables.word(job["provenance"]["machine"]):
            raise run.Failure(f"{job['chart']}: measured on another machine, {row['machine']}; chart it here: {again}")


def plan_text(chosen, job):
    """As model/scene/plan_file.h reads it, sealed as TOML is (model/io/seal.h)."""
    row, here = chosen["row"], job["provenance"]
    sizes = {"table_knots": row["table_knots"], job["size_keys"][chosen["law"]]: row["size_count"]}
    lines = ['# What tact-lab plan chose; tactd reads it for a scene with law = "auto".', f'law = "{chosen["law"]}"']
    lines += [f'disc_form = "{row["form"]}"'] if row["form"] != "-" else []
    lines += [f"{key} = {count:.0f}" for key, count in sizes.items() if key and count]
    lines += [f"{key} = {chosen[name]:.6g}" for key, name in
              (("tick_p999_us", "p999_us"), ("force_error_ratio", "force"), ("shape_error_ratio", "shape"))]
    lines += [f'machine = "{here["machine"]}"', f'scene_hash = "{here["scene"]}"', ""]
    text = "\n".join(lines)
    return f'{text}sha256 = "{hashlib.sha256(text.encode()).hexdigest()}"\n'


def keep(chosen, job):
    """Writes the plan that tactd reads, or removes the one without a measurement; what was written."""
    if not job["plan"]:
        return ""
    path = pathlib.Path(job["plan"])
    if not chosen:
        path.unlink(missing_ok=True)
        return ""
    path.parent.mkdir(parents=True, exist_ok=True)
    run.write(path, plan_text(chosen, job))
    return job["plan"]


def document(c):
    return {"law": c["law"], "name": c["name"], "judged": "one sphere" if c["local"] is None else "whole tool",
            "force_error_ratio": c["force"], "own_error_ratio": c["local"], "shape_error_ratio": c["shape"],
            "tick_median_us": c["us"], "tick_p999_us": c["p999_us"], "memory_bytes": c["bytes"]}


def act(job):
    if "table" in job:
        rows = tables.read_rows(job["table"], job["chart"])
        check_fits(rows, job)
    else:
        rows = [tables.chart_row(row, job) for row in job["rows"]]
    candidates = list(candidates_of(rows))
    if job["has_blade"]:  # only springs can be cut
        candidates = [c for c in candidates if c["law"] == "spring_patch"]
        if not candidates:
            raise run.Failure(f"{job['scene']}: tool.blade cuts nothing but spring_patch; write [spring_patch]")
    chosen, runner_up, meets, why = choose(candidates, job["tolerance"])
    written = keep(chosen, job)
    if job["json"]:
        found = {"format": "tact-plan", "version": 1, "meets": meets, "reason": why}
        found |= {name: document(c) for name, c in (("chosen", chosen), ("runner_up", runner_up)) if c}
        text = json.dumps(found | ({"plan": written} if written else {}), indent=2, ensure_ascii=False)
    else:
        one_sphere = candidates and candidates[0]["local"] is None
        text = "\n".join([chosen["name"] if chosen else "no law was measured", why,
                          *(["Evaluated by one sphere, as no --tool-reference was given: a tool of several may be farther off."]
                            if one_sphere else []), *tool.dropped_text(job).splitlines(), *([written] if written else [])])
    print(text, flush=True)
    return 0 if chosen else 1


if __name__ == "__main__":
    sys.exit(run.main(LABEL, act, "the plan is as it was"))
