#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-ros of BUILD_DIR against CycloneDDS: each value of the topics is the tick log's; bad poses and bad usage are refused.

    python3 tests/host/ros/ros_test.py BUILD_DIR

The tick log grows by hand, so no value depends on a clock. Needs python3-numpy. Exit status 0 or 1.
"""
import pathlib
import random
import select
import socket
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from bridge import (BUILD, DOMAIN, JOINTS, LIVER, RECORD, Case, Growing, np, tact, until, wrong_joints,  # noqa: E402
                    wrong_values)
from joints import delta_rad, falcon_rad, joint_states  # noqa: E402

GOOD = "tact_base 0.01 -0.02 0.03 0.9999500004 0.0099998333 0 0"
BAD = ["other 0 0 0 1 0 0 0", "- 0 0 0 1 0 0 0", "tact_base nan 0 0 1 0 0 0", "tact_base 0 inf 0 1 0 0 0",
       "tact_base 0 0 1e300 1 0 0 0", "tact_base 0 0 1.5 1 0 0 0", "tact_base 0 0 0 0 0 0 0", "tact_base 0 0 0 nan 0 0 0",
       "tact_base 0 0 0 2 0 0 0"]


def random_pose(rng):
    """Any bits as numbers, any frame but the right one."""
    frame = "".join(rng.choice("abcxyz_/~%") for _ in range(rng.randrange(1, 40)))
    return " ".join([frame, *(repr(float(value)) for value in np.frombuffer(rng.randbytes(56), "<f8"))])


class Ros(Case):
    def test_topics_are_the_log_also_where_it_begins_again(self):
        source, _ = self.simulate("--ticks", 6000)
        log = Growing(source, self.folder / "run.tactlog")
        records, process, lines = self.follow(log, 1000)
        self.assertEqual(wrong_values(records, tact.read_ticks(source).ticks), 0)
        self.assertGreaterEqual(len(records), 4000)
        print(f"{7 * len(records[records['topic'] != JOINTS])} values, 0 wrong")
        self.check_begins_again(log, lines)
        self.check_ctrl_c(process)

    def check_begins_again(self, log, lines):
        """As RunWriter does at its most bytes."""
        log.path.rename(self.folder / "run.tactlog.old")
        peer, out = self.read(100)
        log.at = 0
        log.begin()
        until(lambda: sum("ticks/s" in line for line in lines) == 2, "the second log")
        log.grow_while(peer, out)
        self.assertEqual(peer.wait(timeout=60), 0)
        ticks = tact.read_ticks(self.folder / "source.tactlog").ticks
        self.assertEqual(wrong_values(np.frombuffer(out.read_bytes(), RECORD), ticks), 0)

    def check_joints(self, name, source, states, others=None, **changes):
        """`states`: what Python computes of the ticks."""
        ticks = tact.read_ticks(source).ticks if others is None else others
        records, process, _ = self.follow(Growing(source, self.folder / f"{name}.tactlog", others, **changes), 500)
        self.assertGreater(np.ptp(states[:, :3], axis=0).min(), 0.01, "each joint moves")
        wrong, count = wrong_joints(records, ticks, states)
        self.assertEqual(wrong, 0, f"{name}, of {count}")
        self.check_ctrl_c(process)
        print(f"joint_states, {name}: {count} samples, 0 wrong")

    def test_joint_states_are_inverse_kinematics_of_the_pose(self):
        source, _ = self.simulate("--ticks", 4000)
        ticks = tact.read_ticks(source).ticks
        self.check_joints("simulated", source, joint_states(ticks, delta_rad))
        moved = ticks.copy()  # as a clutch would: tool and handle apart, more and more
        moved["clutch_shift_m"] = np.outer(np.arange(len(ticks)) / len(ticks), [0.01, -0.02, 0.03])
        moved["tool_position_m"] += moved["clutch_shift_m"]
        self.check_joints("clutched", source, joint_states(moved, delta_rad), moved)
        falcon = {"linkage": "falcon", "row": [[0, 0.2, 0], [0, 0, 0.2], [0.2, 0, 0]], "origin_m": [0, 0, 0.120]}
        self.check_joints("falcon", source, joint_states(ticks, falcon_rad, scale=5.0), joints=falcon)

    def test_joint_states_of_a_turned_base_with_scaled_motion(self):
        source, _ = self.simulate("--ticks", 4000, "--set", "device.base_orientation_deg=[10, -20, 30]", "--set",
                                  "device.base_position_m=[0.02, -0.01, 0.015]", "--set", "device.motion_scale=1.25")
        mounting = {"rotation_deg": (10, -20, 30), "position_m": (0.02, -0.01, 0.015), "scale": 1.25}
        self.check_joints("mounted", source, joint_states(tact.read_ticks(source).ticks, delta_rad, **mounting))

    def test_no_joint_states_where_no_joints_are_known(self):
        source, _ = self.simulate("--ticks", 4000)
        log = Growing(source, self.folder / "run.tactlog", joints={})
        records, _, _ = self.follow(log, 1000, topics=JOINTS)
        self.assertEqual(set(records["topic"].tolist()), {0, 1, 2})
        self.assertEqual(wrong_values(records, tact.read_ticks(source).ticks), 0)

    def served(self, simulated):
        """tact-ros --servo, what it has said, a peer that sends poses, and the socket of the hand that this test plays."""
        source, _ = self.simulate("--ticks", 100)
        hand = self.enterContext(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK))
        hand.bind(str(self.folder / "hand.sock"))
        log = Growing(source, self.folder / "run.tactlog", simulated=simulated, hand_socket=str(self.folder / "hand.sock"))
        log.begin()
        _, lines = self.bridge(log.path, "--servo")
        until(lambda: any("ticks/s" in line for line in lines), "its first line")
        return lines, self.servo(), hand

    def test_only_good_poses_move_the_simulated_hand(self):
        lines, peer, hand = self.served(simulated=True)
        rng, count = random.Random(1), 10000
        self.send_until(peer, lambda: BAD, lambda: self.refused(lines) > 10 * len(BAD), "refused poses")
        self.send_until(peer, lambda: [random_pose(rng) for _ in range(100)], lambda: self.refused(lines) > count,
                        "refused random poses")
        self.assertRaises(BlockingIOError, hand.recv, 1000)
        self.send_until(peer, lambda: [GOOD], lambda: select.select([hand], [], [], 0)[0], "that the hand moves")
        first = np.frombuffer(hand.recv(1000), [("head", "u1", 8), ("values", "<f8", 7)])[0]["values"]
        np.testing.assert_allclose(first, [0.01, -0.02, 0.03, 0.02, 0, 0, 0], rtol=0, atol=1e-8)
        print(f"{self.refused(lines)} poses refused, the good one alone moved the hand")

    def test_a_real_device_is_never_moved(self):
        lines, peer, hand = self.served(simulated=False)
        self.send_until(peer, lambda: [GOOD], lambda: self.refused(lines) >= 5, "five good poses")
        self.assertIn("the device is real", lines[-1])
        self.assertRaises(BlockingIOError, hand.recv, 1000)

    def test_forces_are_the_same_with_and_without(self):
        _, alone = self.simulate("--ticks", 20000)
        (self.folder / "source.tactlog").unlink()
        process, lines = self.bridge(self.folder / "source.tactlog", "--servo")
        peer = self.servo()
        peer.stdin.write(GOOD + "\n")
        peer.stdin.flush()
        _, followed = self.simulate("--ticks", 20000)
        until(lambda: any("ticks/s" in line for line in lines), "that it has followed")
        self.assertEqual(followed, alone)
        self.assertIsNone(process.poll())
        print(f"force hash {alone} with and without")

    def test_bad_usage_has_a_message(self):
        no_log = self.folder / "no.tactlog"
        no_log.write_text("hello, this is no log of tact at all")
        for arguments, message in ((["log", "--domain", "233"], "--domain: 233 is not in"),
                                   (["log", "--namespace", "/tact"], "/tact is no name of ROS"),
                                   (["log", "--interface", "no9"], "--interface no9: this PC has none"),
                                   ([], "LOG is required"),
                                   ([no_log, "--domain", DOMAIN], "is no file of tact; name one that tactd --record"),
                                   ([self.folder, "--domain", DOMAIN], "is no regular file"),
                                   ([self.folder / "none/log", "--domain", DOMAIN], "No such file"),
                                   ([LIVER, "--domain", DOMAIN], "is no file of tact")):
            done = subprocess.run([BUILD / "tact-ros", *map(str, arguments)], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertRegex(done.stderr, r"^tact-ros: .*" + message)
        self.assertIn("example:", subprocess.run([BUILD / "tact-ros", "--help"], capture_output=True, text=True).stdout)


if __name__ == "__main__":
    unittest.main()
