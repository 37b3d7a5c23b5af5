# SPDX-License-Identifier: Apache-2.0
"""What the tests of tact-ros share: a tick log that grows, a peer that reads topics or writes poses, and the comparison."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools/client"), str(ROOT / "tests/tools")]
sys.dont_write_bytecode = True
import numpy as np  # noqa: E402
import tact  # noqa: E402
from processes import ProcessCase, until  # noqa: E402

LIVER = ROOT / "model/scenes/liver.toml"
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
DOMAIN = str(os.getpid() % 200)
TOPICS = ("measured_cp", "measured_cv", "measured_cf", "joint_states")
JOINTS = TOPICS.index("joint_states")
RECORD = np.dtype([("topic", "u1"), ("sec", "<i4"), ("nanosec", "<u4"), ("values", "<f8", 7)])
LOOPBACK = ('<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces><AllowMulticast>false'
            '</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>100'
            '</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>')


def expected(ticks):
    """Per topic, its seven values of each tick, by the stamp."""
    zero = np.zeros((len(ticks), 1))
    rows = (np.hstack([ticks["tool_position_m"], np.roll(ticks["tool_orientation"], -1, axis=1)]),
            np.hstack([ticks["tool_velocity_mps"], ticks["tool_angular_velocity_radps"], zero]),
            np.hstack([ticks["force_N"], ticks["torque_Nm"], zero]))
    stamps = tact.utc_ns(ticks)
    return [dict(zip(stamps.tolist(), row)) for row in rows]


def wrong_values(records, ticks):
    """How many of the seven are not those of the log, bit by bit; a stamp that the log has not counts as seven."""
    known, wrong = expected(ticks), 0
    for record in records[records["topic"] != JOINTS]:
        tick = known[record["topic"]].get(int(record["sec"]) * 10**9 + int(record["nanosec"]))
        wrong += 7 if tick is None else int(np.sum(tick.view("u8") != record["values"].view("u8")))
    return wrong


def wrong_joints(records, ticks, states):
    """How many of joint_states are not the angles (within 1e-9 rad) and rates of `states`, (n, 6); and how many there were."""
    own = records[records["topic"] == JOINTS]
    known = dict(zip(tact.utc_ns(ticks).tolist(), states))
    stamps = own["sec"].astype("i8") * 10**9 + own["nanosec"]
    right = np.array([known[stamp] for stamp in stamps.tolist()]).reshape(-1, 6)
    good = np.abs(own["values"][:, :6] - right) <= 1e-9 * np.maximum(1.0, np.abs(right) * [0, 0, 0, 1, 1, 1])
    return int(np.sum(~good.all(axis=1) | (own["values"][:, 6] != 0))), len(own)


def chunk(kind, content):
    head = tact.CHUNK.pack(kind, len(content), zlib.crc32(content), 0)[:12]
    return head + zlib.crc32(head).to_bytes(4, "little") + content


class Growing:
    """The ticks of a log, or others in their place, written again into another that grows; with changes of its head."""

    def __init__(self, source, path, others=None, **changes):
        self.path, data, at, self.ticks = path, source.read_bytes(), len(tact.MAGIC), []
        while at + tact.CHUNK.size <= len(data) and data[at:at + 8] != tact.SEAL:
            kind, size, _, _ = tact.CHUNK.unpack_from(data, at)
            content = data[at + tact.CHUNK.size:at + tact.CHUNK.size + size]
            at += tact.CHUNK.size + size
            if kind == tact.HEAD:
                head = json.loads(content)
                head["run"].update(changes)
                self.head = tact.MAGIC + chunk(kind, json.dumps(head).encode())
            elif kind == tact.TICK:
                self.ticks.append(chunk(kind, content))
        if others is not None:
            self.ticks = [chunk(tact.TICK, tick.tobytes()) for tick in others]
        self.at = 0

    def begin(self):
        self.path.write_bytes(self.head)

    def add(self, count):
        with self.path.open("ab") as file:
            file.write(b"".join(self.ticks[self.at:self.at + count]))
        self.at += count

    def grow_while(self, process, out, step=20):
        """Some ticks at a time, each once the process has written what came of those before (0.2 s: they are lost, as best
        effort may), until it ends or there are no more."""
        while process.poll() is None and self.at < len(self.ticks):
            size, end = out.stat().st_size, time.monotonic() + 0.2
            self.add(step)
            while out.stat().st_size == size and process.poll() is None and time.monotonic() < end:
                time.sleep(0.002)


class Case(ProcessCase):
    peer = (BUILD / "tests/cyclone_peer",)

    def start(self, *arguments, **options):
        return super().start(*arguments, env={**os.environ, "CYCLONEDDS_URI": LOOPBACK}, **options)

    def bridge(self, log, *arguments):
        """tact-ros, and what it has said so far."""
        lines, ends = [], []
        self.addCleanup(lambda: [end() for end in ends])  # once the process has ended
        process = self.start(BUILD / "tact-ros", log, "--domain", DOMAIN, *arguments, stderr=subprocess.PIPE, text=True)
        reader = threading.Thread(target=lambda: [lines.append(line) for line in process.stderr], daemon=True)
        reader.start()
        ends += [reader.join, process.stderr.close]
        return process, lines

    def read(self, count, topics=len(TOPICS)):
        """A peer that ends when each of the first topics has so many samples, and the file of its records, of all topics. It has
        found tact-ros."""
        out = self.folder / "records"
        with out.open("wb") as file:
            peer = self.start(*self.peer, DOMAIN, "read", count, topics, stdout=file, stderr=subprocess.PIPE, text=True)
        self.addCleanup(peer.stderr.close)
        self.assertEqual(peer.stderr.readline(), "matched\n")
        return peer, out

    def follow(self, log, count, topics=len(TOPICS)):
        """The records of a log that grows, tact-ros, and what it has said."""
        process, lines = self.bridge(log.path)
        log.begin()
        until(lambda: any("ticks/s" in line for line in lines), "the head of the log")
        log.add(20)  # joint_states begins with its first state
        peer, out = self.read(count, topics)
        log.grow_while(peer, out)
        self.assertEqual(peer.wait(timeout=60), 0, f"{log.at} ticks were written\n" + "".join(lines))
        return np.frombuffer(out.read_bytes(), RECORD), process, lines

    def servo(self):
        peer = self.start(*self.peer, DOMAIN, "servo", stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.assertEqual(peer.stdout.readline(), "matched\n")
        return peer

    def send_until(self, peer, poses, done, what):
        """Sends poses() again and again, as any of them may be lost, until done()."""
        def sent():
            peer.stdin.write("".join(pose + "\n" for pose in poses()))
            peer.stdin.flush()
            return done()
        return until(sent, what)

    def simulate(self, *arguments):
        """Log and force hash of a run that is the same each time."""
        log = self.folder / "source.tactlog"
        done = subprocess.run([BUILD / "tactd", LIVER, "--free-run", "--no-telemetry", "--record", log, "--json",
                               self.folder / "run.json", *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return log, json.loads((self.folder / "run.json").read_text())["force_hash"]

    def refused(self, lines):
        """The newest number of refused poses that was reported."""
        found = [re.search(r"servo_cp: (\d+) poses refused so far", line) for line in lines]
        return max([int(one[1]) for one in found if one], default=0)

    def check_ctrl_c(self, process):
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 0)
        print(f"Ctrl-C ends tact-ros in {time.monotonic() - began:.2f} s")
