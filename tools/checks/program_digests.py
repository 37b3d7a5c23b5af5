#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Of each program, "digest name" in a line: another digest where it is another program.

    python3 tools/checks/program_digests.py BUILD_DIR PROGRAM...

The git revision that a program prints, and so its build id, is another after each commit: neither counts. A program that is
not there has no line.
"""
import hashlib
import pathlib
import re
import sys

BUILD_ID = re.compile(rb"(\x14\0\0\0\x03\0\0\0GNU\0).{20}", re.S)
REVISION = re.compile(r'TACT_GIT_REVISION="?\\"([\w.-]+)')  # padded with NUL to one length (model/CMakeLists.txt)


def digest(data, revision):
    if revision:
        data = data.replace(revision, bytes(len(revision)))
    return hashlib.blake2b(BUILD_ID.sub(rb"\1", data), digest_size=16).hexdigest()


def main():
    build, programs = pathlib.Path(sys.argv[1]), sys.argv[2:]
    rules = build / "build.ninja"
    found = REVISION.search(rules.read_text()) if rules.exists() else None
    for name in programs:
        if (build / name).is_file():
            print(digest((build / name).read_bytes(), found[1].encode() if found else b""), name)


if __name__ == "__main__":
    main()
