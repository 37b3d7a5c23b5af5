# SPDX-License-Identifier: Apache-2.0
"""Files of triangle surfaces, all that VTK reads and OFF, as vtkPolyData and as arrays; OBJ to write."""
import itertools
import json
import os
import pathlib
import re
import struct
import urllib.parse

import numpy as np
import vtk
from vtk.util import numpy_support

import colors

MOST_BYTES = 2_000_000_000
MOST_COORDINATE = 1e12  # file units
AGAIN = "; export the mesh again"
FORMATS = "OBJ, STL, PLY, VTK, VTP, OFF, glTF or GLB"
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf|infinity)(?:\([^)]*\))?", re.I)
READERS = {".obj": vtk.vtkOBJReader, ".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader, ".vtk": vtk.vtkPolyDataReader,
           ".vtp": vtk.vtkXMLPolyDataReader, ".gltf": vtk.vtkGLTFReader, ".glb": vtk.vtkGLTFReader}


class Refused(Exception):
    """One sentence: file, line where known, what, remedy."""


def to_vtk(points, triangles):
    places = vtk.vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    ends = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_support.numpy_to_vtkIdTypeArray(ends, deep=1),
                  numpy_support.numpy_to_vtkIdTypeArray(triangles.ravel().astype(np.int64), deep=1))
    surface = vtk.vtkPolyData()
    surface.SetPoints(places)
    surface.SetPolys(cells)
    return surface


def to_numpy(surface):
    """Points (n x 3) and corners (m x 3) of a vtkPolyData that holds triangles alone."""
    if surface.GetNumberOfPolys() == 0:
        return np.empty((0, 3)), np.empty((0, 3), np.int64)
    points = numpy_support.vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    corners = numpy_support.vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return points, corners.reshape(-1, 3).astype(np.int64)


def read(path, ending=None):
    """A vtkPolyData of triangles alone, sound enough to work on, in file units. `ending`: of the path, if it has another name."""
    ending = pathlib.Path(path).suffix.lower() if ending is None else ending
    try:
        size_bytes = os.path.getsize(path)
        with open(path, "rb") as file:
            beginning = file.read(84)
    except OSError as wrong:
        raise Refused(f"{path}: {wrong.strerror}; name a file of {FORMATS}") from None
    if size_bytes == 0:
        raise Refused(f"{path}:1: the file is empty{AGAIN}")
    if size_bytes > MOST_BYTES:
        raise Refused(f"{path}: more than 2 GB; simplify the mesh")
    if ending == ".stl":
        check_stl(path, size_bytes, beginning)
    has_float_colors = ending == ".ply" and check_ply(path, size_bytes)
    if ending == ".gltf":
        check_gltf(path)
    check_numbers(path, ending, beginning)
    if ending == ".off":
        surface = read_off(path)
    elif ending in READERS:
        surface = read_by_vtk(path, READERS[ending]())
        if ending == ".obj":
            colors.add(surface, colors.of_obj(path))
    else:
        raise Refused(f"{path}: {ending or 'no ending'} is no format that is read; export the mesh as {FORMATS}")
    if surface.GetNumberOfPolys() > 0:
        corners = np.diff(numpy_support.vtk_to_numpy(surface.GetPolys().GetOffsetsArray()))
        if (corners == 0).any():  # VTK 9.3 has so many faces as a PLY promises, without corners where it is cut
            raise Refused(f"{path}: cut short, after {(corners > 0).sum()} of {len(corners)} faces{AGAIN}")
    if has_float_colors:  # VTK has cut them to 0 and 1
        colors.drop(surface)
    surface = triangulated(surface)
    points, triangles = to_numpy(surface)
    if len(triangles) == 0 and surface.GetNumberOfPoints() > 0:
        raise Refused(f"{path}: no faces in it, {surface.GetNumberOfPoints()} points alone; "
                      "make a surface of them in a mesh editor")
    if len(triangles) == 0:
        raise Refused(f"{path}: no faces in it; export the mesh with faces")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise Refused(f"{path}: a face names vertex {triangles.max() + 1} of {len(points)}{AGAIN}")
    sane = (np.abs(points) <= MOST_COORDINATE).all(1)  # a NaN is not
    if not sane.all():
        raise Refused(f"{path}{line_of_no_number(path, ending)}: "
                      f"vertex {np.argmin(sane) + 1} is not finite, or beyond 1e12{AGAIN}")
    return surface


