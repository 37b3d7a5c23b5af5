#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page "From bare PC to first force" does what it says: runs each of its commands, and compares what appears.

    first_force.py PAGE.md BASE      needs root; BASE is a base system, with the packages in its /root

Of a block, a line that begins with "$ " is a command, and the lines below it are what must appear, in that order; "..." is
for anything. The commands run in a chroot, for tests/debian_packages.sh: no kernel boots there and no systemd runs, so
reboot, uname, editor and systemctl are stand-ins, long measurements are cut, and a fault of the PC is none of the page.
"""
import pathlib
import re
import subprocess
import sys

STAND_INS = {
    "sudo": 'exec "$@"',
    "apt": 'exec apt-get --no-install-recommends "$@"',  # no kernel is installed here
    "reboot": ":",
    "uname": 'echo "#1 SMP PREEMPT_RT Debian 6.1"',
    "editor": 'test -e "$1"',
    # What the unit starts, as its user, with its folders, as a service: it waits for a person to arm it.
    "systemctl": """case $1 in
  start) shift ;;
  stop) pkill -x tactd; while pgrep -x tactd >/dev/null; do sleep .1; done; exit 0 ;;
esac
for unit; do case $unit in
  tactd@*) install -d -o tact -g haptics -m 0750 /run/tact /var/lib/tact
    rm -f /root/tactd.log
    export NOTIFY_SOCKET=@tact-none XDG_RUNTIME_DIR=/run XDG_STATE_HOME=/var/lib
    setsid timeout 300 runuser -u tact -g haptics -- tactd /etc/tact/"${unit#tactd@}".toml --viewers haptics \\
      >/root/tactd.log 2>&1 </dev/null &
    for i in $(seq 100); do grep -qs "force is off" /root/tactd.log && continue 2; sleep .1; done
    cat /root/tactd.log; exit 1 ;;
  tact-view) test -x /usr/bin/tact-view ;;
  *) exit 1 ;;
esac; done""",
}
MAY_FAIL = re.compile(r"^(tact-doctor|sudo tactctl \S+ reset)\b")  # a red PC; nothing to reset
ENVIRONMENT = ("HOME=/root", "USER=root", "TERM=dumb", "LANG=C.UTF-8", "DEBIAN_FRONTEND=noninteractive",
               "PATH=/root/stand-ins:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin")


def steps(page):
    """(command, lines that must appear), in the order of the page."""
    found = []
    for block in re.findall(r"^```\n(.*?)^```", page, re.S | re.M):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def shortened(command):
    return re.sub(r"--duration \d+", "--duration 2", command)


def is_shown(expected, output):
    pattern = "\n".join(r"(?:.*\n)*?.*" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*") for line in expected)
    return re.search(r"^" + pattern, output, re.M) is not None


def run(base, command):
    """In BASE, with a mount of proc that ends with the command."""
    return subprocess.run(["unshare", "--mount", "bash", "-c", 'mount -t proc proc "$0/proc" && exec chroot "$@"', base, base,
                           "env", "-i", *ENVIRONMENT, "bash", "-c", f"cd /root && {command}"], timeout=900,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True)


def main():
    page, base = pathlib.Path(sys.argv[1]).read_text(), sys.argv[2]
    for name, text in STAND_INS.items():
        path = pathlib.Path(base, "root/stand-ins", name)
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/bash\n{text}\n")
        path.chmod(0o755)
    failed = 0
    for command, expected in steps(page):
        ended = run(base, shortened(command))
        good = is_shown(expected, ended.stdout) and (ended.returncode == 0 or MAY_FAIL.match(command))
        print("ok  " if good else "FAIL", command, flush=True)
        if not good:
            failed += 1
            print(f"status {ended.returncode}\n{ended.stdout[-3000:]}\nexpected:", *expected, sep="\n")
    print(f"first force: {len(steps(page))} commands, {failed} failed")
    return 1 if failed or len(steps(page)) < 15 else 0


if __name__ == "__main__":
    sys.exit(main())
