#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A reader that fastddsgen made reads tact-ros of a tactd that runs: each value is the tick log's. In a network namespace
that has loopback alone. Its poses of garbage change nothing.

    python3 tests/host/ros/fastdds_test.py BUILD_DIR [SECONDS]

Needs root or user namespaces, iproute2, cyclonedds-dev, cyclonedds-tools, libfastrtps-dev, fastddsgen and python3-numpy. Without
tact-ros or fastddsgen it says so, and tests nothing. Exit status 0 or 1.
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True
SECONDS = int(sys.argv.pop(2)) if len(sys.argv) > 2 else 10
from bridge import BUILD, LIVER, RECORD, TOPICS, Case, np, tact, until, wrong_joints, wrong_values  # noqa: E402
from joints import delta_rad, joint_states  # noqa: E402
from ros_test import BAD, random_pose  # noqa: E402

RATE_HZ, GARBAGE = 1000, 10000


class FastDds(Case):
    peer = (BUILD / "fastdds/fastdds_peer",)

    def test_a_reader_of_fast_dds_gets_what_the_log_has(self):
        log = self.folder / "run.tactlog"
        bridge, lines = self.bridge(log, "--servo")
        tactd = self.start(BUILD / "tactd", LIVER, "--socket", self.folder / "tactd.sock", "--no-black-box", "--record", log,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until(lambda: any("ticks/s" in line for line in lines) or tactd.poll(), "the first tick")
        garbage, rng = self.servo(), random.Random(1)
        peer, out = self.read(SECONDS * RATE_HZ)
        self.send_until(garbage, lambda: [*BAD, *(random_pose(rng) for _ in range(100))],
                        lambda: self.refused(lines) > GARBAGE, "refused poses")
        peer.wait(timeout=SECONDS + 500)
        tactd.terminate()
        self.assertEqual(tactd.wait(timeout=60), 0)
        self.check_values(np.frombuffer(out.read_bytes(), RECORD), tact.read_ticks(log))
        print(f"{self.refused(lines)} poses refused")
        self.check_ctrl_c(bridge)

    def check_values(self, records, log):
        self.assertEqual(log.damage, "")
        self.assertEqual(wrong_values(records, log.ticks), 0)
        self.assertEqual(wrong_joints(records, log.ticks, joint_states(log.ticks, delta_rad))[0], 0)
        stamps = tact.utc_ns(log.ticks)
        for number, topic in enumerate(TOPICS):
            own = records[records["topic"] == number]
            when = own["sec"].astype("i8") * 10**9 + own["nanosec"]
            written = int(np.sum((stamps >= when.min()) & (stamps <= when.max())))
            rate_Hz = 1e9 * (len(own) - 1) / (when.max() - when.min())
            print(f"{topic}: {len(own)} samples of {written} ticks, {rate_Hz:.0f} a second, 0 wrong values")
            self.assertGreater(len(own), written / 2, "half of what was written has not come")


def build_peer():
    for words in (["-S", HERE / "fastdds", "-B", BUILD / "fastdds", "-DCMAKE_BUILD_TYPE=Release"],
                  ["--build", BUILD / "fastdds"]):
        done = subprocess.run(["cmake", *map(str, words)], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{done.stdout}{done.stderr}")


if __name__ == "__main__":
    if not (BUILD / "tact-ros").exists() or not shutil.which("fastddsgen"):
        print("tact-ros is not tested: it needs cyclonedds-dev, cyclonedds-tools, libfastrtps-dev and fastddsgen")
        sys.exit(0)
    if "TACT_LOOPBACK_ALONE" not in os.environ:
        build_peer()
        again = f"ip link set lo up && exec {sys.executable} -B {__file__} {BUILD} {SECONDS}"
        os.environ["TACT_LOOPBACK_ALONE"] = "1"
        os.execvp("unshare", ["unshare", "--net", *([] if os.getuid() == 0 else ["--map-root-user"]), "sh", "-c", again])
    unittest.main()
