# SPDX-License-Identifier: Apache-2.0
"""From what a scanner gives to a surface that tact can press: the steps, in the order in which each helps the next."""
import functools

import numpy as np
import vtk
from vtk.util import numpy_support

import sheets
from holes import closed
from surface_file import Refused, to_numpy, to_vtk

NEAR_RATIO = 1e-5   # of the surface's size: vertices so near are one, with --weld
FLAT_RATIO = 1e-8   # doubled area over the square of the longest side: below it a face has no area
FOLD_COSINE = -0.9  # between the normals of two neighbours
MOST_UNFOLDINGS = 10
MOST_NESTED = 20            # parts that are looked at, those with most faces
LEAST_NESTED_RATIO = 0.002  # of the volume of the largest: less is noise of a segmentation
LEAST_KEPT_RATIO = 0.8  # of the faces that were asked for: more loss takes the shape away


def repair(points, triangles, asked, report):
    """`asked` has a member for each option. Reports what each step did; gives points and triangles."""
    def report_step(step, count, text):
        if len(triangles) == 0:
            raise Refused(f"{asked.source}: no face is left after {step}; look at the mesh in a mesh editor")
        report(step=step, count=int(count), text=text, faces=len(triangles), vertices=len(points))

    def watched(step, work):
        percent = -10

        def note(caller, _):
            nonlocal percent
            if 100 * caller.GetProgress() >= percent + 10:
                percent = int(100 * caller.GetProgress())
                report(step=step, percent=percent)
        work.AddObserver("ProgressEvent", note)
        work.Update()
        return to_numpy(work.GetOutput())

    report_step("read", len(triangles), f"{len(triangles)} faces, {len(points)} vertices")
    centre = (points.max(0) + points.min(0)) / 2  # a scanner's origin lies far away; the digits are for the shape
    points = points - centre
    vertices, faces = len(points), len(triangles)
    size = np.linalg.norm(points.max(0) - points.min(0))
    points, triangles = watched("weld", welding(points, triangles, NEAR_RATIO * size if asked.weld else 0.0))
    report_step("weld", vertices - len(points),
                f"{vertices - len(points)} vertices joined, {faces - len(triangles)} faces vanished")
    if asked.drop_degenerate:
        faces = len(triangles)
        points, triangles = without_degenerate(points, triangles)
        report_step("drop-degenerate", faces - len(triangles), f"{faces - len(triangles)} faces dropped")
    triangles, turned = sheets.consistent(points, triangles)
    report_step("turn", turned, f"{turned} faces turned like their neighbours")
    faces = len(triangles)
    points, triangles, crowded = sheets.parted(points, triangles)
    report_step("part", crowded, f"{crowded} edges with more than two faces, {faces - len(triangles)} faces dropped there")
    faces, parts = len(triangles), len(part_faces(points, triangles))
    if asked.largest:
        nested = nested_ratios(points, triangles)
        if nested and asked.hollow_refused:
            raise Refused(f"{asked.source}: inside of the largest part lies one of {nested[0]:.0%} of its volume: a cavity, "
                          "which would be filled, or an organ of its own; "
                          "a full organ: tact-mesh ORGAN --weld --largest --out full.obj")
        points, triangles = largest(points, triangles)
        inside = f"; inside of it {shares}, now filled" if (shares := ", ".join(f"{ratio:.0%}" for ratio in nested)) else ""
        report_step("largest", parts - 1, f"{parts - 1} of {parts} parts dropped, {faces - len(triangles)} faces{inside}")
    if asked.close_holes:
        points, triangles, holes, added = closed(points, triangles)
        report_step("close-holes", holes, f"{holes} holes closed with {added} faces")
    if asked.smooth:
        before = points
        points = watched("smooth", smoothing(points, triangles))[0]
        report_step("smooth", len(points),
                    f"vertices moved by {np.linalg.norm(points - before, axis=1).mean():.2g} units in the mean")
    if asked.decimate is not None and asked.decimate < len(triangles):
        faces, had_rims = len(triangles), len(sheets.Edges(triangles).single()) > 0
        points, triangles = used(*watched("decimate", decimation(points, triangles, asked.decimate)))
        points, triangles = unfolded(points, triangles, had_rims)
        if len(triangles) < LEAST_KEPT_RATIO * asked.decimate:
            raise Refused(f"{asked.source}: too rough for {asked.decimate} faces, {len(triangles)} would be left without a fold; "
                          "ask for more, or smooth it more in a mesh editor")
        report_step("decimate", faces - len(triangles), f"{faces} faces became {len(triangles)}")
    if volume(points, triangles) < 0:
        triangles = triangles[:, ::-1]
    return points + centre, triangles


