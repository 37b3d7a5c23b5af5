# SPDX-License-Identifier: Apache-2.0
"""What tact sends and writes, as numpy arrays: live telemetry, recordings, tick logs, black boxes.

    import tact
    for frame in tact.live():                      # of the tactd that runs as this user
        print(frame["time_ns"], frame["force_N"])
    run = tact.read_recording("run.tactrec")       # run.frames["force_N"] is (n, 3), N
    log = tact.read_ticks("run.tactlog")           # log.ticks["written_force_N"], every tick

Fields and units are those of host/PROTOCOL.md, which also has the shorter names that a tick has here. Errors are
tact.Error with a sentence. Reads alone: nothing here can move a device. Needs numpy.
"""
import array
import dataclasses
import hashlib
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

MAGIC, TELEMETRY_VERSION = 0x74636174, 5
RECORDING_VERSIONS = {7: 0, 9: 1496}  # bytes of the operator behind each frame
LOG_MAGIC, RECORDING_MAGIC = b"tactlogA", b"tactrec\n"
SEAL = b"tactseal"
PHASES = ("wake", "read", "detect", "render", "limit", "write", "publish", "total")
STATES = ("off", "ready", "armed", "stopped")


class Error(Exception):
    """A sentence: what, where, the remedy."""


def _placed(size, fields):
    return np.dtype({"names": [f[0] for f in fields], "formats": [(f[1], f[2]) if f[2] else f[1] for f in fields],
                     "offsets": [f[3] for f in fields], "itemsize": size})


MESSAGE_HEADER = np.dtype([("magic", "<u4"), ("version", "<u2"), ("kind", "<u2")])
HELLO = np.dtype([
    ("header", MESSAGE_HEADER), ("organ_vertices", "<u4"), ("organ_triangles", "<u4"), ("tool_vertices", "<u4"),
    ("tool_triangles", "<u4"), ("site_count", "<u4"), ("ring_count", "<u4"), ("ring_pitch_m", "<f4"), ("rate_Hz", "<f4"),
    ("frame_rate_Hz", "<f4"), ("force_limit_N", "<f4"), ("continuous_force_N", "<f4"), ("energy_budget_J", "<f4"),
    ("sphere_radius_m", "<f4", 4), ("sphere_offset_m", "<f4", (4, 3)), ("non_rt", "u1"), ("simulated", "u1"),
    ("scene_name", "S50"), ("torque_limit_mNm", "<u2"), ("cannot_grip", "u1"), ("limits_checksum", "S9"),
    ("device_name", "S64"), ("law_name", "S64"), ("hand_socket", "S108"), ("organ_material", "S12"),
    ("tool_material", "S12"), ("piece_count", "<u4"), ("piece_color_ratio", "<f4", (4, 3))])
FRAME_SITE = np.dtype([
    ("surface_point_m", "<f4", 3), ("normal", "<f4", 3), ("shift_m", "<f4", 3), ("depth_m", "<f4"),
    ("profile_m", "<f4", 32), ("tilt", "<f4", 3), ("state", "u1"), ("pad", "u1", 3)])
FRAME_PATCH = np.dtype([
    ("vertex_count", "<u4"), ("cut_total", "<u4"), ("cut_first", "<u4"), ("cut_count", "<u4"), ("vertex", "<u4", 180),
    ("cut_triangle", "<u4", 32), ("displacement_um", "<i2", (180, 3))])
FRAME = np.dtype([
    ("header", MESSAGE_HEADER), ("tick", "<u8"), ("time_ns", "<i8"), ("late_ticks", "<u8"), ("skipped_ticks", "<u8"),
    ("dropped_records", "<u8"), ("tool_position_m", "<f4", 3), ("tool_orientation", "<f4", 4), ("tool_velocity_mps", "<f4", 3),
    ("grip_ratio", "<f4"), ("force_N", "<f4", 3), ("torque_Nm", "<f4", 3), ("wanted_force_N", "<f4", 3),
    ("worst_margin_us", "<f4"), ("median_tick_us", "<f4"), ("peak_force_N", "<f4"), ("rms_force_N", "<f4"),
    ("given_energy_J", "<f4"), ("fault", "<u2"), ("limit", "<u2"), ("state", "u1"), ("non_rt", "u1"), ("grip_force_mN", "<i2"),
    ("contact_losses", "<u4"), ("site", FRAME_SITE, 4), ("patch", FRAME_PATCH)])
