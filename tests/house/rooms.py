# SPDX-License-Identifier: Apache-2.0
"""The rooms of the house: a folder is a namespace, a CMake target and an include path, and includes
downwards only. A room that is too full has parts: folders of one responsibility each, in the room's
namespace and library, which include each other downwards only, too. So do the folders of the page.
`breaches(tree)` says where the tree does not hold to that; `blind_rules()` tries each rule on a
breach of it.
"""
import posixpath
import re

CONTACT = ["model", "model/law", "model/contact"]
SURFACE_LAWS = [*CONTACT, "model/indent", "model/tissue", "model/springs"]
SCENE = [*SURFACE_LAWS, "model/io", "model/mesh", "model/reader", "model/scene"]
DELTA = ["model", "hal", "hal/delta"]
DEVICES = ["hal/sim", "hal/odrive", "hal/cia402", "hal/moteus", "hal/falcon_usb", "hal/force_dimension",
           "hal/phantom"]
LOOP = [*CONTACT, "hal", "hal/threads", "firmware/gate"]
OPERATOR = ["host/pose", "host/tracking", "host/figure"]
# What a folder of hal/ may include without a row below: a device, which the registry alone may include.
PLAIN_DEVICE = ["model", "hal", "hal/threads"]
# What a folder may include beside itself; CMake links no more than that.
ROOMS = {
    "model": [],
    "model/io": ["model"],
    "model/law": ["model"],
    "model/indent": ["model", "model/law"],
    "model/contact": ["model", "model/law"],
    "model/tissue": [*CONTACT, "model/indent"],
    "model/springs": CONTACT,
    "model/mesh": ["model", "model/contact", "model/io"],
    "model/reader": ["model", "model/io"],
    "model/scene": [*SURFACE_LAWS, "model/io", "model/mesh", "model/reader"],
    "hal": ["model", "model/io"],
    "hal/threads": ["model"],
    "hal/delta": ["model", "hal"],
    "hal/gpio": ["model", "hal"],
    "hal/can": DELTA,
    "hal/odrive": [*DELTA, "hal/can"],
    "hal/cia402": [*DELTA, "hal/can"],
    "hal/moteus": [*DELTA, "hal/can"],
    "hal/falcon": DELTA,
    "hal/falcon_usb": [*DELTA, "model/io", "hal/threads", "hal/falcon"],
    "hal/vendor_sdk": ["model", "hal", "hal/threads"],
    "hal/force_dimension": ["model", "hal", "hal/threads", "hal/vendor_sdk"],
    "hal/phantom": ["model", "hal", "hal/vendor_sdk"],
    "hal/sim": [*DELTA, "model/io", "hal/threads", "hal/gpio"],
    "hal/list": ["model/io", "hal", "hal/can", "hal/gpio"],
    "hal/registry": [*DELTA, "hal/can", "hal/falcon", *DEVICES, "model/reader", "model/scene"],
    "firmware/pc": ["model/io", "hal", "hal/threads", "hal/list"],
    "firmware/gate": ["model", "hal"],
    "firmware/loop": LOOP,
    "firmware/embed": [*LOOP, "model/scene", "firmware/loop"],
    "firmware/watch": ["model", "hal", "hal/threads", "firmware/loop", "firmware/pc"],
    "firmware/guardian": ["model", "hal", "hal/threads", "firmware/loop"],
    "firmware/protocol": ["model", "model/io", "firmware/loop"],
    "firmware/telemetry": [*LOOP, "firmware/loop", "firmware/protocol", "model/io", "model/scene"],
    "firmware/black_box": ["model", "hal", "hal/threads", "firmware/loop", "firmware/protocol", "firmware/telemetry"],
    "firmware/console": ["model", "model/io", "hal", "firmware/loop", "firmware/watch",
                         "firmware/protocol", "firmware/telemetry"],
    "firmware/admission": ["model", "model/contact", "model/indent", "model/law", "model/mesh", "model/scene", "hal",
                           "hal/can", "hal/threads", "firmware/gate", "firmware/loop", "firmware/pc"],
    "firmware/run": [*LOOP, *SCENE, "hal/gpio", "hal/list", "hal/registry", "firmware/loop",
                     "firmware/watch", "firmware/protocol", "firmware/telemetry", "firmware/black_box", "firmware/pc",
                     "firmware/console", "firmware/guardian", "firmware/admission"],
    "host/pose": [],
    "host/tracking": ["model", "model/io", "model/reader", "host/pose"],
    "host/figure": ["host/pose", "host/tracking"],
    "host/record": ["model", "model/io", *OPERATOR, "firmware/protocol"],
    "host/net": [],
    "host/server": ["model", "model/io", *OPERATOR, "host/record", "host/net", "firmware/protocol"],
    "host/igtl": ["model", "host/pose", "host/tracking", "host/record", "host/net"],
    "host/ros": ["model", "model/io", "hal/delta", "hal/falcon", "hal/sim", "firmware/protocol"],
    "host/run": ["model", "model/io", *OPERATOR, "host/net", "host/record", "host/igtl", "host/server", "hal/sim",
                 "firmware/protocol"],
}
# A tool measures every room above; of the other tools it may include these.
TOOLS = {
    **dict.fromkeys(["examples", "ground_truth", "printed", "program", "python"], []),
    **dict.fromkeys(["calibrate", "doctor", "mesh", "report"], ["program"]),
    **dict.fromkeys(["jitter", "limits"], ["program", "report"]),
    "sweep": ["program", "report", "ground_truth"],
    "fit": ["program", "report", "ground_truth"],
    "chart": ["program", "ground_truth"],
    "stability": ["program", "report", "printed"],
    "verify": ["program", "printed"],
    "lab": ["program", "report", "chart", "fit", "ground_truth", "mesh",
            "stability", "sweep"],
}
# The parts of a room, and what each may include of the others. What is in the room itself, as main.cc, includes
# every part, and no part includes that. Other rooms take a room as a whole.
PARTS = {
    "model/io": {"program": []},
    "tests/rig/emulators": {
        "mechanics": [],
        "run": ["mechanics"],
        "can": ["run"],
        **dict.fromkeys(["odrive", "cia402", "moteus"], ["can"]),
        "falcon": ["mechanics", "run"],
        "self_check": ["mechanics", "odrive", "cia402", "moteus", "falcon"],
    },
    "tools/chart": {
        "measure": [],
        "compare": ["measure"],
    },
    "tools/jitter": {
        "statistics": [],
        "trace": ["statistics"],
        "run": ["statistics", "trace"],
        "report": ["statistics", "run"],
    },
    "tools/limits": {
        "cases": [],
        "real_device": ["cases"],
        "verdict": ["cases"],
        "evidence": [],
        "report": ["verdict", "evidence"],
    },
    "tools/stability": {
        "sweep": [],
        "laws": [],
        "loop": [],
        "maps": ["sweep", "laws", "loop"],
    },
}
# The folders of the page, and what each may import of the others; what is in src/ itself, as main.ts, imports all.
PAGE = "host/web/src/"
PAGE_FOLDERS = {
    **dict.fromkeys(["link", "document"], []),
    **dict.fromkeys(["panels", "scene"], ["link", "document"]),
    "organ": ["link", "scene"],
    **dict.fromkeys(["operator", "controls"], ["link", "document", "panels", "scene"]),
}
# Where another room is known by these headers alone.
SINGLE_HEADERS = {
    **{(f"host/{room}", "model"): {"result.h"} for room in ("tracking", "record", "igtl", "server", "run")},
    ("host/ros", "model"): {"result.h", "time_ns.h"},
    ("host/ros", "hal/delta"): {"delta_kinematics.h"},
    ("host/ros", "hal/falcon"): {"falcon_kinematics.h"},
    **{(f"host/{room}", "hal/sim"): {"hand_target.h"} for room in ("ros", "run")},
}
# Read and write files, allocate, take their time: no header that LOOP_ROOMS include reaches them.
OFFLINE = ("model/io/", "model/mesh/", "model/reader/", "model/scene/")
LOOP_ROOMS = ("firmware/gate", "firmware/loop", "firmware/watch")
OURS = re.compile(r'^\s*#include "([^"]+)"', re.M)
IMPORTED = re.compile(r'(?:\bfrom|\bimport)\s*\(?\s*"(\.[^"]*)"')
NAMESPACE = re.compile(r"^namespace (tact(?:::\w+)+) \{", re.M)