def numbers_of_text(path, ending, beginning):
    """(line, words that must be numbers, how many of them or None) of a text of STL, PLY, VTK or VTP; nothing of other files."""
    if ending not in (".stl", ".ply", ".vtk", ".vtp") or ending == ".stl" and b"\0" in beginning:
        return
    with open(path, encoding="latin-1", newline="\n") as file:
        lines = enumerate(file, 1)
        if ending == ".stl":
            yield from ((number, words[1:], 3) for number, words in ((n, line.split()) for n, line in lines)
                        if words and words[0].lower() == "vertex")
        elif ending == ".ply":
            head = [line.strip() for _, line in itertools.takewhile(lambda row: row[1].strip() != "end_header", lines)]
            if any(line.startswith("format ascii") for line in head):
                yield from ((number, line.split(), None) for number, line in lines)
        elif ending == ".vtk":
            if [line.strip() for _, line in itertools.islice(lines, 3)][2:] != ["ASCII"]:
                return
            left = 0  # of the places: what follows them is names and counts
            for number, line in lines:
                words = line.split()
                if left > 0:
                    yield number, words[:left], None
                    left -= len(words)
                elif words[:1] == ["POINTS"] and words[1:2] and words[1].isdecimal():
                    left = 3 * int(words[1])
        else:
            for number, line in lines:
                if (array := re.search("<DataArray[^>]*ascii", line)) is None:
                    continue
                line = line[array.end():].partition(">")[2]
                while True:
                    text, end, _ = line.partition("</")
                    yield number, text.split(), None
                    if end or (row := next(lines, None)) is None:
                        break
                    number, line = row


def check_numbers(path, ending, beginning):
    """A library takes 1,5 for 1, and a word for 0 or for the end, without a word of its own."""
    for line, words, count in numbers_of_text(path, ending, beginning):
        bad = next((word for word in words if not NUMBER.fullmatch(word)), None)
        if bad is not None:
            raise Refused(f"{path}:{line}: {bad[:24]!r} is no number; "
                          f"{'write a point for its comma' if ',' in bad else 'export the mesh again'}")
        if count is not None and len(words) != count:
            raise Refused(f"{path}:{line}: {len(words)} numbers where {count} belong{AGAIN}")


def check_stl(path, size_bytes, beginning):
    """Binary STL says how many triangles follow. Of fewer VTK reads what there is, without a word."""
    if beginning.lstrip().startswith(b"solid") and b"\0" not in beginning:
        return
    if size_bytes < 84:
        raise Refused(f"{path}: no STL: neither 'solid' nor a head of 84 bytes{AGAIN}")
    triangles = struct.unpack_from("<I", beginning, 80)[0]
    if triangles == 0:
        raise Refused(f"{path}: no faces in it; export the mesh with faces")
    if size_bytes < 84 + 50 * triangles:
        raise Refused(f"{path}: cut short, after {(size_bytes - 84) // 50} of {triangles} triangles{AGAIN}")


def check_ply(path, size_bytes):
    """VTK reserves what the head promises: one that promises more elements than the file has bytes fills the memory. Are
    its colours no bytes?"""
    with open(path, "rb") as file:
        head = file.read(65536).split(b"end_header")[0].decode("ascii", errors="replace")
    promised = sum(int(count) for count in re.findall(r"^element \w+ (\d+)\s*$", head, re.MULTILINE))
    if promised > size_bytes:
        raise Refused(f"{path}: its head promises {promised} vertices and faces, and the file has {size_bytes} bytes{AGAIN}")
    return re.search(r"^property (float|double)\w* (red|green|blue)\s*$", head, re.MULTILINE) is not None


def check_gltf(path):
    """VTK crashes where a buffer is missing or too short, and knows no %20 in its name."""
    try:
        with open(path, "rb") as file:
            buffers = [(buffer["uri"], buffer["byteLength"]) for buffer in json.load(file)["buffers"] if "uri" in buffer]
        named = [(uri, urllib.parse.unquote(uri), int(size)) for uri, size in buffers if not uri.startswith("data:")]
    except (ValueError, KeyError, TypeError, AttributeError):
        return  # VTK says what is wrong
    for uri, name, size_bytes in named:
        buffer = pathlib.Path(path).parent / name
        if not buffer.is_file():
            raise Refused(f"{path}: its buffer file {name!r} is missing beside it; "
                          "copy it there, or export as GLB, which is one file")
        if buffer.stat().st_size < size_bytes:
            raise Refused(f"{path}: its buffer file {name!r} is cut short, {buffer.stat().st_size} of {size_bytes} bytes{AGAIN}")
        if name != uri:
            raise Refused(f"{path}: VTK does not read the name of its buffer file {name!r}; export as GLB, which is one file")


