# SPDX-License-Identifier: Apache-2.0
"""The picture of tact-lab fit or sweep, by gnuplot, and then what they print. They run this; --help there says what.

    /usr/bin/python3 -I picture.py JOB.json

JOB.json: who prints, folder and name of the picture, script, its variables; the text to print, the exit status of a good end.
"""
import json
import pathlib
import sys

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER.parent / "reference"), str(FOLDER.parent / "report")]

import page  # noqa: E402
import run  # noqa: E402


def act(job):
    try:
        page.draw(pathlib.Path(job["folder"]), job["name"], FOLDER / job["script"], **job["variables"])
    except (page.Failure, OSError) as failure:
        raise run.Failure(str(failure)) from None
    print(job["text"], end="", flush=True)
    return job["status"]


if __name__ == "__main__":
    label = json.loads(pathlib.Path(sys.argv[1]).read_text())["label"]
    sys.exit(run.main(label, act, "the tables are written, the picture may not be"))
