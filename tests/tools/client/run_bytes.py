# SPDX-License-Identifier: Apache-2.0
"""Chunks of a file of tact (host/PROTOCOL.md), for tests that make or damage one. Needs nothing, not even numpy."""
import struct
import zlib

LETTERS, HEADER, TICK, FRAME = 8, 16, 3, 4  # bytes at the start of a file and of a chunk; kinds


def chunk_of(kind, content):
    start = struct.pack("<III", kind, len(content), zlib.crc32(content))
    return start + struct.pack("<I", zlib.crc32(start)) + content


def byte_of_tick(path, number):
    """Where a tick's chunk begins, of a file whose ticks are all whole, and how many bytes it has."""
    data, at = path.read_bytes(), LETTERS
    while True:
        kind, size = struct.unpack_from("<II", data, at)
        if kind == TICK:
            return at + number * (HEADER + size), HEADER + size
        at += HEADER + size
