# SPDX-License-Identifier: Apache-2.0
"""What the tables of tact-lab stability show, reported and drawn. It runs this; --help there says what.

    /usr/bin/python3 -I stability.py JOB.json

Exit status: 0 good, 1 a finding is false or Ctrl-C, 2 bad input. tact-lab makes JOB.json: the options, the rows of each table
that it has written, and what ended it before the last one.
"""
import json
import os
import pathlib
import sys

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "reference"), str(FOLDER.parent / "report")]

import findings  # noqa: E402
import page  # noqa: E402
import run  # noqa: E402

LABEL = "tact-lab stability"
SIZES_PX = {"integrators": (1600, 850), "law_limits": (1600, 800), "law_lines": (1400, 1000), "loop": (1400, 1050),
            "loop_laws": (1200, 800), "ticks": (1200, 700), "loss": (1200, 800)}  # of the maps that have a picture


def variables_of(name, rows, facts):
    """What the script of this map reads besides the table."""
    if name in ("law_limits", "loop_laws"):
        return {"laws": list(dict.fromkeys(row["law"] for row in rows))}
    if name != "integrators":
        return {}
    lines = "".join(f"{method},{z_max:.5g},{zeta:.5g}\n" for method, z_max, zeta in facts["theory"])
    return {"methods": list(dict.fromkeys(row["method"] for row in rows)), "$theory": "method,z_max,zeta\n" + lines,
            "cell_z": min(row["z"] for row in rows), "cell_zeta": min(row["zeta"] for row in rows if row["zeta"] > 0)}


def drawn(one, out):
    """Their paths."""
    name = one["map"]
    if name not in SIZES_PX:
        return []
    width_px, height_px = SIZES_PX[name]
    page.draw(pathlib.Path(out), name, FOLDER / f"{name}.gp", width_px=width_px, height_px=height_px,
              **variables_of(name, one["rows"], one["facts"]))
    return [os.path.join(out, f"{name}.{kind}") for kind in ("svg", "png")]


def text_of(reports):
    lines = []
    for report in reports:
        lines += [f"{report['map']}: {report['rows']} rows"]
        lines += [f"  {'ok  ' if one['holds'] else 'FAIL'}  {one['sentence']}" for one in report["findings"]]
        lines += [f"  {file}" for file in report["files"]]
    return "".join(line + "\n" for line in lines)


def json_of(reports):
    whole = {"format": "tact-stability", "version": 1, "maps": reports}
    return json.dumps(whole, indent=2, sort_keys=True, ensure_ascii=False) + "\n"


def act(job):
    reports = [{"map": one["map"], "rows": len(one["rows"]), "files": one["files"],
                "findings": findings.findings_of(one["map"], one["rows"], one["facts"])} for one in job["maps"]]
    try:
        for report, one in zip(reports, job["maps"] if job["draw"] else []):
            report["files"] += drawn(one, job["out"])
    except (page.Failure, OSError) as failure:
        raise run.Failure(str(failure)) from None
    finally:  # maps that were finished are reported even if a later one failed
        print(json_of(reports) if job["json"] else text_of(reports), end="", flush=True)
    if job["interrupted"]:
        print(f"{LABEL}: interrupted; {len(reports)} maps are written", file=sys.stderr)
        return 1
    if job["failure"]:
        raise run.Failure(job["failure"])
    return 0 if all(one["holds"] for report in reports for one in report["findings"]) else 1


if __name__ == "__main__":
    sys.exit(run.main(LABEL, act, "the tables are written, the pictures may not be"))
