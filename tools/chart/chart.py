# SPDX-License-Identifier: Apache-2.0
"""What tact-lab chart measured, compared with the reference, written and drawn. It runs this; --help there says what.

    /usr/bin/python3 -I chart.py JOB.json

Exit status: 0 good, 1 a peer is ahead or Ctrl-C, 2 bad input. tact-lab makes JOB.json: the options, the forces and
times of each law and size, the places and forces of the reference.
"""
import pathlib
import sys

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "reference")]

import run  # noqa: E402
import tables  # noqa: E402
import tool  # noqa: E402

LABEL = "tact-lab chart"


def write(job, name, csv, json):
    """NAME.csv and NAME.json; their paths."""
    paths = [pathlib.Path(job["out"]) / f"{name}.{kind}" for kind in ("csv", "json")]
    for path, text in zip(paths, (csv, json)):
        run.write(path, text)
    return paths


def make_tool(job):
    laws = list(tool.laws_of(job))
    text = tool.json_text(laws, job)
    write(job, "tool", tables.csv_text(tool.rows_of(laws), job), text)
    if job["accuracy"]:
        run.write(pathlib.Path(job["accuracy"]), tool.accuracy_text(laws, job))
    print(text if job["json"] else tool.text(laws, job["places"]) + tool.dropped_text(job), end="", flush=True)
    return 0


def make_chart(job):
    if all(row["failure"] for row in job["rows"]):  # one message instead of a table of failures
        raise run.Failure(job["rows"][0]["failure"])
    rows = [tables.chart_row(row, job) for row in job["rows"]] + tables.read_rows(job["peers"], "--peers")
    text = tables.json_text("tact-chart", job["version"], rows, job, dropped=job.get("dropped", []))
    files = write(job, "chart", tables.csv_text(rows, job), text)
    if job["draw"]:
        import picture
        files += picture.draw(rows, job)
    shown = tables.chart_text(rows) + tool.dropped_text(job) + "".join(f"{file}\n" for file in files)
    print(text if job["json"] else shown, end="", flush=True)
    ahead = tables.peers_ahead(rows)  # tact's own promise: where a peer beats it, the check fails
    for row in ahead:
        print(f"{LABEL}: the peer {row['family']} {row['size']} is both faster and nearer than tact's front", file=sys.stderr)
    return 1 if ahead else 0


def act(job):
    return make_chart(job) if "peers" in job else make_tool(job)


if __name__ == "__main__":
    sys.exit(run.main(LABEL, act, "the tables may be written, the pictures are not"))
