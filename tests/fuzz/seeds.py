#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the first inputs of every fuzzer from the published vectors: seeds.py VECTORS CORPUS."""
import hashlib
import json
import pathlib
import sys

# Which vectors hold bytes for which fuzzer; a value that is no hexadecimal string is passed over.
SOURCES = {
    'can_frame': ['can_socketcan.json', 'can_odrive.json', 'can_cia402.json'],
    'odrive': ['can_odrive.json'],
    'moteus': ['can_moteus.json'],
    'cia402': ['can_cia402.json'],
    'falcon_stream': ['falcon_packets.json'],
    'ftdi': ['falcon_packets.json'],
}


def hex_strings(value):
    """Every string of bytes in a vector file, wherever it stands."""
    if isinstance(value, dict):
        for one in value.values():
            yield from hex_strings(one)
    elif isinstance(value, list):
        for one in value:
            yield from hex_strings(one)
    elif isinstance(value, str):
        try:
            yield bytes.fromhex(value)
        except ValueError:
            return


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    vectors, corpus = map(pathlib.Path, sys.argv[1:])
    for fuzzer, files in SOURCES.items():
        folder = corpus / fuzzer
        folder.mkdir(parents=True, exist_ok=True)
        for name in files:
            for data in hex_strings(json.loads((vectors / name).read_text())):
                if data:
                    (folder / hashlib.sha1(data).hexdigest()).write_bytes(data)


if __name__ == '__main__':
    main()