def line_of_no_number(path, ending):
    """":LINE" of the first vertex of an STL text that is no number; else nothing."""
    if ending != ".stl":
        return ""
    with open(path, encoding="ascii", errors="replace") as file:
        return next((f":{number}" for number, line in enumerate(file, 1)
                     if re.match(r"\s*vertex\b.*\b(nan|inf)", line, re.I)), "")


def read_by_vtk(path, reader):
    said = vtk.vtkStringOutputWindow()
    vtk.vtkOutputWindow.SetInstance(said)
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    reader.SetFileName(path)
    reader.Update()
    text = said.GetOutput()
    if isinstance(text, bytes):  # VTK quotes the file, and that is not text
        text = text.decode(errors="replace")
    if "ERROR" in text:
        raise Refused(complaint(path, text))
    surface = reader.GetOutput()
    if surface.IsA("vtkCompositeDataSet"):  # glTF: all meshes, each at its place
        together = vtk.vtkCompositeDataGeometryFilter()
        together.SetInputData(surface)
        together.Update()
        surface = together.GetOutput()
    return surface


def complaint(path, text):
    """VTK's first error, without the place in VTK's own sources, and with the line of the file where VTK says it."""
    lines = [line.strip() for line in text.split("ERROR", 1)[1].splitlines()[1:] if line.strip()]
    what = (lines[0] if lines else "").split("): ", 1)[-1].rstrip(".")
    line = re.search(r"\b[Ll]ine (\d+)", what)
    what = re.sub(r".*(?:\bat line \d+:|\bat line \d+, column \d+, byte index \d+:|\* Line \d+, Column \d+)\s*", "", what)
    if not what or what.startswith("Algorithm"):
        what = "is not of the format that its ending says"
    return f"{path}{':' + line[1] if line else ''}: {what[:120]}{AGAIN}"


def read_off(path):
    """OFF and COFF as text, which this VTK does not read: the counts, a vertex a line, a face a line after its count."""
    with open(path, encoding="ascii", errors="replace") as file:
        rows = [(number, line.split("#")[0].split()) for number, line in enumerate(file, 1)]
    rows = iter([(number, words) for number, words in rows if words])
    number, words = 1, []
    places, cells, after = vtk.vtkPoints(), vtk.vtkCellArray(), []
    places.SetDataTypeToDouble()
    try:
        number, words = next(rows)
        if words[0] not in ("OFF", "COFF"):
            raise Refused(f"{path}:{number}: does not begin with OFF; export the mesh as OFF text")
        if len(words) == 1:
            number, words = next(rows)
        vertices, faces = (int(word) for word in words[-3:-1])
        for _ in range(vertices):
            number, words = next(rows)
            places.InsertNextPoint(*(float(word) for word in words[:3]))
            after.append(words[3:])
        for _ in range(faces):
            number, words = next(rows)
            corners = [int(word) for word in words[1:int(words[0]) + 1]]
            if len(corners) != int(words[0]) or len(corners) < 3:
                raise Refused(f"{path}:{number}: the face has {len(corners)} corners{AGAIN}")
            if min(corners) < 0 or max(corners) >= vertices:
                raise Refused(f"{path}:{number}: the face names vertex {max(corners)} of {vertices}, from 0{AGAIN}")
            cells.InsertNextCell(len(corners), corners)
    except StopIteration:
        raise Refused(f"{path}:{number}: the file ends too early{AGAIN}") from None
    except (ValueError, TypeError, OverflowError):
        raise Refused(f"{path}:{number}: '{' '.join(words)[:24]}' is not what OFF has there{AGAIN}") from None
    surface = vtk.vtkPolyData()
    surface.SetPoints(places)
    surface.SetPolys(cells)
    colors.add(surface, colors.of_off(after))
    return surface


def triangulated(surface):
    """Polygons and strips cut; lines and single vertices dropped."""
    cut = vtk.vtkTriangleFilter()
    cut.SetInputData(surface)
    cut.PassLinesOff()
    cut.PassVertsOff()
    cut.Update()
    return cut.GetOutput()


def write_obj(path, points, triangles, color=None):
    with open(path, "w", encoding="ascii") as file:
        file.write("# made by tact-mesh\n")
        if color is None:
            np.savetxt(file, points, "v %.9g %.9g %.9g")
        else:
            np.savetxt(file, np.hstack([points, color]), "v %.9g %.9g %.9g %.4g %.4g %.4g")
        np.savetxt(file, triangles + 1, "f %d %d %d")
