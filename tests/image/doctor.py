# SPDX-License-Identifier: Apache-2.0
"""tact-doctor --fix and --undo on a PC with a real GRUB, systemd and group, all of which they change."""
from pc import must


def state(pc):
    """Whatever --fix changes but its own store: the kernel's command line, the operator's groups, its files."""
    return pc.command("sudo sha256sum /boot/grub/grub.cfg; id -nG lab; systemctl list-unit-files 'tact*' --no-legend; "
                      "sudo find /etc -name '*tact-pc*' -o -name '*tact-doctor*' | sort")


def fix(pc):
    """Returns the state before."""
    must(pc.command("cat /sys/devices/system/cpu/isolated").strip() == "", "a core is isolated without tact-rt")
    before = state(pc)
    pc.command("sudo tact-doctor --fix --yes", 300)
    pc.command("sudo grep -q isolcpus= /boot/grub/grub.cfg && id -nG lab | grep -qw haptics")
    done = pc.command("systemctl is-enabled tact-pc.service; systemctl is-active tact-pc.service", may_fail=True).split()
    must(done == ["enabled", "active"], f"tact-pc.service: {done}")
    return before


def undo(pc, before):
    pc.command("sudo tact-doctor --undo --yes", 300)
    after = state(pc)
    must(after == before, f"not as before:\n{before}\n{after}")
