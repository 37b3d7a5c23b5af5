# SPDX-License-Identifier: Apache-2.0
"""A run of the liver that tests of the log's readers begin with."""
import pathlib
import subprocess
import tempfile
import unittest

LIVER = pathlib.Path(__file__).resolve().parents[3] / "model/scenes/liver.toml"
TICKS = 3000


class RecordedRun(unittest.TestCase):
    """With cls.folder, removed at the end, and in it cls.log: TICKS of the liver by tactd of cls.build."""
    build = pathlib.Path(".")

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.log = cls.folder / "run.tactlog"
        cls.tactd(LIVER, "--free-run", "--ticks", TICKS, "--no-telemetry", "--no-black-box", "--record", cls.log)

    @classmethod
    def tactd(cls, *arguments):
        subprocess.run([str(cls.build / "tactd"), *map(str, arguments)], check=True, capture_output=True, timeout=60)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()