def room_and_part(path):
    """Of a file in a part, its room and its part; of any other, its folder and nothing."""
    folder = path.rsplit("/", 1)[0]
    room, _, part = folder.rpartition("/")
    return (room, part) if part in PARTS.get(room, {}) else (folder, "")


def room_of(path):
    return room_and_part(path)[0]


def is_plain_device(room):
    return room not in ROOMS and room.startswith("hal/") and room.count("/") == 1


def may_include(room, header):
    """Tools measure every room, and tests prove them; no other room knows a tool or a test."""
    other, name = room_of(header), header.rsplit("/", 1)[1]
    if other == room:
        return True
    if room.startswith("tools/"):
        return other in ROOMS or other.removeprefix("tools/") in TOOLS[room.removeprefix("tools/")]
    if room == "hal/registry" and is_plain_device(other):
        return True
    only = SINGLE_HEADERS.get((room, other))
    return other in ROOMS.get(room, PLAIN_DEVICE) and (only is None or name in only)


def include_breaches(path, text):
    room = room_of(path)
    if room not in ROOMS and room.removeprefix("tools/") not in TOOLS and not is_plain_device(room):
        yield f"{path}:1: {room}/ is no room: give it a row in tests/house/rooms.py"
        return
    for number, line in enumerate(text.splitlines(), 1):
        found = OURS.match(line)
        if found and not may_include(room, found[1]):
            yield f"{path}:{number}: {room}/ may not include {found[1]}"


