# SPDX-License-Identifier: Apache-2.0
"""What tact sends and writes, as numpy arrays: live telemetry, recordings, tick logs, black boxes.

    import tact
    for frame in tact.live():                      # of the tactd that runs as this user
        print(frame["time_ns"], frame["force_N"])
    run = tact.read_recording("run.tactview")       # run.frames["force_N"] is (n, 3), N
    log = tact.read_ticks("run.tactlog")           # log.ticks["force_N"], every tick
    print(log.fields["force_N"]["meaning"])        # unit and meaning stand in the file, too

Fields and units are those of host/PROTOCOL.md. Errors are tact.Error with a sentence. Reads alone: nothing here can move a
device. Needs numpy.
"""
import array
import dataclasses
import hashlib
import json
import os
import pathlib
import select
import socket
import stat
import struct
import zlib

try:
    import numpy as np
except ImportError:
    raise ImportError("tact.py needs numpy: apt install python3-numpy for Debian's python3, else pip install numpy") from None

MAGIC, FULL, VERSION, SEAL = b"tactrun\n", b"tactfull\n", 1, b"tactseal"
HEAD, MESHES, TICK, FRAME, OPERATOR = range(1, 6)  # kinds of chunks
KIND_NAMES = {HEAD: "heads", MESHES: "meshes", TICK: "ticks", FRAME: "frames", OPERATOR: "operators"}
CHUNK = struct.Struct("<IIII")  # kind, bytes of the content, its CRC-32, that of the twelve bytes before
TYPES = {"bool": "?", "u8": "u1", "u16": "<u2", "u32": "<u4", "u64": "<u8", "i16": "<i2", "i32": "<i4", "i64": "<i8",
         "f32": "<f4", "f64": "<f8"}


def __getattr__(name):
    """Sim: a scene as a function from poses to forces, of the module tact_sim."""
    if name != "Sim":
        raise AttributeError(f"module tact has no attribute {name}")
    try:
        import tact_sim
    except ImportError as missing:
        sources = pathlib.Path(__file__).resolve().parent.parent / "python"
        how = (f"cmake -S {sources} -B tact_sim -G Ninja && ninja -C tact_sim, then PYTHONPATH=tact_sim"
               if sources.is_dir() else "it is built from the sources of tact")
        raise ImportError(f"tact.Sim needs the module tact_sim ({missing}): {how}") from None
    return tact_sim.Sim


class Error(Exception):
    """A sentence: what, where, the remedy."""


class NoRecord(Error):
    """The file is whole, but has no records of that kind."""


@dataclasses.dataclass
class Mesh:
    """vertex_m is (n, 3), m; triangle is (m, 3), numbers of vertices; color is (n, 3), 0 to 255, or None."""
    vertex_m: np.ndarray
    triangle: np.ndarray
    color: np.ndarray | None = None


@dataclasses.dataclass
class Recording:
    """header is the dictionary of run_header.h; frames are (n,); operators are (m,), tracked, of a later frame each;
    fields says unit and meaning by name; damage is empty, or what is wrong with the file."""
    header: dict
    organ: Mesh
    tool: Mesh
    frames: np.ndarray
    operators: np.ndarray
    fields: dict
    damage: str


@dataclasses.dataclass
class TickLog:
    """header and fields as of a Recording; ticks are (n,); recording: of a black box, else None."""
    header: dict
    ticks: np.ndarray
    recording: Recording
    fields: dict
    damage: str

    @property
    def time_s(self):
        """(n,) since the first tick."""
        return (self.ticks["due_ns"] - self.ticks["due_ns"][0]) * 1e-9 if len(self.ticks) else np.empty(0)


def default_socket():
    """Where tactd listens without --socket."""
    run = os.environ.get("XDG_RUNTIME_DIR")
    return pathlib.Path(f"{run}/tact" if run else f"/tmp/tact-{os.getuid()}", "telemetry.sock")


