# SPDX-License-Identifier: Apache-2.0
"""What an elastic organ does under the scene's tool, by finite elements. tact-lab reference runs this; --help there says what.

    /usr/bin/python3 -I reference.py JOB.json

Exit status: 0 good, 1 a check failed or Ctrl-C, 2 bad input. job.py says what JOB.json holds.
"""
import json
import os
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import run  # noqa: E402


def main():
    run.watch_signals()  # the first Ctrl-C may come while numpy is read
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # one core a job
    kept = "what was solved is kept, the same command goes on from there"
    try:
        asked = json.loads(pathlib.Path(sys.argv[1]).read_text())
        if asked["self_check"]:
            kept = "nothing was written"
        import job
        return job.act(asked)
    except run.Failure as failure:
        message, status = failure.message, 2
    except ImportError as missing:
        message, status = f"{missing.name} is missing in Debian's python3; apt install python3-numpy python3-scipy", 2
    except OSError as error:  # every other file is looked after where it is used
        message, status = f"standard output cannot be written: {error.strerror}; check where it goes", 2
    except KeyboardInterrupt:
        message, status = f"interrupted; {kept}", 1
    print(f"tact-lab reference: {message}", file=sys.stderr, flush=True)
    os._exit(status)  # what cannot be written is not tried again


if __name__ == "__main__":
    sys.exit(main())