def part_breaches(path, text):
    """A folder of a room that has parts and is none; what a part may not include of its room."""
    room, part = room_and_part(path)
    inside = next((other for other in PARTS if room.startswith(other + "/")), None)
    if inside:
        yield f"{path}:1: {room}/ is no part of {inside}/: give it a row in tests/house/rooms.py"
    for number, line in enumerate(text.splitlines(), 1):
        found = OURS.match(line)
        if part and found:
            other, its = room_and_part(found[1])
            if other == room and its not in [part, *PARTS[room][part]]:
                yield f"{path}:{number}: the part {part}/ may not include {found[1]}"


def page_breaches(path, text):
    """`path` is a source of the page. An import is written relative to its own folder."""
    folder = posixpath.dirname(path).removeprefix(PAGE)
    if path.count("/") == PAGE.count("/"):
        return
    if folder not in PAGE_FOLDERS:
        yield f"{path}:1: {folder}/ is no folder of the page: give it a row in tests/house/rooms.py"
        return
    for found in IMPORTED.finditer(text):
        other = posixpath.dirname(posixpath.normpath(posixpath.join(folder, found[1])))
        if other not in [folder, *PAGE_FOLDERS[folder]]:
            line = text.count("\n", 0, found.start()) + 1
            yield f"{path}:{line}: {folder}/ may not import {found[1]}"


def namespace_breaches(path, text):
    wanted = "tact::" + room_of(path).replace("/", "::")
    for found in NAMESPACE.finditer(text):
        if found[1] != wanted:
            line = text.count("\n", 0, found.start()) + 1
            yield f"{path}:{line}: opens {found[1]}; the namespace of this folder is {wanted}"


