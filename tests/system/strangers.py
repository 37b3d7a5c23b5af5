# SPDX-License-Identifier: Apache-2.0
"""Another user of this PC, who fills what is to be had of tact-view without the token."""
import contextlib
import os
import signal
import socket
import time


def owner_beside_strangers(view, user, count=300):
    """What 40 requests with the token get, beside connections that are silent, read the public page, or never end."""
    child = os.fork()
    if child == 0:
        if os.geteuid() == 0:
            os.setuid(user)
        wires = []
        for i in range(count):
            with contextlib.suppress(OSError):
                wires.append(socket.create_connection(("127.0.0.1", view.port), timeout=5))
                wires[-1].sendall((b"", b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET / HT")[i % 3])
        time.sleep(60)
        os._exit(0)
    time.sleep(1.0)
    try:
        return {view.status("scene.json", view.bearer) for _ in range(40)}
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
