# SPDX-License-Identifier: Apache-2.0
"""Reads a triangle surface with VTK, repairs it and writes it as OBJ. tact-mesh runs this; --help there says what it does.

    /usr/bin/python3 repair.py IN OUT.obj [--ending .stl] [--weld] [--drop-degenerate] [--largest] [--close-holes] [--smooth]
                               [--hollow-refused] [--decimate N]

Prints one JSON object a line: {"step", "count", "text", "faces", "vertices"} as each step ends, {"step", "percent"} on the
way, or {"error"} with status 2.
"""
import argparse
import ctypes
import json
import pathlib
import signal
import sys

PR_SET_PDEATHSIG = 1

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))


def report(**what):
    print(json.dumps(what), flush=True)


def main():
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # without tact-mesh the output has no reader
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("source")
    options.add_argument("target")
    options.add_argument("--ending", help="of IN, where its name has none")
    for step in ("weld", "drop-degenerate", "largest", "close-holes", "smooth", "hollow-refused"):
        options.add_argument("--" + step, action="store_true")
    options.add_argument("--decimate", type=int, metavar="N")
    asked = options.parse_args()
    try:
        import numpy as np

        import colors
        import steps
        import surface_file
    except ImportError as missing:
        report(error=f"{missing.name} is missing in Debian's python3; apt install python3-vtk9 python3-numpy")
        return 2
    try:
        surface = surface_file.read(asked.source, asked.ending)
        color, left_aside = colors.of_surface(surface)
        before, faces = surface_file.to_numpy(surface)
        points, triangles = steps.repair(before, faces, asked, report)
        if color is not None:
            used = np.unique(faces)
            color = colors.nearest(before[used], color[used], points)
            report(step="color", count=len(points), text=f"{len(points)} vertices have the colour of the nearest of the file",
                   faces=len(triangles), vertices=len(points))
        elif left_aside:
            report(step="color", count=0, text=f"none: {left_aside}", faces=len(triangles), vertices=len(points))
        surface_file.write_obj(asked.target, points, triangles, color)
    except surface_file.Refused as refused:
        report(error=str(refused))
        return 2
    except MemoryError:
        report(error=f"{asked.source}: not enough memory for it; simplify the mesh")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