def volume(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def used(points, triangles):
    """Without the points that no triangle names."""
    names, corners = np.unique(triangles, return_inverse=True)
    return points[names], corners.reshape(-1, 3)


def welding(points, triangles, distance):
    weld = vtk.vtkCleanPolyData()  # also drops faces that have a vertex twice then
    weld.SetInputData(to_vtk(points, triangles))
    weld.ToleranceIsAbsoluteOn()
    weld.SetAbsoluteTolerance(distance)
    weld.ConvertLinesToPointsOff()
    weld.ConvertPolysToLinesOff()
    return weld


def without_degenerate(points, triangles):
    """Without faces that have no area, and of faces with the same corners: one if more run its way, none if they cancel."""
    sides = [np.linalg.norm(points[triangles[:, k]] - points[triangles[:, k - 1]], axis=1) for k in range(3)]
    area = np.linalg.norm(sheets.doubled_areas(points, triangles), axis=1)
    triangles = triangles[area > FLAT_RATIO * np.max(sides, axis=0)**2]
    if len(triangles) == 0:
        return points, triangles
    low, middle, high = np.sort(triangles, axis=1).T
    pair = np.unique(low * len(points) + middle, return_inverse=True)[1]
    group = np.unique(pair * len(points) + high, return_inverse=True)[1]
    first = np.argmin(triangles, axis=1)
    rows = np.arange(len(triangles))
    forwards = triangles[rows, (first + 1) % 3] < triangles[rows, (first + 2) % 3]
    surplus = np.bincount(group, np.where(forwards, 1, -1))[group]
    wanted = np.flatnonzero(np.where(forwards, surplus, -surplus) > 0)
    kept = wanted[np.unique(group[wanted], return_index=True)[1]]
    return used(points, triangles[np.sort(kept)])


def connectivity(points, triangles):
    parts = vtk.vtkPolyDataConnectivityFilter()
    parts.SetInputData(to_vtk(points, triangles))
    return parts


def part_faces(points, triangles):
    """How many faces each part has."""
    parts = connectivity(points, triangles)
    parts.SetExtractionModeToAllRegions()
    parts.Update()
    sizes = parts.GetRegionSizes()
    return [sizes.GetValue(k) for k in range(parts.GetNumberOfExtractedRegions())]


def largest(points, triangles):
    """The part with most faces."""
    parts = connectivity(points, triangles)
    parts.SetExtractionModeToLargestRegion()
    parts.Update()
    return used(*to_numpy(parts.GetOutput()))


def nested_ratios(points, triangles):
    """Of each closed part inside of the largest, its volume over that one's, if it is more than noise."""
    parts = connectivity(points, triangles)
    parts.SetExtractionModeToAllRegions()
    parts.ColorRegionsOn()
    parts.Update()
    points, triangles = to_numpy(parts.GetOutput())
    region = numpy_support.vtk_to_numpy(parts.GetOutput().GetPointData().GetArray("RegionId"))[triangles[:, 0]]
    faces = np.bincount(region)
    outer = triangles[region == np.argmax(faces)]
    whole = abs(volume(points, outer))
    ratios = []
    for part in (triangles[region == k] for k in np.argsort(-faces)[1:1 + MOST_NESTED]):
        ratio = abs(volume(points, part)) / max(whole, 1e-300)
        closed_one = LEAST_NESTED_RATIO < ratio < 1 and len(sheets.Edges(part).single()) == 0
        if closed_one and is_inside(points, outer, points[part[0, 0]]):
            ratios.append(ratio)
    return sorted(ratios, reverse=True)


def is_inside(points, triangles, place):
    """By the solid angle of the surface, seen from there [van Oosterom, Strackee, IEEE T-BME 30 (1983) 125]."""
    a, b, c = (points[triangles[:, k]] - place for k in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    dot = functools.partial(np.einsum, "ij,ij->i")
    under = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return abs(np.arctan2(dot(a, np.cross(b, c)), under).sum()) > np.pi


def smoothing(points, triangles):
    """Taubin's filter, which keeps the volume: takes the steps of voxels away, and leaves rims where they are."""
    smooth = vtk.vtkWindowedSincPolyDataFilter()
    smooth.SetInputData(to_vtk(points, triangles))
    smooth.SetNumberOfIterations(20)
    smooth.SetPassBand(0.1)
    smooth.BoundarySmoothingOff()
    smooth.FeatureEdgeSmoothingOff()
    smooth.NormalizeCoordinatesOn()
    return smooth


def decimation(points, triangles, faces):
    fewer = vtk.vtkQuadricDecimation()
    fewer.SetInputData(to_vtk(points, triangles))
    fewer.SetTargetReduction(1 - faces / len(triangles))
    fewer.VolumePreservationOn()
    return fewer


def unfolded(points, triangles, had_rims):
    """Where decimation has left a crowded edge, a fold or a hole, the faces around it go and the hole is closed.

    A surface that had rims before loses crowded faces alone: its own holes stay.
    """
    if had_rims:
        return sheets.parted(points, triangles)[:2]
    for _ in range(MOST_UNFOLDINGS):
        bad = np.union1d(sheets.bad_faces(triangles), folded_faces(points, triangles))
        if len(bad) == 0 and len(sheets.Edges(triangles).single()) == 0:
            break
        around = np.isin(triangles, triangles[bad]).any(1)
        points, triangles, _ = sheets.parted(points, triangles[~around])
        points, triangles = used(*closed(points, triangles)[:2])
    return points, triangles


def folded_faces(points, triangles):
    normal = sheets.doubled_areas(points, triangles)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    one, other = sheets.Edges(triangles).pairs()
    fold = np.einsum("ij,ij->i", normal[one // 3], normal[other // 3]) < FOLD_COSINE
    return np.concatenate((one[fold], other[fold])) // 3
