#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What tact-mcap of BUILD_DIR writes, read by Foxglove's readers, is field by field what tools/client/tact.py reads.

    python3 tests/tools/mcap/mcap_test.py BUILD_DIR

The readers are npm packages of host/web (tests/tools/mcap/mcap_read.mjs). Needs python3-numpy and node. Exit status 0 or 1.
"""
import collections
import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import time
import unittest
import zlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools/client"), str(ROOT / "tests/tools/client")]
sys.dont_write_bytecode = True
import tact  # noqa: E402
from recorded_run import LIVER, TICKS, RecordedRun  # noqa: E402
from run_bytes import byte_of_tick  # noqa: E402

BUILD = pathlib.Path(".")
SCHEMAS = {"/pose": "geometry_msgs/msg/PoseStamped", "/force": "geometry_msgs/msg/WrenchStamped",
           "/wanted": "geometry_msgs/msg/WrenchStamped", "/state": "tact_msgs/msg/State"}


def start(program, *arguments):
    return subprocess.Popen([str(BUILD / program), *map(str, arguments)], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def tact_mcap(source, target):
    """Status, JSON of standard output or None, standard error."""
    done = subprocess.run([str(BUILD / "tact-mcap"), str(source), str(target), "--json"], capture_output=True, text=True,
                          check=False, timeout=120)
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr


def read(path):
    """By Foxglove's readers: (facts by kind, messages by topic)."""
    done = subprocess.run(["node", str(ROOT / "tests/tools/mcap/mcap_read.mjs"), str(path)], capture_output=True, text=True,
                          check=False, timeout=120)
    if done.returncode != 0:
        raise ValueError(done.stderr)
    facts, messages = collections.defaultdict(list), collections.defaultdict(list)
    for line in done.stdout.splitlines():
        fact = json.loads(line)
        (messages[fact["topic"]] if fact["kind"] == "message" else facts[fact["kind"]]).append(fact)
    return facts, messages


def vector(fields, names="xyz"):
    return [float(fields[name]) for name in names]


def rows(messages, under):
    """Of one rate: [(log_time in ns, fields by name)], as the client names them."""
    out = []
    kinds = [messages[under + end] for end in SCHEMAS]
    for said in zip(*kinds, strict=True):
        times = {(int(m["log_time"]), int(m["publish_time"])) for m in said}
        stamps = {m["said"]["header"]["stamp"]["sec"] * 10**9 + m["said"]["header"]["stamp"]["nanosec"] for m in said}
        assert len(times) == 1 and times == {(stamp, stamp) for stamp in stamps}, "one moment, one time"
        assert {m["said"]["header"]["frame_id"] for m in said} == {"tact_device"}
        assert {m["sequence"] for m in said} == {len(out)}
        pose, force, wanted, state = (m["said"] for m in said)
        out.append((stamps.pop(), {
            "position": vector(pose["pose"]["position"]), "orientation": vector(pose["pose"]["orientation"], "wxyz"),
            "force": vector(force["wrench"]["force"]), "torque": vector(force["wrench"]["torque"]),
            "wanted": vector(wanted["wrench"]["force"]), "wanted_torque": vector(wanted["wrench"]["torque"]),
            **{key: value for key, value in state.items() if key != "header"}}))
    return out


