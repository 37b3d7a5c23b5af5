#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""From a tick log, or from the tactd that runs, to pictures: the force in time; of a log also how long a tick takes.

    tactd SCENE --seconds 20 --record run.tactlog
    python3 example.py run.tactlog --out .
    python3 example.py --seconds 10 --out .          # while tactd runs

Run it as a whole, or cell by cell (# %%) in an editor that knows them. Needs numpy and matplotlib.
"""
# %% Read
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    import numpy as np
    import tact
except ImportError as error:
    sys.exit(f"example.py: {error}; apt install python3-matplotlib for Debian's python3, else pip install matplotlib")

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("log", nargs="?", help="of tactd --record, or a black box; without it the tactd that runs")
parser.add_argument("--seconds", type=float, default=10.0, help="of the tactd that runs")
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder for force.png and ticks.png")
arguments = parser.parse_args()


def frames_of(live):
    frames = []
    for frame in live:
        frames.append(frame)
        if frame["time_ns"] - frames[0]["time_ns"] >= 1e9 * arguments.seconds:
            break
    return np.array(frames)


try:
    log = tact.read_ticks(arguments.log) if arguments.log else None
    source = log or tact.live(timeout_s=5.0)
    run = log.ticks if log else frames_of(source)
except tact.Error as error:
    sys.exit(f"example.py: {error}")
if log and log.damage:
    print(f"example.py: {log.damage}; what is good of it follows", file=sys.stderr)
if not len(run):
    sys.exit(f"example.py: {arguments.log or 'tactd'}: no good tick")
time_s = log.time_s if log else 1e-9 * (run["time_ns"] - run["time_ns"][0])


def keep(picture, name):
    try:
        arguments.out.mkdir(parents=True, exist_ok=True)
        picture.savefig(arguments.out / name, dpi=120)
    except OSError as error:
        sys.exit(f"example.py: {arguments.out / name}: {error.strerror}; give another folder with --out")


# %% Force in time: what the law asked for, and what the gate let through
wanted_N = np.linalg.norm(run["wanted_force_N"], axis=1)
written_N = np.linalg.norm(run["force_N"], axis=1)
figure, (above, below) = pyplot.subplots(2, 1, sharex=True, figsize=(8, 6))
above.plot(time_s, wanted_N, label="by the law", linewidth=1)
above.plot(time_s, written_N, "--", label="after the gate", linewidth=1)
above.set_ylabel("force, N")
above.legend()
below.plot(time_s, 1e3 * run["tool_position_m"][:, 2], linewidth=1)
below.set_ylabel("height of the tool, mm")
below.set_xlabel("time, s")
above.set_title(f"{source.header['scene_name']}: {source.header['law_name']}")
keep(figure, "force.png")
print(f"{len(run)} {'ticks' if log else 'frames'}, {time_s[-1]:.1f} s, force at most {written_N.max():.3f} N")

# %% Phases of a tick, as shares of ticks that took at most so long
if not log:
    sys.exit()
if not log.ticks["phase_ns"].any():
    print("a run in simulated time (--free-run) has no times of phases: no ticks.png")
    sys.exit()
figure, axes = pyplot.subplots(figsize=(8, 4))
share = np.arange(1, len(log.ticks) + 1) / len(log.ticks)
for i, phase in enumerate(log.fields["phase_ns"]["components"]):
    axes.step(np.sort(log.ticks["phase_ns"][:, i]) / 1e3, share, label=phase, linewidth=1)
axes.set_xscale("log")
axes.set_xlabel("time, us")
axes.set_ylabel("share of ticks")
axes.legend(ncols=2)
keep(figure, "ticks.png")
print(f"tick: median {np.median(log.ticks['phase_ns'][:, -1]) / 1e3:.2f} us, "
      f"p99.9 {np.quantile(log.ticks['phase_ns'][:, -1], 0.999) / 1e3:.2f} us")
