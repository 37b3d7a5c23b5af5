# SPDX-License-Identifier: Apache-2.0
"""Chunks of a file of tact, for tests that make or damage one."""
import pathlib
import struct
import sys
import zlib

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools/client"))
import tact  # noqa: E402


def chunk_of(kind, content):
    start = struct.pack("<III", kind, len(content), zlib.crc32(content))
    return start + struct.pack("<I", zlib.crc32(start)) + content


def byte_of_tick(path, number):
    """Where a tick's chunk begins, of a file whose ticks are all whole, and how many bytes it has."""
    data, at = path.read_bytes(), len(tact.MAGIC)
    while True:
        kind, size, _, _ = tact.CHUNK.unpack_from(data, at)
        if kind == tact.TICK:
            return at + number * (tact.CHUNK.size + size), tact.CHUNK.size + size
        at += tact.CHUNK.size + size
