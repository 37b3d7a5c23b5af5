#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/client/tact.py reads what the programs of BUILD_DIR write and send, and its layouts are those of host/PROTOCOL.md.

    python3 tests/tools/client/client_test.py BUILD_DIR

Needs python3-numpy and python3-matplotlib. Exit status 0 or 1.
"""
import csv
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/client"))
sys.dont_write_bytecode = True
import tact  # noqa: E402

LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(".")
LAYOUTS = {"MessageHeader": tact.MESSAGE_HEADER, "Hello": tact.HELLO, "Frame": tact.FRAME, "FrameSite": tact.FRAME_SITE,
           "FramePatch": tact.FRAME_PATCH, "FileHeader": tact.FILE_HEADER, "FrameRecord": tact.FRAME_RECORD,
           "LogHeader": tact.LOG_HEADER, "LogRecord": tact.LOG_RECORD, "LoggedTick": tact.LOGGED_TICK}
SCALARS = {"char": 1, "u8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4, "f32": 4, "u64": 8, "i64": 8, "f64": 8}


def told():
    """{struct: (bytes, [(field, offset, bytes)])} of host/PROTOCOL.md."""
    out, name = {}, None
    for line in (ROOT / "host/PROTOCOL.md").read_text().splitlines():
        if head := re.fullmatch(r"### (\w+), (\d+) bytes", line):
            name = head[1]
            out[name] = (int(head[2]), [])
        elif row := re.match(r"\| `([\w.]+)` \| (\d+) \| `(\w+)((?:\[\d+\])*)` \|", line):
            size = SCALARS.get(row[3]) or LAYOUTS[row[3]].itemsize
            for count in re.findall(r"\d+", row[4]):
                size *= int(count)
            out[name][1].append((row[1], int(row[2]), size))
    return out


def tactd(*arguments):
    return subprocess.Popen([str(BUILD / "tactd"), str(LIVER), *map(str, arguments)], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.log = cls.folder / "run.tactlog"
        tactd("--free-run", "--ticks", 5000, "--no-telemetry", "--no-black-box", "--record", cls.log).wait(60)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_layouts_are_those_of_the_document(self):
        document = told()
        for name, layout in LAYOUTS.items():
            size, rows = document[name]
            self.assertEqual(layout.itemsize, size, name)
            ours = [(field, layout.fields[field][1], layout.fields[field][0].itemsize) for field in layout.names]
            if name == "LoggedTick":  # shorter names, the same places
                rows, ours = [row[1:] for row in rows], [row[1:] for row in ours]
            self.assertEqual(ours, rows, name)

    def test_ticks_are_those_of_the_replay(self):
        table = self.folder / "ticks.csv"
        subprocess.run([str(BUILD / "tactd"), "--replay", str(self.log), "--csv", str(table)], check=True,
                       stdout=subprocess.DEVNULL)
        rows = list(csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#")))
        log = tact.read_ticks(self.log)
        self.assertEqual((log.damage, len(log.ticks), log.recording), ("", len(rows), None))
        self.assertEqual(tact.text(log.header["scene_name"]), "liver")
        self.assertGreater(log.ticks["written_force_N"].max(), 0.1)
        for tick, row in zip(log.ticks, rows):
            self.assertEqual(tick["tick"], int(row["tick"]))
            for i, axis in enumerate("xyz"):
                self.assertEqual(tick["tool_position_m"][i], float(row[f"tool_{axis}_m"]))
                self.assertEqual(tick["written_force_N"][i], float(row[f"force_{axis}_N"]))
                self.assertEqual(tick["wanted_force_N"][i], float(row[f"wanted_{axis}_N"]))
            self.assertEqual(tact.STATES[tick["state"]], row["state"])

    def test_damage_is_told_and_costs_its_tick_alone(self):
        data = bytearray(self.log.read_bytes())
        data[tact.LOG_HEADER.itemsize + 100 * tact.LOG_RECORD.itemsize + 7] ^= 1
        broken = self.folder / "broken.tactlog"
        broken.write_bytes(data)
        log = tact.read_ticks(broken)
        self.assertEqual(len(log.ticks), 4999)
        self.assertEqual(log.damage, "its bytes are not those that were written; 1 of 5000 ticks are damaged, "
                                     "the first is number 101")
        broken.write_bytes(data[:tact.LOG_HEADER.itemsize + 250 * tact.LOG_RECORD.itemsize + 9])
        self.assertRegex(tact.read_ticks(broken).damage, "it has no end.*; 1 of 250 .*; cut off in tick number 251")
        broken.write_bytes(b"tactlog6" + data[8:])
        with self.assertRaisesRegex(tact.Error, "a tick log of version 6, no tick log or black box of this version"):
            tact.read_ticks(broken)
        for path, sentence in (("nowhere", "nowhere: No such file"), ("/dev/zero", "is no regular file"),
                               (ROOT, "is no regular file"), (LIVER, "no file of tact, no tick log")):
            with self.assertRaisesRegex(tact.Error, sentence):
                tact.read_ticks(path)

    def test_live_frames_and_the_recording_of_the_viewer_agree(self):
        path, recording = self.folder / "socket", self.folder / "run.tactrec"
        page = self.folder / "page"  # nobody looks at it here
        page.mkdir()
        (page / "index.html").write_text("<!doctype html>")
        viewer = subprocess.Popen([str(BUILD / "tact-view"), "--socket", str(path), "--port", "0", "--record", str(recording),
                                   "--page", str(page)],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        run = tactd("--seconds", 3, "--no-black-box", "--socket", path)
        try:
            frames = look(path)
            self.assertEqual(tact.text(frames.hello["scene_name"]), "liver")
            self.assertEqual(len(frames.organ.vertex_m), frames.hello["organ_vertices"])
            self.assertLess(frames.organ.triangle.max(), len(frames.organ.vertex_m))
            seen = list(frames)
            run.wait(30)
        finally:
            viewer.send_signal(signal.SIGINT)
            viewer.wait(30)
        kept = tact.read_recording(recording)
        self.assertEqual(kept.damage, "")
        self.assertTrue((kept.organ.vertex_m == frames.organ.vertex_m).all())
        by_tick = {int(frame["tick"]): frame for frame in kept.frames}
        both = [(frame, by_tick[int(frame["tick"])]) for frame in seen if int(frame["tick"]) in by_tick]
        self.assertGreater(len(both), 10)
        for ours, theirs in both:
            self.assertEqual(ours.tobytes(), theirs.tobytes())

    def test_a_black_box_has_ticks_and_pictures(self):
        boxes, record = self.folder / "boxes", self.folder / "box_record.csv"
        run = tactd("--seconds", 60, "--no-telemetry", "--black-box", boxes, "--record", record)
        while run.poll() is None and (not record.exists() or record.stat().st_size < 1_000_000):
            time.sleep(0.05)
        run.send_signal(signal.SIGXCPU)  # as if the loop had run away
        run.wait(30)
        newest = max(boxes.glob("*.tactlog"), key=lambda path: path.stat().st_mtime_ns)  # a busy PC's late tick has its own
        box = tact.read_ticks(newest)
        self.assertEqual(box.damage, "")
        self.assertGreater(len(box.ticks), 100)
        self.assertGreater(len(box.recording.frames), 0)
        self.assertEqual(box.ticks["fault"][-1], 122)  # loop ran away
        data, broken = bytearray(newest.read_bytes()), self.folder / "box.tactlog"
        pictures = tact.LOG_HEADER.itemsize + len(box.ticks) * tact.LOG_RECORD.itemsize
        broken.write_bytes(data[:pictures + 1000])
        cut = tact.read_ticks(broken)
        self.assertEqual((len(cut.ticks), cut.recording), (len(box.ticks), None))
        self.assertIn("its pictures: ends before its first frame", cut.damage)
        broken.write_bytes(data[:pictures - 100])
        self.assertEqual(len(tact.read_ticks(broken).ticks), len(box.ticks) - 1)

    def test_meshes_may_end_with_colours_of_all_vertices_and_not_of_some(self):
        hello = {"organ_vertices": 2, "organ_triangles": 1, "tool_vertices": 1, "tool_triangles": 1}
        self.assertIsNone(tact._meshes(hello, bytes(60), "here")[0].color)
        organ, tool = tact._meshes(hello, bytes(60) + bytes(range(6)), "here")
        self.assertEqual(organ.color.tolist(), [[0, 1, 2], [3, 4, 5]])
        self.assertIsNone(tool.color)
        for wrong in (59, 61, 65, 67):
            with self.assertRaisesRegex(tact.Error, "here: its meshes are not as long"):
                tact._meshes(hello, bytes(wrong), "here")

    def test_nobody_at_the_socket_is_told(self):
        with self.assertRaisesRegex(tact.Error, "does tactd run, and may this user look"):
            tact.live(self.folder / "nobody")

    def test_a_tactd_that_stands_still_is_told_and_one_that_is_gone_ends_it(self):
        path = self.folder / "still"
        run = tactd("--seconds", 20, "--no-black-box", "--socket", path)
        frames = look(path, timeout_s=0.5, newest=True)
        time.sleep(0.5)
        first, second = next(frames), next(frames)
        self.assertGreater(first["time_ns"], 3e8, "the frames of the sleep are left out")
        self.assertGreater(second["tick"], first["tick"])
        run.send_signal(signal.SIGSTOP)
        with self.assertRaisesRegex(tact.Error, "no frame for 0.5 s; tactd is stopped, or hangs"):
            list(frames)
        run.send_signal(signal.SIGKILL)
        run.wait(30)
        self.assertEqual([*frames, *frames], [])

    def test_the_example_draws_its_pictures(self):
        log = self.folder / "clock.tactlog"
        tactd("--seconds", 1, "--no-telemetry", "--no-black-box", "--record", log).wait(30)
        subprocess.run([sys.executable, str(ROOT / "tools/client/example.py"), str(log), "--out", str(self.folder / "pictures")],
                       check=True, stdout=subprocess.DEVNULL)
        for name in ("force.png", "ticks.png"):
            self.assertTrue((self.folder / "pictures" / name).read_bytes().startswith(b"\x89PNG"))


def look(path, longest_s=10.0, **options):
    """live() as soon as tactd listens."""
    end = time.monotonic() + longest_s
    while True:
        try:
            return tact.live(path, **options)
        except tact.Error:
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
