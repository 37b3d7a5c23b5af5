#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-shard parts a command by units and merges the same bytes again; it refuses what is missing, double or of other inputs.

    python3 tests/tools/lab/shard_test.py

Exit status 0 or 1.
"""
import hashlib
import json
import pathlib
import subprocess
import tempfile
import unittest

SHARD = pathlib.Path(__file__).resolve().parents[3] / "tools/lab/tact-shard"


class Shards(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "mesh.obj").write_text("v 0 0 0\n")
        (self.folder / "scene.toml").write_text('mesh = "mesh.obj"\n')
        self.command = ["bash", "-c", 'echo "{\\"scene\\": 1, \\"sites\\": [\\"all\\", {}]}"', "scene.toml"]

    def shard(self, *arguments, command=None):
        done = subprocess.run([SHARD, "--units", "1,2,3,4,5", *arguments, "--", *(command or self.command)], cwd=self.folder,
                              capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def made(self, count=2):
        for i in range(1, count + 1):
            self.assertEqual(self.shard("--shard", f"{i}/{count}", "--out", f"part{i}")[0], 0)

    def test_two_shards_are_the_bytes_of_one(self):
        self.made()
        self.assertEqual(self.shard("--out", "all")[0], 0)
        for out, folders in (("two.json", ("part1", "part2")), ("one.json", ("all",)), ("turned.json", ("part2", "part1"))):
            self.assertEqual(self.shard("--merge", *folders, "--out", out)[0], 0)
        data = (self.folder / "one.json").read_bytes()
        self.assertEqual(json.loads(data), {"scene": 1, "sites": ["all", 1, 2, 3, 4, 5]})
        for name in ("two.json", "turned.json"):
            self.assertEqual((self.folder / name).read_bytes(), data)
        record = json.loads((self.folder / "one.json.made.json").read_text())
        self.assertEqual(record["sha256"], hashlib.sha256(data).hexdigest())

    def test_what_is_no_json_is_joined_in_order_of_units(self):
        text = ["bash", "-c", "echo {} >{out}"]
        for i in (1, 2):
            self.shard("--shard", f"{i}/2", "--out", f"part{i}", command=text)
        self.assertEqual(self.shard("--merge", "part1", "part2", "--out", "all.txt", command=text)[0], 0)
        self.assertEqual((self.folder / "all.txt").read_text(), "1\n2\n3\n4\n5\n")

    def refusal(self, *folders, command=None):
        status, said = self.shard("--merge", *folders, "--out", "all.json", command=command)
        self.assertEqual(status, 1, said)
        self.assertFalse((self.folder / "all.json").exists())
        return said

    def test_missing_and_double_units_are_named_with_their_hash(self):
        self.made()
        self.assertRegex(self.refusal("part2"), r"unit 1 \([0-9a-f]{12}\) is missing; unit 3 .* is missing; unit 5 .* is missing")
        self.shard("--shard", "2/3", "--out", "part3")
        self.assertRegex(self.refusal("part1", "part2", "part3"), r"unit 2 \([0-9a-f]{12}\) is double: part2 and part3")

    def test_a_unit_of_other_inputs_is_refused(self):
        self.made()
        (self.folder / "mesh.obj").write_text("v 0 0 1\n")
        self.assertRegex(self.refusal("part1", "part2"), "unit 1 in part1 was made of other inputs: [0-9a-f]{12}, here")
        self.shard("--shard", "1/2", "--out", "part1")
        self.assertRegex(self.refusal("part1", "part2"), r"^tact-shard: not merged: unit 2 in part2 was made of other inputs")
        self.shard("--shard", "2/2", "--out", "part2")
        self.assertEqual(self.shard("--merge", "part1", "part2", "--out", "all.json")[0], 0)

    def test_a_result_that_has_changed_is_refused(self):
        self.made()
        (self.folder / "part2/4.out").write_text("{}")
        self.assertIn("unit 4 in part2 is not the result that was recorded", self.refusal("part1", "part2"))

    def test_results_that_contradict_each_other_are_refused(self):
        command = ["bash", "-c", 'echo "{\\"solver\\": {\\"version\\": {}}}"']
        for i in (1, 2):
            self.shard("--shard", f"{i}/2", "--out", f"part{i}", command=command)
        self.assertIn("solver.version is 1 in one unit and 2 in another", self.refusal("part1", "part2", command=command))

    def test_by_unit_joins_nothing(self):
        command = ["bash", "-c", 'echo "{\\"seed\\": {}}"']
        for i in (1, 2):
            self.shard("--shard", f"{i}/2", "--out", f"part{i}", command=command)
        self.assertEqual(self.shard("--merge", "part1", "part2", "--by-unit", "--out", "all.json", command=command)[0], 0)
        self.assertEqual(json.loads((self.folder / "all.json").read_text()), {str(i): {"seed": i} for i in range(1, 6)})
        self.shard("--out", "text", command=["echo", "{}x"])
        status, said = self.shard("--merge", "text", "--by-unit", "--out", "all.txt", command=["echo", "{}x"])
        self.assertEqual(status, 1)
        self.assertIn("--by-unit needs JSON", said)

    def test_what_is_made_is_not_made_again(self):
        counted = ["bash", "-c", "echo {} >>count; echo {} >{out}"]
        for _ in range(2):
            self.assertEqual(self.shard("--out", "all", command=counted)[0], 0)
        self.assertEqual((self.folder / "count").read_text().split(), ["1", "2", "3", "4", "5"])

    def test_a_unit_that_fails_leaves_the_others(self):
        fails = ["bash", "-c", "test {} != 3 && echo {} >{out}"]
        status, said = self.shard("--out", "all", command=fails)
        self.assertEqual(status, 1)
        self.assertIn("unit 3: bash", said)
        self.assertEqual(sorted(path.name for path in (self.folder / "all").glob("*.out")), ["1.out", "2.out"])
        self.assertIn("unit 3", self.refusal("all", command=fails))

    def test_bad_usage_says_what_to_write(self):
        for arguments, said in ((["--shard", "3/2", "--out", "a"], "I/N"), (["--merge", "none", "--out", "a"], "no such folder")):
            status, text = self.shard(*arguments)
            self.assertEqual(status, 2)
            self.assertIn(said, text)
        self.assertIn("has no {}", self.shard("--out", "a", command=["true", "x"])[1])
        done = subprocess.run([SHARD, "--units", "1,1", "--out", "a", "--", "echo", "{}"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("each once", done.stderr)


if __name__ == "__main__":
    unittest.main()
