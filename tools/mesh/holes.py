# SPDX-License-Identifier: Apache-2.0
"""Holes closed. The surface has no crowded edge and no vertex where two sheets meet, so each rim is one ring."""
import numpy as np
import vtk

from sheets import Edges


def closed(points, triangles):
    """Points, triangles, how many holes there were and how many faces close them."""
    edges = Edges(triangles)
    rim = edges.single()
    onward = dict(zip(edges.end[rim].tolist(), edges.start[rim].tolist()))  # the new faces run the other way
    known = set(zip(np.minimum(edges.start, edges.end).tolist(), np.maximum(edges.start, edges.end).tolist()))
    hubs, added, holes = [], [], 0
    while onward:
        ring = [next(iter(onward))]
        while (following := onward.pop(ring[-1])) != ring[0]:
            ring.append(following)
        faces = cut_ring(points, ring, known)
        if faces is None:  # a ring that crosses itself: a fan around a vertex in its middle
            hub = len(points) + len(hubs)
            hubs.append(points[ring].mean(0))
            faces = [(a, b, hub) for a, b in zip(ring, ring[1:] + ring[:1])]
        added += faces
        known.update((min(side), max(side)) for face in faces for side in sides(face))
        holes += 1
    if holes:
        points = np.concatenate((points, np.array(hubs).reshape(-1, 3)))
        triangles = np.concatenate((triangles, np.array(added)))
    return points, triangles, holes, len(added)


def sides(face):
    return zip(face, face[1:] + face[:1])


def cut_ring(points, ring, known):
    """The ring cut into triangles that run as it does; None where that fails, or needs an edge that exists."""
    polygon = vtk.vtkPolygon()
    polygon.GetPoints().SetDataTypeToDouble()
    polygon.GetPoints().SetNumberOfPoints(len(ring))
    polygon.GetPointIds().SetNumberOfIds(len(ring))
    for k, vertex in enumerate(ring):
        polygon.GetPoints().SetPoint(k, points[vertex])
        polygon.GetPointIds().SetId(k, k)
    ids = vtk.vtkIdList()
    if not polygon.Triangulate(ids) or ids.GetNumberOfIds() != 3 * (len(ring) - 2):
        return None
    corners = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
    faces = [tuple(corners[k:k + 3]) for k in range(0, len(corners), 3)]
    rim = {(k, (k + 1) % len(ring)) for k in range(len(ring))}
    if not rim <= {side for face in faces for side in sides(face)}:
        faces = [face[::-1] for face in faces]
    found = [side for face in faces for side in sides(face)]
    inner = {(min(ring[a], ring[b]), max(ring[a], ring[b])) for a, b in found if (a, b) not in rim}
    if not rim <= set(found) or len(set(found)) != len(found) or inner & known:
        return None
    return [tuple(ring[k] for k in face) for face in faces]
