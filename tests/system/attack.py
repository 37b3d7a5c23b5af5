#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a stranger of this PC, a broken program and a broken disk can do to tactd and tact-view.

    python3 tests/system/attack.py BUILD_DIR     (tactd, tact-view)

Whole programs, hostile input, a fixed seed, less than a minute. It asks of each attack that the programs live,
that they hold their bounds, and that nothing is shown without the token. What one function can be asked is asked in
tests/host/server and tests/model/io; folders, pipes, nesting and numbers that are none, of every program, in
tests/tools/program/bad_input_test.cc. Prints "N passed, M failed"; exit status 0 or 1.
"""
import base64
import contextlib
import json
import os
import random
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/tools/client"))
from run_bytes import FRAME, chunk_of  # noqa: E402
from strangers import owner_beside_strangers  # noqa: E402
BUILD = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build").resolve()
LIMIT_S, MIB, STRANGER = 240, 1 << 20, 65534
FIVE_MINUTES = 18_000  # frames at 60 Hz
SECRET = ("scene.json", "mesh.bin", "recording.csv", "recording.tactview", "session", "live", "none")
rng = random.Random(15)
passed = failed = 0
started = []


def check(message, holds, seen=""):
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    print(f"{'ok    ' if holds else 'FAILED'} {message}{f' ({seen})' if seen != '' else ''}", flush=True)


def start(program, *arguments):
    started.append(subprocess.Popen([BUILD / program, *map(str, arguments)], stdout=subprocess.PIPE,
                                    stderr=subprocess.DEVNULL, text=True))
    return started[-1]


def too_long(*_):
    raise TimeoutError(f"not done in {LIMIT_S} s")


def end(program):
    program.send_signal(signal.SIGINT)
    return program.wait(10)


def resident_bytes(program):
    return int(Path(f"/proc/{program.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class View:
    """A running tact-view."""

    def __init__(self, *arguments):
        self.program = start("tact-view", *arguments, "--port", 0, "--json", "--page", PAGE)
        ready = json.loads(self.program.stdout.readline())
        self.port, self.bearer = ready["port"], f"Authorization: Bearer {ready['token']}\r\n"

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port), timeout=5)

    def say(self, raw, wait_s=5.0):
        """What comes back until the connection ends, or no more comes."""
        answer = b""
        with self.connect() as wire:
            wire.settimeout(wait_s)
            with contextlib.suppress(OSError):
                wire.sendall(raw)
                while part := wire.recv(65536):
                    answer += part
        return answer

    def status(self, path, header=""):
        request = f"GET /{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n{header}\r\n"
        return int(self.say(request.encode())[9:12] or 0)

    def live(self):
        """A WebSocket of the page."""
        wire = self.connect()
        key = base64.b64encode(rng.randbytes(16)).decode()
        wire.sendall((f"GET /live HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\nUpgrade: websocket\r\n"
                      f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
                      f"{self.bearer}\r\n").encode())
        return wire if wire.recv(4096).startswith(b"HTTP/1.1 101") else None


def text_frame(text):
    mask = rng.randbytes(4)
    head = bytes([0x81, 0x80 | len(text)]) if len(text) < 126 else b"\x81\xfe" + struct.pack(">H", len(text))
    return head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(text))


def without_token(view):
    seen = {(path, view.status(path + query, header)) for path in SECRET for query in ("", "?token=0", "?token=")
            for header in ("", "Authorization: Bearer 0\r\n", "Authorization: Bearer\r\n", "Cookie: token=\r\n")}
    check("nothing is shown without the token", {status for _, status in seen} == {401}, sorted(seen)[:3])
    check("all is shown with it", view.status("scene.json", view.bearer) == 200)
    check("a foreign name is refused", view.say(b"GET /scene.json HTTP/1.1\r\nHost: evil.example\r\n" +
                                                view.bearer.encode() + b"\r\n", 0.3)[9:12] == b"403")


def requests_that_are_none(view):
    good = f"GET /scene.json HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n{view.bearer}\r\nab".encode()
    statuses, before = {}, resident_bytes(view.program)
    for i in range(200):
        raw = bytearray(good if i % 2 else rng.randbytes(rng.randrange(1, 3000)))
        for _ in range(rng.randrange(1, 6)):
            raw[rng.randrange(len(raw))] = rng.randrange(256)
        status = view.say(bytes(raw) + b"\r\n\r\n", 0.02)[9:12].decode()
        statuses[status] = statuses.get(status, 0) + 1
    known = {"", "200", "400", "401", "403", "404", "405", "413", "431"}
    check("200 broken requests get an answer in HTTP", set(statuses) <= known and statuses.get("400", 0) > 50, statuses)
    check("a header without an end is refused", view.say(b"GET / HTTP/1.1\r\nA: " + b"a" * MIB)[9:12] == b"431")
    check("a body of gigabytes is refused", view.say(
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999999999\r\n\r\n" + b"a" * MIB)[9:12] == b"413")
    grown = (resident_bytes(view.program) - before) / MIB
    check("... and takes no memory", grown < 20, f"{grown:.0f} MiB")


def long_run(tactd_path, path):
    """A tact-view that has seen five minutes, which one frame of a true tactd makes up."""
    true = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    true.connect(str(tactd_path))
    (magic, (start,), _, _), frame = socket.recv_fds(true, 65536, 1), true.recv(65536)
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    listener.bind(str(path))
    listener.listen(1)
    view = View("--socket", path)
    wire, _ = listener.accept()
    socket.send_fds(wire, [magic], [start])
    for i in range(1, FIVE_MINUTES + 1):
        wire.send(chunk_of(FRAME, struct.pack("<Qq", i, i * 16_666_667) + frame[32:]))  # tick, time, the rest
    return view, wire


def connections(view):
    before = resident_bytes(view.program)
    wires, let_in = [], 0
    for i in range(100):
        wire = view.connect()
        name = "recording.csv" if i % 2 else "recording.tactview"
        wire.sendall(f"GET /{name} HTTP/1.1\r\nHost: localhost\r\n{view.bearer}\r\n".encode())
        wires.append(wire)
    time.sleep(1.0)
    for wire in wires:
        with contextlib.suppress(ConnectionResetError):  # turned away, its words lost as ours came too late
            let_in += wire.recv(12) == b"HTTP/1.1 200"
    grown = (resident_bytes(view.program) - before) / MIB
    check("of 100 downloads that are not read 64 are let in", 63 <= let_in <= 64, let_in)
    check("... and share their frames", grown < 64, f"{grown:.0f} MiB")
    _ = [wire.close() for wire in wires]
    time.sleep(0.3)
    slow = [view.connect() for _ in range(40)]
    for wire in slow:
        wire.sendall(b"GET / HT")
    check("40 requests that never end delay no other", view.status("scene.json", view.bearer) == 200)
    _ = [wire.close() for wire in slow]


def web_sockets(view):
    wire = view.live()
    check("the page's WebSocket opens", wire is not None)
    for text in (b"{", b"\xff\xfe", b"[" * 900, b'{"seen":1e400}', b'{"seen":-1}', b'{"hand":{"x_m":1e999}}',
                 b'{"hand":{"x_m":"a","y_m":[],"z_m":{},"grip_ratio":null}}', b'{"force_N":[9,9,9]}',
                 *(b'{"request":{"scene":"%s}}' % a for a in (b'../x"', b'liver;ls"', b'liver","set":{"device.kind":1}'))):
        view.live().sendall(text_frame(text))
    for _ in range(40):
        view.live().sendall(rng.randbytes(rng.randrange(2, 2000)))
    view.live().sendall(text_frame(b"a" * 60000))
    check("WebSockets that talk nonsense delay no other", view.status("scene.json", view.bearer) == 200)
    check("... and the program that started tact-view gets no request", not select.select([view.program.stdout], [], [], 0.5)[0])


def as_stranger(action):
    """True if `action` of another user fails."""
    child = os.fork()
    if child == 0:
        try:
            os.setuid(STRANGER)
            action()
        except OSError:
            os._exit(0)
        os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def sockets(tactd, path):
    for _ in range(20):
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as wire:
            wire.connect(str(path))
            with contextlib.suppress(OSError):
                wire.send(rng.randbytes(500))
    hand = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    hand.setblocking(False)
    for _ in range(500):
        with contextlib.suppress(BlockingIOError):
            hand.sendto(rng.randbytes(rng.choice((0, 1, 39, 40, 41, 4000))), f"{path}.hand")
    check("nonsense at its sockets does not end tactd", tactd.poll() is None)
    if os.geteuid() != 0:
        return
    for kind, name in ((socket.SOCK_SEQPACKET, path), (socket.SOCK_DGRAM, f"{path}.hand")):
        check(f"another user does not reach {Path(name).name}",
              as_stranger(lambda: socket.socket(socket.AF_UNIX, kind).connect(str(name))))


def false_tactd(folder):
    """tact-view believes no message of a tactd that is none."""
    path = folder / "false.sock"
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    listener.bind(str(path))
    listener.listen(8)
    listener.settimeout(3)
    view = View("--socket", path)
    for size in (0, 1, 8, 4000, 60000):
        wire, _ = listener.accept()
        wire.send(rng.randbytes(size))
        time.sleep(0.05)
        wire.close()
    check("a false tactd shows nothing", view.status("scene.json", view.bearer) == 503)
    check("... and tact-view ends cleanly", end(view.program) == 0)


def run_status(*command):
    return subprocess.run([BUILD / command[0], *map(str, command[1:])], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, timeout=20).returncode


def files(folder, recording):
    log, scene = folder / "run.tactlog", ROOT / "model/scenes/liver.toml"
    run_status("tactd", scene, "--free-run", "--ticks", 200, "--no-telemetry", "--no-black-box", "--record", log)
    table = folder / "table.csv"
    for name, path, command in (("recordings", recording, ("tact-view", "--open", "{}", "--export", table)),
                                ("tick logs", log, ("tactd", scene, "--replay", "{}"))):
        whole = run_status(*(path if word == "{}" else word for word in command))
        good, bad = path.read_bytes(), folder / "spoilt"
        statuses = []
        for i in range(12):
            raw, at = bytearray(good), rng.randrange(len(good))
            raw[at] ^= 1 << rng.randrange(8)
            bad.write_bytes(raw[:at] if i % 3 == 0 else raw)
            statuses.append(run_status(*(bad if word == "{}" else word for word in command)))
        check(f"{name} with a flipped bit or without their end are reported", whole == 0 and set(statuses) <= {1, 2},
              (whole, statuses))


def run(folder):
    path, recording = folder / "tactd.sock", folder / "view.tact"
    tactd = start("tactd", ROOT / "model/scenes/liver.toml", "--socket", path, "--no-black-box")
    run_status("tactd", ROOT / "model/scenes/liver.toml", "--parameters", "--json", folder / "liver.json")
    view = View("--socket", path, "--record", recording, "--scenes", folder)
    for _ in range(200):
        if view.status("scene.json", view.bearer) == 200:
            break
        time.sleep(0.05)
    long_view, _wire = long_run(path, folder / "long.sock")
    connections(long_view)
    check("... and tact-view lives (connections)", end(long_view.program) == 0)
    for attack in (without_token, requests_that_are_none, web_sockets):
        attack(view)
        check(f"... and tact-view lives ({attack.__name__})", view.program.poll() is None)
    check("300 connections without the token lock its owner out of nothing", owner_beside_strangers(view, STRANGER) == {200})
    sockets(tactd, path)
    check("tact-view ends cleanly", end(view.program) == 0)
    check("tactd ends cleanly", end(tactd) in (0, 1))
    check("... and takes its sockets along", not path.exists() and not Path(f"{path}.hand").exists())
    false_tactd(folder)
    files(folder, recording)


with tempfile.TemporaryDirectory(prefix="tact-attack-") as name:
    os.chmod(name, 0o755)  # so that another user's failure is that of the socket
    PAGE = Path(name) / "page"
    PAGE.mkdir()
    (PAGE / "index.html").write_text("<html>")
    signal.signal(signal.SIGALRM, too_long)
    signal.alarm(LIMIT_S)  # against every hang
    begun_s = time.monotonic()
    try:
        run(Path(name))
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        check("runs to its end", False, error)
    finally:
        for program in started:
            program.kill()
    print(f"{passed} passed, {failed} failed, {time.monotonic() - begun_s:.0f} s")
sys.exit(failed > 0)
