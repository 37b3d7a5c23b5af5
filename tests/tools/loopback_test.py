#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Nothing of tactd, tact-view, tact-metrics and tact-ros of BUILD_DIR leaves loopback, in a network namespace that has another
interface, with an address and the default route. tact-ros that is bound to that interface is seen there.

    python3 tests/tools/loopback_test.py BUILD_DIR

Needs root or user namespaces, iproute2, and what the programs need; without tact-ros it leaves that out. Exit status 0 or 1.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from processes import ProcessCase, until  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
LIVER = ROOT / "model/scenes/liver.toml"
HAS_ROS = (BUILD / "tact-ros").exists()
OUT = "out0"
# IPv6 off: the kernel itself would ask for routers.
NETWORK = f"""set -e
ip link set lo up
ip link add {OUT} type veth peer name far0
for one in {OUT} far0; do echo 1 > /proc/sys/net/ipv6/conf/$one/disable_ipv6; done
ip address add 10.77.0.1/24 dev {OUT}
ip link set far0 up
ip link set {OUT} up
ip route add default via 10.77.0.2 dev {OUT}
exec {sys.executable} -B {__file__} {BUILD}
"""


def sent():
    """Packets that have left by the other interface."""
    line = re.search(rf"{OUT}:\s*(.*)", pathlib.Path("/proc/net/dev").read_text())[1]
    return int(line.split()[9])


def get(url):
    with urllib.request.urlopen(url, timeout=60) as answer:
        return answer.read().decode()


class Loopback(ProcessCase):
    def start(self, program, *arguments, **options):
        return super().start(BUILD / program, *arguments,
                             **{"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True, **options})

    def tactd(self):
        """Its socket and its log."""
        socket, log = self.folder / "tactd.sock", self.folder / "run.tactlog"
        self.start_tactd(BUILD, LIVER, socket, "--record", log, stdout=subprocess.DEVNULL)
        until(socket.exists, "the socket")
        return socket, log

    def test_nothing_leaves_loopback(self):
        socket, log = self.tactd()
        if HAS_ROS:
            self.start("tact-ros", log, "--domain", "7")
            peer = self.start("tests/cyclone_peer", "7", "read", "100", "3", stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              env=os.environ | {"CYCLONEDDS_URI": LOOPBACK})
            self.addCleanup(peer.stderr.close)
            self.assertEqual(peer.stderr.readline(), "matched\n")
            self.assertEqual(peer.wait(), 0, "samples have come")
        (self.folder / "index.html").write_text("a page")
        view = self.start("tact-view", "--page", self.folder, "--socket", socket, "--port", "0", "--igtl", "0", "--json")
        url = json.loads(view.stdout.readline())["url"].split("#")[0]
        self.assertRaisesRegex(urllib.error.HTTPError, "401", get, url + "scene.json")
        metrics = self.start("tact-metrics", socket, "--listen", "127.0.0.1:0").stdout.readline().strip()
        until(lambda: re.search(r"tact_ticks_total\{.*\} [1-9]", get(metrics)), "frames at tact-metrics")
        self.assertEqual(sent(), 0)

    @unittest.skipUnless(HAS_ROS, "needs tact-ros")
    def test_what_is_bound_elsewhere_is_seen_there(self):
        _, log = self.tactd()
        before = sent()
        self.start("tact-ros", log, "--domain", "8", "--interface", OUT)
        until(lambda: sent() > before, "a packet that leaves")


if __name__ == "__main__":
    if "TACT_LOOPBACK_AND_MORE" not in os.environ:
        os.environ["TACT_LOOPBACK_AND_MORE"] = "1"
        os.execvp("unshare", ["unshare", "--net", *([] if os.getuid() == 0 else ["--map-root-user"]), "sh", "-c", NETWORK])
    sys.path.insert(0, str(ROOT / "tests/host/ros"))
    sys.argv.insert(1, str(BUILD))
    from bridge import LOOPBACK
    unittest.main()