class live:  # noqa: N801  # an iterator with a header
    """Frames as they come; ends when tactd is gone, however it went. header, fields, organ and tool are there at once.
    For a slow reader the kernel keeps about 50 frames and drops newer ones; newest=True gives the last of those that wait."""

    def __init__(self, path=None, timeout_s=5.0, newest=False):
        self._path, self._timeout_s, self._newest = pathlib.Path(path or default_socket()), timeout_s, newest
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket.settimeout(timeout_s)
        try:
            self._meet()
        except Error:
            self.close()
            raise

    def _meet(self):
        try:
            self._socket.connect(str(self._path))
        except OSError as error:
            raise Error(f"{self._path}: {error.strerror or error}; does tactd run, and may this user look?") from None
        data, descriptors = self._receive(socket.CMSG_SPACE(struct.calcsize("i")))
        if data == FULL:
            raise Error(f"{self._path}: tactd has as many viewers as it takes; close one of them")
        if data != MAGIC or not descriptors:
            raise Error(f"{self._path}: is no telemetry of this version of tactd; take the tact.py of that tactd")
        with os.fdopen(descriptors[0], "rb") as file:
            start = _File(os.pread(file.fileno(), os.fstat(file.fileno()).st_size, 0), str(self._path), "")
        self.header, self.fields = start.header, start.fields("frame")
        self.organ, self.tool = start.meshes()
        self._layout = _dtype(start.records["frame"]["fields"])

    def _receive(self, control_bytes=0):
        try:
            data, control, _, _ = self._socket.recvmsg(65536, control_bytes)
        except socket.timeout:
            raise Error(f"{self._path}: no frame for {self._timeout_s:g} s; tactd is stopped, or hangs") from None
        descriptors = [array.array("i", content[:4])[0] for level, kind, content in control
                       if (level, kind) == (socket.SOL_SOCKET, socket.SCM_RIGHTS)]
        return data, descriptors

    def _frame(self, data):
        kind, size, crc, _ = CHUNK.unpack_from(data) if len(data) >= CHUNK.size else (0, 0, 0, 0)
        content = data[CHUNK.size:]
        if (kind, size, zlib.crc32(content)) != (FRAME, self._layout.itemsize, crc):
            raise Error(f"{self._path}: a message is no frame")
        return np.frombuffer(content, self._layout, 1)[0]

    def close(self):
        self._socket.close()

    def __iter__(self):
        return self

    def __next__(self):
        if self._socket.fileno() < 0:
            raise StopIteration
        try:
            data, _ = self._receive()
            while self._newest and data and select.select([self._socket], [], [], 0)[0]:
                data, _ = self._receive()
        except OSError:
            data = b""  # reset: gone as well
        if not data:
            self.close()
            raise StopIteration
        return self._frame(data)


def read_recording(path):
    """A recording of tact-view, or the frames of a black box. Damaged frames are left out, and damage says how many."""
    file = _File(*_unsealed(path))
    recording = file.recording()
    if recording is None:
        raise NoRecord(f"{path}: has no frames; read_ticks reads a tick log")
    return recording


def read_ticks(path):
    """A log of tactd --record, or a black box. Damaged ticks are left out, and damage says how many."""
    file = _File(*_unsealed(path))
    if "tick" not in file.records:
        raise NoRecord(f"{path}: has no ticks; read_recording reads a recording")
    recording, damage = None, file.damage
    try:
        recording = file.recording()
    except Error as error:  # of a black box that lost its meshes
        damage = "; ".join(filter(None, (damage, str(error).removeprefix(f"{path}: "))))
    return TickLog(file.header, file.rows("tick"), recording, file.fields("tick"), damage)


def epoch_ns(header):
    """ns since 1970 at which CLOCK_MONOTONIC was 0, by the clocks when the run began: UTC is due_ns plus this."""
    if "began_monotonic_ns" not in header:
        raise Error("it was written before files of tact had both clocks; record it again")
    began_ns = np.datetime64(header["began_utc"].removesuffix("Z"), "ns").astype(np.int64)
    return int(began_ns) - header["began_monotonic_ns"]


def utc_ns(rows):
    """(n,) ns since 1970, of ticks or frames, by the clocks in each of them; utc_max_error_us says how true it is."""
    if "utc_offset_ns" not in (rows.dtype.names or ()):
        raise Error("its records have no UTC: it was written before; record it again")
    return rows["due_ns"] + rows["utc_offset_ns"]


def _dtype(fields):
    kinds = ((field, _dtype(field["fields"]) if "fields" in field else TYPES[field["type"]]) for field in fields)
    return np.dtype([(field["name"], kind, tuple(field.get("shape", ()))) for field, kind in kinds])


