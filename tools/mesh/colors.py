# SPDX-License-Identifier: Apache-2.0
"""Colours of vertices: out of what VTK has read, and onto the vertices of a repaired surface."""
import numpy as np
import vtk
from vtk.util import numpy_support

NAMES = ("RGB", "RGBA", "COLOR_0")  # as VTK calls those of PLY and glTF; else the scalars, if they are bytes


def of_surface(surface):
    """(n, 3) of 0 to 1, or None."""
    data = surface.GetPointData()
    found = next((data.GetArray(name) for name in NAMES if data.HasArray(name)), None)
    if found is None and data.GetScalars() is not None and data.GetScalars().GetDataType() == vtk.VTK_UNSIGNED_CHAR:
        found = data.GetScalars()
    return None if found is None else shares(numpy_support.vtk_to_numpy(found))


def shares(values):
    """Whole numbers are shares of the largest of their type."""
    if values.ndim != 2 or values.shape[1] < 3:
        return None
    most = np.iinfo(values.dtype).max if values.dtype.kind in "ui" else 1.0
    color = values[:, :3] / most
    return color if np.isfinite(color).all() and color.min() >= 0 and color.max() <= 1 else None


def add_of_text(surface, rows):
    """Of the words of each vertex after its place, as COFF and OBJ have them; numbers above 1 are of 255."""
    if len(rows) != surface.GetNumberOfPoints() or not rows or any(len(words) < 3 for words in rows):
        return
    try:
        color = np.array([words[:3] for words in rows], float)
    except ValueError:
        return
    array = numpy_support.numpy_to_vtk(color / 255 if color.max() > 1 else color, deep=1)
    array.SetName(NAMES[0])
    surface.GetPointData().AddArray(array)


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