def reach_breaches(path, text_of, seen):
    """Every header that a room of the loop reads, itself or by way of another."""
    for header in OURS.findall(text_of(path)):
        if header.startswith(OFFLINE):
            yield f"{path}:1: the loop may not reach {header}"
        elif header not in seen:
            seen.add(header)
            yield from reach_breaches(header, text_of, seen)


def cmake_breaches(path, text):
    """`path` is a list of rooms: sources by name, and links that each room may include."""
    if re.search(r"\bGLOB", text):
        yield f"{path}:1: a glob; name the sources"
    for found in re.finditer(r"\btact_room\((\S+)(.*?)\)", text, re.S):
        room, line = found[1], text.count("\n", 0, found.start()) + 1
        for target in re.findall(r"\btact_(\w+)", found[2]) if room in ROOMS else []:
            if target not in [one.replace("/", "_") for one in [room, *ROOMS[room]]]:
                yield f"{path}:{line}: links tact_{target}, which {room}/ may not include"


def breaches(texts):
    """`texts`: every source and CMakeLists.txt of production code, by its path."""
    for path, text in texts.items():
        if path.endswith("CMakeLists.txt"):
            yield from cmake_breaches(path, text)
            continue
        yield from include_breaches(path, text)
        yield from namespace_breaches(path, text)
        if room_of(path) in LOOP_ROOMS:
            yield from reach_breaches(path, lambda p: texts.get(p, ""), set())


def blind_rules():
    """Each pair of rooms that may not meet, and each rule, on a breach: the ones not seen."""
    rooms = [*ROOMS, "tools/chart", "tests/support"]
    for room in ROOMS:
        for other in rooms:
            if other == room or (other in ROOMS[room] and (room, other) not in SINGLE_HEADERS):
                continue
            if not list(include_breaches(f"{room}/x.cc", f'#include "{other}/y.h"\n')):
                yield f"{room}/ may not include {other}/"
    chain = {"firmware/loop/x.h": '#include "firmware/loop/y.h"\n',
             "firmware/loop/y.h": '#include "model/scene/scene.h"\n'}
    for name, found in {
            "a folder without a row": include_breaches("firmware/new/x.h", ""),
            "a part without a row": include_breaches("hal/new/part/x.h", ""),
            "a device without a row knows few others": include_breaches("hal/new/x.h", '#include "hal/can/y.h"\n'),
            "the registry alone knows a device": include_breaches("firmware/run/x.h", '#include "hal/new/y.h"\n'),
            "a tool without a row": include_breaches("tools/new/x.h", ""),
            "a folder that is no part": part_breaches("tests/rig/emulators/new/x.h", ""),
            "a part knows few others": part_breaches(
                "tests/rig/emulators/can/x.h", '#include "tests/rig/emulators/odrive/y.h"\n'),
            "no part knows what its room itself holds": part_breaches(
                "tests/rig/emulators/can/x.h", '#include "tests/rig/emulators/y.h"\n'),
            "a folder of the page without a row": page_breaches(f"{PAGE}new/x.ts", ""),
            "a folder of the page knows few others": page_breaches(f"{PAGE}scene/x.ts", 'import { y } from "../organ/y";\n'),
            "no folder of the page knows main.ts": page_breaches(f"{PAGE}scene/x.ts", 'await import("../main");\n'),
            "a tool knows few others": include_breaches("tools/verify/x.cc", '#include "tools/chart/y.h"\n'),
            "tools know no test": include_breaches("tools/chart/x.cc", '#include "tests/support/y.h"\n'),
            "namespace": namespace_breaches("hal/can/x.h", "namespace tact::hal {\n"),
            "reach of the loop": reach_breaches("firmware/loop/x.h", chain.get, set()),
            "glob": cmake_breaches("hal/CMakeLists.txt", "file(GLOB sources *.cc)"),
            "link": cmake_breaches("hal/CMakeLists.txt", "tact_room(hal/can LINKS tact_hal_sim)")}.items():
        if not list(found):
            yield name