class _File:
    """The chunks of a file or memory file, by kind."""

    def __init__(self, data, where, damage):
        self._where, self._contents = where, {}
        if not data.startswith(MAGIC):
            old = data.startswith((b"tactlog", b"tactrec"))
            raise Error(f"{where}: " + ("was written before files of tact had version 1; record it again, or read it with its "
                                        "own tact.py" if old else "is no file of tact; name a recording, tick log or black box"))
        found = self._read(memoryview(data), len(MAGIC))
        self.damage = "; ".join(filter(None, (damage, *found)))
        head = self._contents.get(HEAD)
        if not head:
            raise Error(f"{where}: its head is damaged, so nothing of it can be used; record it again")
        head = json.loads(bytes(head[0]))
        if head["version"] != VERSION:
            raise Error(f"{where}: has version {head['version']}, this reads version {VERSION}; take the tact.py of its tactd")
        self.header, self.records = head["run"], head["records"]

    def _read(self, data, at):
        good, bad, lost, first_lost = {}, {}, 0, 0
        while at + CHUNK.size <= len(data):
            kind, size, crc, own = CHUNK.unpack_from(data, at)
            if own != zlib.crc32(data[at:at + 12]):
                lost, first_lost, at = lost + 1, first_lost or at, at + 1
                continue
            content = data[at + CHUNK.size:at + CHUNK.size + size]
            if len(content) < size:
                break
            if zlib.crc32(content) == crc:
                self._contents.setdefault(kind, []).append(content)
                good[kind] = good.get(kind, 0) + 1
            else:
                bad.setdefault(kind, []).append(at)
            at += CHUNK.size + size
        for kind, places in bad.items():
            whole, name = len(places) + good.get(kind, 0), KIND_NAMES.get(kind, "parts")
            yield f"{len(places)} of {whole} {name} are damaged, the first at byte {places[0]}"
        if lost:
            yield f"{lost} bytes belong to no whole part, the first at byte {first_lost}"
        elif at < len(data):
            yield f"cut off at byte {len(data)}"

    def fields(self, record):
        return {field["name"]: field for field in self.records[record]["fields"]}

    def rows(self, record):
        """(n,), of all good chunks of that record."""
        if record not in self.records:
            return np.empty(0)
        layout, contents = _dtype(self.records[record]["fields"]), self._contents.get(self.records[record]["kind"], [])
        return np.frombuffer(b"".join(content for content in contents if len(content) == layout.itemsize), layout)

    def recording(self):
        if "frame" not in self.records:
            return None
        organ, tool = self.meshes()
        return Recording(self.header, organ, tool, self.rows("frame"), self.rows("operator"), self.fields("frame"), self.damage)

    def meshes(self):
        """Organ and tool."""
        if MESHES not in self._contents:
            raise Error(f"{self._where}: its meshes are damaged or missing")
        data, out, at = self._contents[MESHES][0], [], 0
        sizes = [(self.header[part + "_vertices"], self.header[part + "_triangles"]) for part in ("organ", "tool")]
        colors = 3 * sizes[0][0]
        if len(data) - 12 * sum(map(sum, sizes)) not in (0, colors):
            raise Error(f"{self._where}: its meshes are not as long as the head says")
        for vertices, triangles in sizes:
            out.append(Mesh(np.frombuffer(data, "<f4", 3 * vertices, at).reshape(-1, 3),
                            np.frombuffer(data, "<u4", 3 * triangles, at + 12 * vertices).reshape(-1, 3)))
            at += 12 * (vertices + triangles)
        out[0].color = np.frombuffer(data, "u1", colors, at).reshape(-1, 3) if len(data) > at else None
        return out


def _unsealed(path):
    """All before the seal, the path, and what is wrong with the whole."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise Error(f"{path}: is no regular file; name one")
        data = pathlib.Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise Error(f"{path}: {getattr(error, 'strerror', None) or error}; check the name, and who may read it") from None
    end = data[-48:]
    if len(end) < 48 or end[:8] != SEAL:
        return data, str(path), "it has no end: it was cut off, its program was killed, or it is still being written"
    whole = struct.unpack("<Q", end[8:16])[0] == len(data) - 48 and hashlib.sha256(memoryview(data)[:-48]).digest() == end[16:]
    return data[:-48], str(path), "" if whole else "its bytes are not those that were written"