FILE_HEADER = np.dtype([("magic", "S8"), ("version", "<u4"), ("hello_bytes", "<u4"), ("frame_bytes", "<u4"),
                        ("setup_crc", "<u4"), ("mesh_bytes", "<u8")])
FRAME_RECORD = np.dtype([("frame", FRAME), ("crc", "<u4"), ("pad", "<u4")])
LOG_HEADER = np.dtype([
    ("magic", "S8"), ("header_bytes", "<u4"), ("tick_bytes", "<u4"), ("ticks", "<u8"), ("period_ns", "<i8"),
    ("limits", "<f8", 14), ("force_share", "<f8"), ("non_rt", "u1"), ("scene_hash", "S23"), ("overrides", "S1024"),
    ("scene_name", "S64"), ("law", "S64"), ("revision", "S64"), ("host", "S64"), ("began_utc", "S24"), ("header_crc", "<u4"),
    ("pad", "<u4")])
LOGGED_TICK = _placed(400, [
    ("tick", "<u8", None, 0), ("non_rt", "u1", None, 8), ("due_ns", "<i8", None, 16), ("margin_ns", "<i8", None, 24),
    ("phase_ns", "<i4", 8, 32), ("tool_position_m", "<f8", 3, 64), ("tool_orientation", "<f8", 4, 88),
    ("tool_velocity_mps", "<f8", 3, 120), ("tool_angular_velocity_radps", "<f8", 3, 144), ("tool_grip_ratio", "<f8", None, 168),
    ("grip_gap_m", "<f8", None, 176), ("grip_speed_mps", "<f8", None, 184), ("sample_stamp_ns", "<i8", None, 192),
    ("sample_sequence", "<u8", None, 200), ("sample_fresh", "u1", None, 208), ("device_fault", "<u2", None, 216),
    ("command_arm", "u1", None, 218), ("command_stop", "u1", None, 219), ("command_reset", "u1", None, 220),
    ("command_disarm", "u1", None, 221), ("ready", "u1", None, 222), ("clutch", "u1", None, 223),
    ("skipped_periods", "<u4", None, 224), ("clutches", "<u4", None, 228), ("clutch_shift_m", "<f8", 3, 232),
    ("wanted_force_N", "<f8", 3, 256), ("wanted_torque_Nm", "<f8", 3, 280), ("written_force_N", "<f8", 3, 304),
    ("written_torque_Nm", "<f8", 3, 328), ("state", "u1", None, 352), ("limit", "<u2", None, 354), ("fault", "<u2", None, 356),
    ("given_energy_J", "<f8", None, 360), ("rms_force_N", "<f8", None, 368), ("contact_losses", "<u8", None, 376),
    ("wanted_grip_N", "<f8", None, 384), ("written_grip_N", "<f8", None, 392)])
LOG_RECORD = np.dtype([("tick", LOGGED_TICK), ("crc", "<u4"), ("pad", "<u4")])


@dataclasses.dataclass
class Mesh:
    """vertex_m is (n, 3), m; triangle is (m, 3), numbers of vertices; color is (n, 3), 0 to 255, or None."""
    vertex_m: np.ndarray
    triangle: np.ndarray
    color: np.ndarray | None = None


@dataclasses.dataclass
class Recording:
    """hello is one HELLO, frames are (n,) of FRAME; damage is empty, or what is wrong with the file."""
    hello: np.void
    organ: Mesh
    tool: Mesh
    frames: np.ndarray
    damage: str


