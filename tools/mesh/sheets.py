# SPDX-License-Identifier: Apache-2.0
"""Which faces meet at an edge, and how sheets that meet there become surfaces of their own.

A half edge h is the side of triangle h // 3 that starts at its corner h % 3. Crowded: an edge with more than two faces.
"""
import numpy as np
import vtk

from surface_file import to_numpy, to_vtk

PARTED_RATIO = 0.01  # of the way to its neighbours, that a vertex moves when it is parted from its twin


class Edges:
    """Half edges by edge."""

    def __init__(self, triangles):
        self.start = triangles.ravel()
        self.end = np.roll(triangles, -1, axis=1).ravel()
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        _, edge, self.count = np.unique(low * (triangles.max() + 1) + high, return_inverse=True, return_counts=True)
        self.order = np.argsort(edge, kind="stable")  # of edge e: order[first[e]:first[e] + count[e]]
        self.first = np.cumsum(self.count) - self.count

    def pairs(self):
        """The two half edges of each edge that has two."""
        first = self.first[self.count == 2]
        return self.order[first], self.order[first + 1]

    def crowded(self):
        """The half edges of each crowded edge."""
        return [self.order[k:k + n] for k, n in zip(self.first[self.count > 2], self.count[self.count > 2])]

    def single(self):
        """The half edges of rims."""
        return self.order[self.first[self.count == 1]]


def doubled_areas(points, triangles):
    """Twice the area, along the outward normal."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def ring_means(points, triangles):
    """Of each vertex, the mean of its neighbours."""
    total, count = np.zeros_like(points), np.zeros((len(points), 1))
    for k in range(3):
        for step in (1, 2):
            np.add.at(total, triangles[:, k], points[triangles[:, (k + step) % 3]])
            np.add.at(count, triangles[:, k], 1)
    return total / np.maximum(count, 1)


def consistent(points, triangles):
    """Neighbours run along their edge in opposite directions; and how many faces were turned for it."""
    edges = Edges(triangles)
    one, other = edges.pairs()
    if not (edges.start[one] == edges.start[other]).any():
        return triangles, 0
    turn = vtk.vtkPolyDataNormals()
    turn.SetInputData(to_vtk(points, triangles))
    turn.ConsistencyOn()
    turn.SplittingOff()
    turn.NonManifoldTraversalOff()
    turn.ComputePointNormalsOff()
    turn.ComputeCellNormalsOn()  # without any normals it turns nothing
    turn.Update()
    after = to_numpy(turn.GetOutput())[1]
    return after, np.count_nonzero((after != triangles).any(1))


def bad_faces(triangles):
    """Those at an edge that is crowded, or whose two faces run in the same direction."""
    edges = Edges(triangles)
    one, other = edges.pairs()
    wrong = edges.start[one] == edges.start[other]
    return np.unique(np.concatenate([one[wrong], other[wrong], *edges.crowded()]).astype(np.int64) // 3)


def parted(points, triangles):
    """A surface: no bad faces. Also the number of crowded edges before. Faces that parting does not help leave a hole."""
    crowded = np.count_nonzero(Edges(triangles).count > 2)
    points, triangles = parted_sheets(points, triangles)
    while len(bad := bad_faces(triangles)):
        points, triangles = parted_sheets(points, np.delete(triangles, bad, axis=0))
    return points, triangles, crowded


def parted_sheets(points, triangles):
    """Each vertex once for each sheet that meets there, a little into that sheet's own solid."""
    half, twin = sheet_pairs(points, triangles)

    def onward(h):
        return h // 3 * 3 + (h + 1) % 3

    corner, same = np.concatenate((half, onward(half))), np.concatenate((onward(twin), twin))
    least = np.arange(triangles.size)  # of each corner: the first corner of its fan
    while True:
        joined = np.minimum(least[corner], least[same])
        after = least.copy()
        np.minimum.at(after, corner, joined)
        np.minimum.at(after, same, joined)
        after = after[after]
        if (after == least).all():
            break
        least = after
    _, first, corners = np.unique(least, return_index=True, return_inverse=True)
    vertex = triangles.ravel()[first]
    triangles, points = corners.reshape(-1, 3), points[vertex]
    twins = np.bincount(vertex)[vertex] > 1
    points[twins] += PARTED_RATIO * (ring_means(points, triangles) - points)[twins]
    return points, triangles


def sheet_pairs(points, triangles):
    """Half edges of one sheet that lie on each other. At a crowded edge: the two that bound the same solid."""
    edges = Edges(triangles)
    one, other = edges.pairs()
    opposite = edges.start[one] == edges.end[other]
    half, twin = list(one[opposite]), list(other[opposite])
    normal = doubled_areas(points, triangles)
    for around in edges.crowded():
        low = edges.start[around[0]]
        along = points[edges.end[around[0]]] - points[low]
        sign = np.where(edges.start[around] == low, 1, -1)
        away = np.cross(normal[around // 3], along) * sign[:, None]  # in the face, square to the edge
        aside = np.cross(along, away[0])
        angle = np.arctan2(away @ aside, away @ away[0] * np.linalg.norm(along))
        turn = np.argsort(angle, kind="stable")
        for k in range(len(turn)):  # clockwise of a face that runs along the edge lies its solid
            if sign[turn[k]] > 0 > sign[turn[k - 1]]:
                half.append(around[turn[k]])
                twin.append(around[turn[k - 1]])
    return np.array(half, np.int64), np.array(twin, np.int64)
