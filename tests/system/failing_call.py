# SPDX-License-Identifier: Apache-2.0
"""Lets the n-th call of a kind fail in a program and in all that it starts, by seccomp's notifications (libseccomp).

Only calls of that kind stop for the supervisor, so that a loop keeps its deadlines.
"""
import collections
import contextlib
import ctypes
import errno
import mmap
import os
import select
import struct
import threading
import time

NOTIFY, ALLOW, GO_ON = 0x7FC00000, 0x7FFF0000, 1
PIDFD_OPEN, PIDFD_GETFD = 434, 438
lib, libc = ctypes.CDLL("libseccomp.so.2"), ctypes.CDLL(None, use_errno=True)
lib.seccomp_init.restype = ctypes.c_void_p
lib.seccomp_init.argtypes = [ctypes.c_uint32]
for function in ("seccomp_load", "seccomp_notify_fd", "seccomp_release"):
    getattr(lib, function).argtypes = [ctypes.c_void_p]


class Notification(ctypes.Structure):
    _fields_ = [("id", ctypes.c_uint64), ("pid", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("nr", ctypes.c_int),
                ("arch", ctypes.c_uint32), ("ip", ctypes.c_uint64), ("args", ctypes.c_uint64 * 6)]


class Response(ctypes.Structure):
    _fields_ = [("id", ctypes.c_uint64), ("val", ctypes.c_int64), ("error", ctypes.c_int32), ("flags", ctypes.c_uint32)]


class Supervisor:
    """`calls`: those to count. The `number`-th call, counted from the first file that the loader does not open, or
    with `by_hand` from go(), fails with `error`."""

    def __init__(self, calls, number=0, error="", by_hand=False):
        self.context = lib.seccomp_init(ALLOW)
        self.names = {}
        for call in {*calls, "openat"}:
            nr = lib.seccomp_syscall_resolve_name(call.encode())
            if nr >= 0 and lib.seccomp_rule_add(ctypes.c_void_p(self.context), ctypes.c_uint32(NOTIFY), nr, 0) == 0:
                self.names[nr] = call
        self.calls, self.number, self.error = set(calls), number, getattr(errno, error, 0)
        self.counts, self.counting, self.by_hand, self.failed = collections.Counter(), False, by_hand, ""
        self.page = mmap.mmap(-1, 8)  # the child's pid and descriptor: no call returns them
        self.thread = threading.Thread(target=self._serve, daemon=True)
        self.thread.start()

    def enter(self):
        """In the child, before exec."""
        if lib.seccomp_load(self.context) == 0:
            self.page[:] = struct.pack("ii", os.getpid(), lib.seccomp_notify_fd(self.context))
            while self.page[4]:  # exec would close the descriptor before the supervisor has it
                pass

    def go(self):
        self.counting = True

    def _descriptor(self):
        until_s = time.monotonic() + 10
        while time.monotonic() < until_s:
            pid, fd = struct.unpack("ii", self.page[:])
            if fd:
                with contextlib.closing(os.fdopen(libc.syscall(PIDFD_OPEN, pid, 0))) as process:
                    return libc.syscall(PIDFD_GETFD, process.fileno(), fd, 0)
            time.sleep(0.001)
        return -1

    def _serve(self):
        fd = self._descriptor()
        self.page[4:] = bytes(4)
        poll = select.poll()
        poll.register(fd, select.POLLIN)
        while fd >= 0:
            events = poll.poll(20_000)
            if not events or not events[0][1] & select.POLLIN:
                break
            asked = Notification()
            if lib.seccomp_notify_receive(fd, ctypes.byref(asked)) == 0:
                answer = Response(id=asked.id, flags=GO_ON)
                if self._fails(asked):
                    answer = Response(id=asked.id, error=-self.error)
                lib.seccomp_notify_respond(fd, ctypes.byref(answer))
        if fd >= 0:
            os.close(fd)
        lib.seccomp_release(self.context)

    def _fails(self, asked):
        name = self.names.get(asked.nr, "")
        if not self.counting and not self.by_hand and name == "openat":
            path = self._path(asked)
            self.counting = b".so" not in path and path != b""
        if not self.counting or name not in self.calls:
            return False
        self.counts[name] += 1
        if self.counts[name] != self.number:
            return False
        self.failed = name
        return True

    @staticmethod
    def _path(asked):
        try:
            memory = os.open(f"/proc/{asked.pid}/mem", os.O_RDONLY)
            with os.fdopen(memory, "rb", buffering=0) as file:
                return os.pread(file.fileno(), 200, asked.args[1]).split(b"\0")[0]
        except OSError:
            return b""