@dataclasses.dataclass
class TickLog:
    """header is one LOG_HEADER, ticks are (n,) of LOGGED_TICK; recording: of a black box, else None."""
    header: np.void
    ticks: np.ndarray
    recording: Recording
    damage: str

    @property
    def time_s(self):
        """(n,) since the first tick."""
        return (self.ticks["due_ns"] - self.ticks["due_ns"][0]) * 1e-9 if len(self.ticks) else np.empty(0)


def text(field):
    """A fixed-size text of a hello or a header."""
    return bytes(field).decode("utf-8", "replace")


def default_socket():
    """Where tactd listens without --socket."""
    run = os.environ.get("XDG_RUNTIME_DIR")
    return pathlib.Path(f"{run}/tact" if run else f"/tmp/tact-{os.getuid()}", "telemetry.sock")


class live:  # noqa: N801  # an iterator with a hello
    """Frames as they come, each one FRAME; ends when tactd is gone, however it went. hello, organ and tool are there at once.
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
        if not descriptors:
            raise Error(f"{self._path}: the first message has no meshes; is this the telemetry of tactd?")
        with os.fdopen(descriptors[0], "rb") as file:
            meshes = os.pread(file.fileno(), os.fstat(file.fileno()).st_size, 0)
        self.hello = self._message(data, HELLO, 1)
        self.organ, self.tool = _meshes(self.hello, meshes, str(self._path))

    def _receive(self, control_bytes=0):
        try:
            data, control, _, _ = self._socket.recvmsg(65536, control_bytes)
        except socket.timeout:
            raise Error(f"{self._path}: no frame for {self._timeout_s:g} s; tactd is stopped, or hangs") from None
        descriptors = [array.array("i", content[:4])[0] for level, kind, content in control
                       if (level, kind) == (socket.SOL_SOCKET, socket.SCM_RIGHTS)]
        return data, descriptors

    def _message(self, data, layout, kind):
        header = _one(data, MESSAGE_HEADER, str(self._path))
        if (header["magic"], header["kind"]) != (MAGIC, kind):
            raise Error(f"{self._path}: is no telemetry of tactd")
        if header["version"] != TELEMETRY_VERSION:
            raise Error(f"{self._path}: telemetry of version {header['version']}, this reads {TELEMETRY_VERSION}; take the "
                        "tact.py of that tactd")
        return _one(data, layout, str(self._path))

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
        return self._message(data, FRAME, 2)


def read_recording(path):
    """A recording of tact-view. Frames with a wrong checksum are left out, and damage says how many."""
    data, damage = _unsealed(path)
    return _recording(data, str(path), damage)


def read_ticks(path):
    """A log of tactd --record, or a black box. Ticks with a wrong checksum are left out, and damage says how many."""
    data, damage = _unsealed(path)
    if not data.startswith(LOG_MAGIC):
        raise Error(f"{path}: {_kind_of(data)}, no tick log or black box of this version")
    header = _one(data, LOG_HEADER, str(path))
    if zlib.crc32(data[:LOG_HEADER.itemsize - 8]) != header["header_crc"]:
        raise Error(f"{path}: its header is damaged; nothing of it can be trusted")
    if (header["header_bytes"], header["tick_bytes"]) != (LOG_HEADER.itemsize, LOG_RECORD.itemsize):
        raise Error(f"{path}: was written by another version; record it again, or read it with its own tact.py")
    body, told = data[LOG_HEADER.itemsize:], int(header["ticks"])
    count = len(body) // LOG_RECORD.itemsize
    torn = count < told or not told and len(body) % LOG_RECORD.itemsize
    ticks, bad = _good(body, LOG_RECORD, min(count, told or count), "tick", LOGGED_TICK.itemsize)
    recording, words = None, f"cut off in tick number {count + 1}" if torn else ""
    if told and not torn:
        try:
            recording = _recording(body[told * LOG_RECORD.itemsize:], str(path), "")
        except Error as error:
            words = f"its pictures: {str(error).removeprefix(f'{path}: ')}"
    return TickLog(header, ticks, recording, "; ".join(filter(None, (damage, bad, words))))


def _recording(data, where, damage):
    if not data.startswith(RECORDING_MAGIC):
        raise Error(f"{where}: {_kind_of(data)}, no recording")
    header = _one(data, FILE_HEADER, where)
    behind = RECORDING_VERSIONS.get(int(header["version"]))
    if behind is None or (header["hello_bytes"], header["frame_bytes"]) != (HELLO.itemsize, FRAME.itemsize):
        raise Error(f"{where}: a recording of version {header['version']}; record it again, or read it with its own tact.py")
    end = FILE_HEADER.itemsize + HELLO.itemsize + int(header["mesh_bytes"])
    if end > len(data):
        raise Error(f"{where}: ends before its first frame")
    setup = data[FILE_HEADER.itemsize:end]
    if zlib.crc32(setup) != header["setup_crc"]:
        raise Error(f"{where}: its hello or its meshes are damaged; nothing of it can be shown")
    hello = _one(setup, HELLO, where)
    organ, tool = _meshes(hello, setup[HELLO.itemsize:], where)
    record = np.dtype([("frame", FRAME), ("crc", "<u4"), ("pad", "<u4"), ("operator", "V", behind)] if behind else FRAME_RECORD)
    body = data[end:]
    frames, bad = _good(body, record, len(body) // record.itemsize, "frame", FRAME.itemsize)
    return Recording(hello, organ, tool, frames, "; ".join(filter(None, (damage, bad))))


def _good(data, layout, count, name, size):
    """The first part of each record that has the right checksum, and the words for the others."""
    records, step = np.frombuffer(data, layout, count), layout.itemsize
    wrong = [i for i in range(count) if zlib.crc32(data[i * step:i * step + size]) != records["crc"][i]]
    if not wrong:
        return records[name], ""
    return np.delete(records[name], wrong), f"{len(wrong)} of {count} {name}s are damaged, the first is number {wrong[0] + 1}"


def _kind_of(data):
    for magic, words in ((RECORDING_MAGIC, "a recording of tact-view (read_recording)"),
                         (LOG_MAGIC, "a tick log or black box (read_ticks)"),
                         (LOG_MAGIC[:-1], f"a tick log of version {chr(data[7]) if len(data) > 7 else '?'}")):
        if data.startswith(magic):
            return words
    return "no file of tact"


def _unsealed(path):
    """All before the seal, and what is wrong with the whole."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise Error(f"{path}: is no regular file; name one")
        data = pathlib.Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise Error(f"{path}: {getattr(error, 'strerror', None) or error}; check the name, and who may read it") from None
    end = data[-48:]
    if len(end) < 48 or end[:8] != SEAL:
        return data, "it has no end: it was cut off, its program was killed, or it is still being written"
    whole = struct.unpack("<Q", end[8:16])[0] == len(data) - 48 and hashlib.sha256(memoryview(data)[:-48]).digest() == end[16:]
    return data[:-48], "" if whole else "its bytes are not those that were written"


def _one(data, layout, where):
    if len(data) < layout.itemsize:
        raise Error(f"{where}: {len(data)} bytes where {layout.itemsize} are due; is it whole, and of this version?")
    return np.frombuffer(data, layout, 1)[0]


def _meshes(hello, data, where):
    sizes = {part: (int(hello[part + "_vertices"]), int(hello[part + "_triangles"])) for part in ("organ", "tool")}
    out, at, colors = [], 0, 3 * sizes["organ"][0]
    if len(data) - 12 * sum(map(sum, sizes.values())) not in (0, colors):
        raise Error(f"{where}: its meshes are not as long as the hello says")
    for vertices, triangles in sizes.values():
        out.append(Mesh(np.frombuffer(data, "<f4", 3 * vertices, at).reshape(-1, 3),
                        np.frombuffer(data, "<u4", 3 * triangles, at + 12 * vertices).reshape(-1, 3)))
        at += 12 * (vertices + triangles)
    out[0].color = np.frombuffer(data, "u1", colors, at).reshape(-1, 3) if len(data) > at else None
    return out
