#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-scene(5), from tactd --help-scene, and tact-device(7), from its [device] part and devices.toml.

    man_pages.py TACTD SOURCE_TREE FOLDER      writes FOLDER/man5/tact-scene.5 and FOLDER/man7/tact-device.7
"""
import pathlib
import re
import subprocess
import sys

SCENE = ("""tact-scene \\- a scene of tact, as tactd reads it
.SH DESCRIPTION
A scene names the organ, the tool, the law, the device and the limits.
.BR tactd (1)
refuses what it does not know, with file, line and remedy; proof-read one by
.PP
.nf
.B tactd mine.toml \\-\\-check \\-\\-no\\-device
.fi
.PP
Every key may be changed for one run by
.BR \\-\\-set " KEY=VALUE."
""", """.SH EXAMPLES
.PP
.nf
.B cp /usr/share/tact/scenes/liver.toml mine.toml
.B ln \\-s /usr/share/tact/scenes/meshes meshes
.B tactd mine.toml \\-\\-set limits.force_N=1
.fi
.SH FILES
.TP
.I /etc/tact/NAME.toml
scenes of the service tactd@NAME
.TP
.I /usr/share/tact/scenes/
the scenes of tact, with their meshes
.SH SEE ALSO
.BR tactd (1),
.BR tactctl (1),
.BR tact\\-device (7),
.BR tact\\-lab (1)
""")
DEVICE = ("""tact-device \\- haptic devices that tact drives, and how a scene names them
.SH DESCRIPTION
The section [device] of a
.BR tact\\-scene (5)
names the device by its kind:
.TP
.BR sim\\-delta ", " sim\\-ideal
simulated; no hardware. They arm themselves, unless they run as a service.
.TP
.BR can\\-odrive ", " can\\-cia402 ", " can\\-moteus
a delta of your own on a CAN bus, by its drives. The bus is can0 unless device.can.interface says otherwise.
.TP
.B falcon
a Novint Falcon, by USB.
.TP
.BR force\\-dimension ", " phantom
a device of Force Dimension, a PHANTOM or a 3D Systems Touch, by the SDK of its vendor, which is no part of tact.
.PP
.B tactd \\-\\-list\\-devices
lists what is plugged in, what it lacks, and the remedy. The group haptics may use these devices, by a rule of udev:
.B sudo adduser $USER haptics
, and log in again. Hardware stays without force until a person arms it:
.B tactctl SCENE arm
for a tactd of one's own;
.B sudo tactctl /etc/tact/NAME.toml arm
for the service tactd@NAME, whose socket hears the user tact and root alone. The group haptics may not arm it.
.PP
Emergency stop, dead\\-man switch and enable are lines of a GPIO chip, device.lines. A PC is no safety device: what can
hurt needs an emergency stop that removes power without asking a PC.
.SH KEYS
""", """.SH FILES
.TP
.I /usr/share/tact/pc/devices.toml
the example above
.TP
.I /usr/lib/udev/rules.d/60\\-tact.rules
who may open a device
.TP
.I /usr/share/tact/pc/80\\-can0.network, /usr/share/tact/pc/80\\-can0.link, /usr/share/tact/pc/can0.ifupdown
the CAN bus, for systemd-networkd or ifupdown; copied to /etc by a person
.TP
.I /usr/share/tact/pc/tactd\\-device.conf
a service that follows its device; copied to /etc by a person
.SH SEE ALSO
.BR tactd (1),
.BR tactctl (1),
.BR tact\\-scene (5),
.BR tact\\-limits (1),
.BR tact\\-calibrate (1)
""")


def literal(text):
    """As written, with nothing read as roff."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").splitlines()
    return ".nf\n" + "\n".join(f"\\&{line}" if line[:1] in ".'" else line for line in lines) + "\n.fi\n"


def device_sections(help_text):
    return "\n\n".join(part.rstrip() for part in re.split(r"\n\n+", help_text) if part.startswith("[device"))


def example(source):
    """devices.toml without its own head."""
    text = (source / "tools/deploy/devices.toml").read_text()
    return text[text.index("[device]"):].rstrip()


def page(name, section, body):
    return f'.TH {name.upper()} {section} "" tact "tact"\n.SH NAME\n' + body


def main():
    tactd, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    keys = subprocess.run([tactd, "--help-scene"], capture_output=True, text=True, check=True).stdout
    pages = {"man5/tact-scene.5": page("tact\\-scene", 5, SCENE[0] + ".SH KEYS\n" + literal(keys) + SCENE[1]),
             "man7/tact-device.7": page("tact\\-device", 7, DEVICE[0] + literal(device_sections(keys)) + ".SH EXAMPLES\n" +
                                        literal(example(source)) + DEVICE[1])}
    for name, text in pages.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


if __name__ == "__main__":
    main()
