#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/client/tact.py reads what the programs of BUILD_DIR write and send, and its fields are those of host/PROTOCOL.md.

    python3 tests/tools/client/client_test.py BUILD_DIR

Needs python3-numpy and python3-matplotlib. Exit status 0 or 1.
"""
import csv
import json
import pathlib
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
from run_bytes import byte_of_tick, chunk_of  # noqa: E402

LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(".")


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

    def test_fields_are_those_of_the_document(self):
        document = (ROOT / "host/PROTOCOL.md").read_text()
        for name, field in tact.read_ticks(self.log).fields.items():
            shape = "".join(f"[{length}]" for length in field.get("shape", []))
            shape = "[16]" if name == "contact" else shape  # the document has as many spheres as a tool may have
            self.assertIn(f"| `{name}` | `{field.get('type', 'record')}{shape}` | {field.get('unit', '')} |", document)

    def test_ticks_are_those_of_the_replay(self):
        table = self.folder / "ticks.csv"
        subprocess.run([str(BUILD / "tactd"), "--replay", str(self.log), "--csv", str(table)], check=True,
                       stdout=subprocess.DEVNULL)
        rows = list(csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#")))
        log = tact.read_ticks(self.log)
        self.assertEqual((log.damage, len(log.ticks), log.recording), ("", len(rows), None))
        self.assertEqual(log.header["scene_name"], "liver")
        self.assertGreater(log.ticks["force_N"].max(), 0.1)
        for tick, row in zip(log.ticks, rows):
            self.assertEqual(tick["tick"], int(row["tick"]))
            for i, axis in enumerate("xyz"):
                self.assertEqual(tick["tool_position_m"][i], float(row[f"tool_position_{axis}_m"]))
                self.assertEqual(tick["force_N"][i], float(row[f"force_{axis}_N"]))
                self.assertEqual(tick["wanted_force_N"][i], float(row[f"wanted_force_{axis}_N"]))
            self.assertEqual(log.fields["state"]["values"][tick["state"]], row["state_name"])

    def test_damage_is_reported_and_costs_its_tick_alone(self):
        data, (first, size) = bytearray(self.log.read_bytes()), byte_of_tick(self.log, 0)
        data[first + 100 * size + 27] ^= 1
        broken = self.folder / "broken.tactlog"
        broken.write_bytes(data)
        log = tact.read_ticks(broken)
        self.assertEqual(len(log.ticks), 4999)
        self.assertEqual(log.damage, "its bytes are not those that were written; 1 of 5000 ticks are damaged, "
                                     f"the first at byte {first + 100 * size}")
        data[first + 200 * size + 3] ^= 1  # of its header
        broken.write_bytes(data)
        self.assertEqual(len(tact.read_ticks(broken).ticks), 4998)
        self.assertIn(f"{size} bytes belong to no whole part, the first at byte {first + 200 * size}",
                      tact.read_ticks(broken).damage)
        broken.write_bytes(data[:first + 150 * size + 9])
        self.assertRegex(tact.read_ticks(broken).damage, "it has no end.*; 1 of 150 .*; cut off at byte")
        broken.write_bytes(b"tactlog6" + data[8:])
        with self.assertRaisesRegex(tact.Error, "before files of tact had version 1; record it again"):
            tact.read_ticks(broken)
        for path, message in (("nowhere", "nowhere: No such file"), ("/dev/zero", "is no regular file"),
                              (ROOT, "is no regular file"), (LIVER, "is no file of tact")):
            with self.assertRaisesRegex(tact.Error, message):
                tact.read_ticks(path)

    def test_live_frames_and_the_recording_of_the_viewer_agree(self):
        path, recording = self.folder / "socket", self.folder / "run.tactview"
        page = self.folder / "page"  # it is not read here
        page.mkdir()
        (page / "index.html").write_text("<!doctype html>")
        viewer = subprocess.Popen([str(BUILD / "tact-view"), "--socket", str(path), "--port", "0", "--record", str(recording),
                                   "--page", str(page)],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        run = tactd("--seconds", 3, "--no-black-box", "--socket", path)
        try:
            frames = look(path)
            self.assertEqual(frames.header["scene_name"], "liver")
            self.assertEqual(len(frames.organ.vertex_m), frames.header["organ_vertices"])
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
        boxes, record = self.folder / "boxes", self.folder / "box_record.tactlog"
        run = tactd("--seconds", 60, "--no-telemetry", "--black-box", boxes, "--record", record)
        while run.poll() is None and (not record.exists() or record.stat().st_size < 1_000_000):
            time.sleep(0.05)
        run.send_signal(signal.SIGXCPU)  # as if the loop had run away
        run.wait(30)
        newest = max(boxes.glob("*.tactbox"), key=lambda path: path.stat().st_mtime_ns)  # a busy PC's late tick has its own
        box = tact.read_ticks(newest)
        self.assertEqual(box.damage, "")
        self.assertGreater(len(box.ticks), 100)
        self.assertGreater(len(box.recording.frames), 0)
        self.assertEqual(box.ticks["fault"][-1], 122)  # loop ran away
        data, broken = bytearray(newest.read_bytes()), self.folder / "box.tactlog"
        first, size = byte_of_tick(newest, 0)
        pictures = first + len(box.ticks) * size
        broken.write_bytes(data[:pictures + 1000])
        cut = tact.read_ticks(broken)
        self.assertEqual((len(cut.ticks), len(cut.recording.frames)), (len(box.ticks), 0))
        self.assertIn("cut off at byte", cut.damage)
        broken.write_bytes(data[:pictures - 100])
        self.assertEqual(len(tact.read_ticks(broken).ticks), len(box.ticks) - 1)
        data[first - 100] ^= 1
        broken.write_bytes(data)
        self.assertIsNone(tact.read_ticks(broken).recording)
        self.assertIn("its meshes are damaged or missing", tact.read_ticks(broken).damage)

    def test_meshes_may_end_with_colours_of_all_vertices_and_not_of_some(self):
        run = {"organ_vertices": 2, "organ_triangles": 1, "tool_vertices": 1, "tool_triangles": 1}

        def meshes(content):
            data = tact.MAGIC
            head = json.dumps({"version": 1, "run": run, "records": {}}).encode()
            data += chunk_of(tact.HEAD, head) + chunk_of(tact.MESHES, content)
            return tact._File(data, "here", "").meshes()
        self.assertIsNone(meshes(bytes(60))[0].color)
        organ, tool = meshes(bytes(60) + bytes(range(6)))
        self.assertEqual(organ.color.tolist(), [[0, 1, 2], [3, 4, 5]])
        self.assertIsNone(tool.color)
        for wrong in (59, 61, 65, 67):
            with self.assertRaisesRegex(tact.Error, "here: its meshes are not as long"):
                meshes(bytes(wrong))

    def test_a_socket_without_tactd_is_reported(self):
        with self.assertRaisesRegex(tact.Error, "does tactd run, and may this user look"):
            tact.live(self.folder / "none")

    def test_the_thirty_third_viewer_is_refused(self):
        path = self.folder / "full"
        run = tactd("--seconds", 60, "--no-black-box", "--socket", path)
        viewers = [look(path) for _ in range(32)]
        with self.assertRaisesRegex(tact.Error, "tactd has as many viewers as it takes"):
            tact.live(path)
        for viewer in viewers:
            viewer.close()
        look(path).close()
        run.send_signal(signal.SIGINT)
        run.wait(30)

    def test_a_stopped_tactd_is_reported_and_one_that_is_gone_ends_it(self):
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