class Mcap(RecordedRun):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mcap = cls.folder / "run.mcap"

    def same_ticks(self, seen, ticks):
        self.assertEqual(len(seen), len(ticks))
        for (_, row), tick in zip(seen, ticks):
            for name, field in (("position", "tool_position_m"), ("orientation", "tool_orientation"),
                                ("force", "force_N"), ("torque", "torque_Nm"),
                                ("wanted", "wanted_force_N"), ("wanted_torque", "wanted_torque_Nm")):
                self.assertEqual(row[name], tick[field].tolist(), field)
            self.assertEqual((int(row["tick"]), row["state"], row["non_rt"], row["fault"], row["limit"]),
                             (tick["tick"], tick["state"], bool(tick["non_rt"]), tick["fault"], tick["limit"]))
            self.assertEqual(int(row["contact_losses"]), tick["contact_losses"])
            self.assertEqual((row["grip_ratio"], row["rms_force_newton"], row["given_energy_joule"], row["margin_us"]),
                             (tick["grip_ratio"], tick["rms_force_N"], tick["given_energy_J"],
                              1e-3 * float(tick["margin_ns"])))

    def same_frames(self, seen, frames):
        self.assertEqual(len(seen), len(frames))
        for (_, row), frame in zip(seen, frames):
            for name, field in (("position", "tool_position_m"), ("orientation", "tool_orientation"), ("force", "force_N"),
                                ("torque", "torque_Nm"), ("wanted", "wanted_force_N")):
                self.assertEqual(row[name], frame[field].tolist(), field)
            self.assertTrue(all(number != number for number in row["wanted_torque"]), "a frame does not have it: NaN")
            self.assertEqual((int(row["tick"]), row["state"], row["non_rt"], row["fault"], row["limit"]),
                             (frame["tick"], frame["state"], bool(frame["non_rt"]), frame["fault"], frame["limit"]))
            self.assertEqual(int(row["contact_losses"]), frame["contact_losses"])
            self.assertEqual((row["grip_ratio"], row["rms_force_newton"], row["given_energy_joule"], row["margin_us"]),
                             tuple(float(frame[field]) for field in ("grip_ratio", "rms_force_N", "given_energy_J",
                                                                     "worst_margin_us")))

    def test_every_tick_of_a_log_is_there_field_by_field(self):
        status, counts, words = tact_mcap(self.log, self.mcap)
        self.assertEqual((status, words), (0, ""))
        self.assertEqual((counts["ticks"], counts["frames"], counts["messages"], counts["damage"]), (TICKS, 0, 4 * TICKS, ""))
        log, (facts, messages) = tact.read_ticks(self.log), read(self.mcap)
        seen = rows(messages, "/tact/tick")
        self.same_ticks(seen, log.ticks)
        self.assertGreater(max(row["force"][2] for _, row in seen), 0.1)
        epoch_ns = tact.epoch_ns(log.header)
        self.assertEqual([time_ns for time_ns, _ in seen], [epoch_ns + int(due) for due in log.ticks["due_ns"]])
        self.assertLess(abs(seen[-1][0] - 1e9 * time.time()), 600e9, "of today, not of 1970")
        self.assertEqual(facts["metadata"][0]["facts"]["scene"], "liver")
        self.assertEqual(facts["metadata"][0]["facts"]["scene_hash"], log.header["scene_hash"])

    def test_the_container_is_whole_in_its_readers_eyes(self):
        tact_mcap(self.log, self.mcap)
        facts, _ = read(self.mcap)
        header, numbers, stream = facts["header"][0], facts["statistics"][0], facts["stream"][0]
        self.assertTrue(stream["done"])
        self.assertEqual((header["profile"], header["library"].split()[0]), ("ros2", "tact-mcap"))
        self.assertEqual({schema["name"] for schema in facts["schema"]}, set(SCHEMAS.values()))
        self.assertEqual({schema["encoding"] for schema in facts["schema"]}, {"ros2msg"})
        self.assertEqual((int(numbers["messageCount"]), numbers["channelCount"], numbers["schemaCount"]), (4 * TICKS, 4, 3))
        self.assertEqual(stream["counts"]["ChunkIndex"], numbers["chunkCount"])
        self.assertGreater(numbers["chunkCount"], 1)
        data = self.mcap.read_bytes()
        summary_at = struct.unpack("<Q", data[-36 + 8:-36 + 16])[0]  # of footer: op, length, start, offsets, sum; magic
        self.assertEqual(data[summary_at - 13], 0x0f)
        self.assertEqual(facts["data_end"][0]["crc"], zlib.crc32(data[:summary_at - 13]))
        for at, words in ((len(data) // 3, "Incorrect chunk CRC"), (len(data) - 60, "Incorrect summary CRC")):
            broken = self.folder / "broken.mcap"
            broken.write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1:])
            with self.assertRaisesRegex(ValueError, words):
                read(broken)

    def test_every_frame_of_a_viewers_recording_is_there(self):
        path, recording, page = self.folder / "socket", self.folder / "run.tactview", self.folder / "page"
        log_path = self.folder / "beside.tactlog"
        page.mkdir()
        (page / "index.html").write_text("<!doctype html>")
        viewer = start("tact-view", "--socket", path, "--port", 0, "--record", recording, "--page", page)
        try:
            start("tactd", LIVER, "--seconds", 3, "--no-black-box", "--socket", path, "--record", log_path).wait(30)
            time.sleep(0.5)
        finally:
            viewer.send_signal(signal.SIGINT)
            viewer.wait(30)
        target = self.folder / "recording.mcap"
        status, counts, words = tact_mcap(recording, target)
        kept, (_, messages) = tact.read_recording(recording), read(target)
        self.assertEqual((status, words, counts["ticks"], counts["frames"]), (0, "", 0, len(kept.frames)))
        self.assertGreater(counts["frames"], 50)
        seen = rows(messages, "/tact/frame")
        self.same_frames(seen, kept.frames)
        times = np.array([time_ns for time_ns, _ in seen])
        self.assertLess(np.abs(times - tact.utc_ns(kept.frames)).max(), 100e3, "by the clocks of each frame, too")
        # The log of the same run lies over it: a tick is at the time of its frame.
        log = tact.read_ticks(log_path)
        at = {int(tick): time_ns for tick, time_ns in zip(log.ticks["tick"], tact.utc_ns(log.ticks))}
        off_ns = [abs(int(time_ns) - at[int(row["tick"])]) for time_ns, row in seen]
        self.assertLess(max(off_ns), 100_000)

    def test_a_black_box_has_ticks_and_frames_in_one_time(self):
        boxes = self.folder / "boxes"
        record = self.folder / "box_record.tactlog"
        run = start("tactd", LIVER, "--seconds", 60, "--no-telemetry", "--black-box", boxes, "--record", record)
        while run.poll() is None and (not record.exists() or record.stat().st_size < 500_000):
            time.sleep(0.05)
        run.send_signal(signal.SIGXCPU)  # as if the loop had run away
        run.wait(30)
        source, target = next(boxes.glob("*.tactbox")), self.folder / "box.mcap"
        self.assertEqual(tact_mcap(source, target)[0], 0)
        box, (_, messages) = tact.read_ticks(source), read(target)
        ticks, frames = rows(messages, "/tact/tick"), rows(messages, "/tact/frame")
        self.same_ticks(ticks, box.ticks)
        self.same_frames(frames, box.recording.frames)
        time_of = {row["tick"]: time_ns for time_ns, row in ticks}
        both = [(time_ns, time_of[row["tick"]]) for time_ns, row in frames if row["tick"] in time_of]
        self.assertGreater(len(both), 10)
        for frame_ns, tick_ns in both:
            self.assertEqual(frame_ns, tick_ns)
        self.assertNotEqual(ticks[-1][1]["fault"], 0)
        data, pictures = source.read_bytes(), byte_of_tick(source, len(box.ticks))[0]
        cut = self.folder / "cut.tactlog"
        cut.write_bytes(data[:pictures + 1000])
        status, counts, words = tact_mcap(cut, target)
        self.assertEqual((status, counts["ticks"], counts["frames"]), (1, len(box.ticks), 0))
        self.assertIn("cut off at byte", words)

    def test_of_a_damaged_log_the_good_ticks_are_there(self):
        data, broken = bytearray(self.log.read_bytes()), self.folder / "broken.tactlog"
        first, size = byte_of_tick(self.log, 0)
        data[first + 100 * size + 27] ^= 1
        broken.write_bytes(data)
        status, counts, words = tact_mcap(broken, self.mcap)
        self.assertEqual((status, counts["ticks"]), (1, TICKS - 1))
        self.assertIn(f"1 of {TICKS} ticks are damaged, the first at byte {first + 100 * size}", words)
        self.same_ticks(rows(read(self.mcap)[1], "/tact/tick"), tact.read_ticks(broken).ticks)
        whole = 250
        broken.write_bytes(data[:first + whole * size + 9])
        status, counts, words = tact_mcap(broken, self.mcap)
        self.assertEqual((status, counts["ticks"]), (1, whole - 1))
        self.assertIn(f"cut off at byte {first + whole * size + 9}", words)
        self.assertEqual(len(rows(read(self.mcap)[1], "/tact/tick")), whole - 1)

    def test_refuses_what_it_cannot_read_or_write(self):
        pipe, empty, out = self.folder / "pipe", self.folder / "empty", self.folder / "no.mcap"
        os.mkfifo(pipe)
        empty.write_bytes(b"")
        for source, target, words in ((self.folder, out, "is no regular file"), (pipe, out, "is no regular file"),
                                      (self.folder / "none", out, "No such file"), (empty, out, "is no file of tact"),
                                      (self.log, self.folder / "none" / "no.mcap", "No such file")):
            status, counts, said = tact_mcap(source, target)
            self.assertEqual((status, counts), (2, None), said)
            self.assertIn(words, said)
            self.assertFalse(target.exists())
        self.assertEqual(list(self.folder.glob("*.part")), [])

    def test_is_of_this_version(self):
        version = re.search(r"set\(TACT_VERSION (\S+)\)", (ROOT / "CMakeLists.txt").read_text())[1]
        done = subprocess.run([BUILD / "tact-mcap", "--version"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, f"tact-mcap {version}\n")


if __name__ == "__main__":
    BUILD = RecordedRun.build = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
