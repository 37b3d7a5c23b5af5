# SPDX-License-Identifier: Apache-2.0
"""Colours of vertices, sRGB: out of what VTK has read, and onto the vertices of a repaired surface."""
import array

import numpy as np
import vtk
from vtk.util import numpy_support

TAKEN = "every vertex has to have bytes, or numbers of 0 to 1 in a format other than PLY"
ROUNDING = 1e-3  # so far beyond 0 to 1 a number may lie
LINEAR = "COLOR_0"  # glTF's, as VTK calls it
NAMES = ("RGB", "RGBA", LINEAR)  # of PLY and glTF; else the scalars, if they are bytes


def of_surface(surface):
    """(n, 3) of 0 to 1, or None; and what was left aside, or nothing."""
    data = surface.GetPointData()
    found = [data.GetArray(name) for name in NAMES]
    if data.GetScalars() is not None and data.GetScalars().GetDataType() == vtk.VTK_UNSIGNED_CHAR:
        found.append(data.GetScalars())
    found = [values for values in found if values is not None and values.GetNumberOfComponents() >= 3]
    for values in found:
        if values.GetDataType() != vtk.VTK_BIT and values.GetNumberOfTuples() == surface.GetNumberOfPoints():
            color = shares(numpy_support.vtk_to_numpy(values)[:, :3])
            if color is not None:
                return encoded(color) if values.GetName() == LINEAR else color, ""
    return None, f"{found[0].GetName()} is not read; {TAKEN}" if found else ""


def shares(values):
    """Bytes and words are shares of the largest of their type, other numbers of 255 where one is well above 1."""
    most = np.iinfo(values.dtype).max if values.dtype in (np.uint8, np.uint16) else 255.0 if values.max(initial=0) > 1.5 else 1.0
    color = values / most
    if len(color) == 0 or not np.isfinite(color).all() or color.min() < -ROUNDING or color.max() > 1 + ROUNDING:
        return None
    return color.clip(0, 1)


def encoded(linear):
    """IEC 61966-2-1."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


def add(surface, color):
    """Numbers of each vertex, as a text has them, so that of_surface finds them."""
    if len(color) == surface.GetNumberOfPoints() and len(color) > 0:
        values = numpy_support.numpy_to_vtk(np.ascontiguousarray(color), deep=1)
        values.SetName(NAMES[0])
        surface.GetPointData().AddArray(values)


def drop(surface):
    """What is there is reported as not read."""
    for name in NAMES:
        if surface.GetPointData().HasArray(name):
            surface.GetPointData().GetArray(name).SetNumberOfTuples(0)


def of_obj(path):
    """VTK 9.1 and 9.3 leave them aside. Empty where a vertex has none."""
    found = array.array("d")
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith("v "):
                words = line.split()[4:]
                if len(words) != 3:
                    return np.empty((0, 3))
                found.extend(map(float, words))
    return np.array(found).reshape(-1, 3)


def of_off(rows):
    """The words of each vertex after its place. Whole numbers are of 255."""
    if any(len(words) < 3 for words in rows):
        return np.empty((0, 3))
    try:
        color = np.array([words[:3] for words in rows], float).reshape(-1, 3)
    except ValueError:
        return np.empty((0, 3))
    # Of the type that they are written as: 0 and 1 are nearly black among whole numbers.
    is_bytes = all(word.isdigit() for words in rows for word in words[:3]) and color.max(initial=0) <= 255
    return color.astype(np.uint8) if is_bytes else color


def nearest(points, color, wanted):
    """Colour of the nearest of `points` for each of `wanted`."""
    places, cloud = vtk.vtkPoints(), vtk.vtkPolyData()
    places.SetDataTypeToDouble()
    places.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cloud.SetPoints(places)
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(cloud)
    locator.BuildLocator()
    return color[[locator.FindClosestPoint(place) for place in wanted]]
