# SPDX-License-Identifier: Apache-2.0
"""An organ, and its body around one site: refined surface, quadratic tetrahedra by the program gmsh, what is held.

Lengths in m, frame of the mesh file. Elements have ten nodes (CalculiX C3D10): corners, then the middles of EDGES; faces six:
corners, then the middles of edges 01, 12, 20.
"""
from dataclasses import dataclass, replace

import numpy as np

import surface
from run import Code, Failure, Scratch, run_program

EDGES = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
MM = 1e3  # gmsh works in mm: its tolerances suit numbers near one
TIME_LIMIT_S = 1800.0


@dataclass
class Lump:
    """A ball of the same material with another modulus; a Gauss point lies in it or not."""
    center_m: np.ndarray  # (3,)
    radius_m: float
    modulus_ratio: float  # to the organ's


@dataclass
class Organ:
    """Everything that does not depend on the site."""
    vertex_m: np.ndarray  # (V, 3)
    triangle: np.ndarray  # (T, 3)
    vertex_normal: np.ndarray  # (V, 3), outward, unit
    held_min_m: np.ndarray  # (3,): triangles with all corners in this box are held
    held_max_m: np.ndarray
    youngs_modulus_Pa: float
    poisson_ratio: float
    mesh: str = ""  # file name
    mesh_hash: str = ""  # 16 hex digits
    size_ratio: float = 1.0  # of the edges far inside: 1 suits a body as large as a hand
    lumps: tuple[Lump, ...] = ()  # the last that has a point counts

    @property
    def shear_modulus_Pa(self):
        return self.youngs_modulus_Pa / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def contact_modulus_Pa(self):
        """E* = E / (1 - nu^2), of a half-space under a frictionless tool."""
        return self.youngs_modulus_Pa / (1.0 - self.poisson_ratio**2)

    def held(self, point_m):
        """Which of the points (..., 3) lie in the box, its sides included."""
        return ((point_m >= self.held_min_m) & (point_m <= self.held_max_m)).all(axis=-1)


@dataclass
class Body:
    node_m: np.ndarray  # (N, 3)
    element: np.ndarray  # (E, 10)
    face: np.ndarray  # (F, 6), of the refined surface
    normal: np.ndarray  # (F, 3), outward, unit
    held: np.ndarray  # nodes, ascending

    def within(self, circle):
        """Faces (F,) whose centre is within the circle's radius of its axis and two of its middle, and that look against it."""
        centre_m = self.node_m[self.face[:, :3]].mean(axis=1)
        is_near = circle.away_m(centre_m) <= circle.radius_m
        is_beside = np.abs((centre_m - circle.at_m) @ circle.axis) < 2.0 * circle.radius_m
        return is_near & is_beside & (self.normal @ circle.axis < -surface.FACING)


def gmsh_version():
    with Scratch("tact-gmsh") as scratch:
        return run_program(["gmsh", "--version"], scratch, "gmsh", 60.0).strip()


def size_text(lengths):
    """EdgeLengths.at in mm as gmsh's MathEval reads it."""
    squares = ["((x - ({}))^2 + (y - ({}))^2 + (z - ({}))^2)".format(*map(float, at)) for at in lengths.at_m * MM]
    radius_mm = lengths.radius_m * MM
    if lengths.axis is None:
        nearest = squares[0]
        for square in squares[1:]:
            nearest = f"Min({nearest}, {square})"
        away = f"Max(0, Sqrt({nearest}) - {radius_mm})"
    else:
        height = "(" + " + ".join(f"({float(a)}) * ({x} - ({float(o)}))"
                                  for a, x, o in zip(lengths.axis, "xyz", lengths.at_m[0] * MM)) + ")"
        away = f"Sqrt((Sqrt(Max(0, {squares[0]} - {height}^2)) - {radius_mm})^2 + {height}^2)"
    return f"Min({min(lengths.largest_m * MM, 1e9)}, {lengths.fine_m * MM} + {lengths.growth} * {away})"


def size_fields(lengths):
    """gmsh's commands for the background field: the least of all, each of four places, as gmsh bounds the length of a text."""
    parts = [replace(lengths, at_m=lengths.at_m[i:i + 4]) for i in range(0, len(lengths.at_m), 4)]
    fields = "".join(f'Field[{i}] = MathEval;\nField[{i}].F = "{size_text(part)}";\n' for i, part in enumerate(parts, 1))
    if len(parts) == 1:
        return fields + "Background Field = 1;\n"
    least, all_of = len(parts) + 1, ", ".join(str(i) for i in range(1, len(parts) + 1))
    return f"{fields}Field[{least}] = Min;\nField[{least}].FieldsList = {{{all_of}}};\nBackground Field = {least};\n"


def read_mesh(text, vertex_m):
    """Nodes (N, 3), m, and the corners (E, 4) of tetrahedra of a file of gmsh 2.2; the first nodes are the vertices."""
    nodes = np.array(text.split("$Nodes")[1].split("$EndNodes")[0].split()[1:], dtype=float).reshape(-1, 4)
    lines = text.split("$Elements")[1].split("$EndElements")[0].split("\n")
    corners = np.array([line.split()[-4:] for line in lines if line.split(maxsplit=2)[1:2] == ["4"]], dtype=np.int64)
    number, node_m = nodes[:, 0].astype(np.int64), nodes[:, 1:] / MM
    same = len(node_m) >= len(vertex_m) and np.abs(node_m[:len(vertex_m)] - vertex_m).max() < 1e-9
    if not same or len(corners) == 0 or (number[:len(vertex_m)] != np.arange(1, len(vertex_m) + 1)).any():
        raise ValueError
    node_m[:len(vertex_m)] = vertex_m
    place = np.zeros(number.max() + 1, dtype=np.int64)  # gmsh's numbers may have gaps
    place[number] = np.arange(len(number))
    return node_m, place[corners]


def fill(vertex_m, triangle, lengths):
    """Nodes (N, 3), m, and corners (E, 4) of tetrahedra; the surface stays as it is: its triangles are faces of elements.

    Source: C. Geuzaine, J.-F. Remacle, Int. J. Numer. Meth. Eng. 79 (2009) 1309.
    """
    with Scratch("tact-gmsh") as scratch:
        nodes = "\n".join(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate((vertex_m * MM).tolist(), 1))
        elements = "\n".join(f"{i} 2 2 1 1 {a} {b} {c}" for i, (a, b, c) in enumerate((triangle + 1).tolist(), 1))
        (scratch.path / "surface.msh").write_text(
            f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(vertex_m)}\n{nodes}\n$EndNodes\n"
            f"$Elements\n{len(triangle)}\n{elements}\n$EndElements\n")
        (scratch.path / "fill.geo").write_text(
            'Merge "surface.msh";\nSurface Loop(1) = {1};\nVolume(1) = {1};\n'
            f"{size_fields(lengths)}"
            "Mesh.CharacteristicLengthExtendFromBoundary = 0;\nMesh.CharacteristicLengthFromPoints = 0;\n"
            "Mesh.Algorithm3D = 1;\nMesh.Optimize = 1;\nMesh.MshFileVersion = 2.2;\nMesh.Binary = 0;\nMesh.SaveAll = 1;\n")
        run_program(["gmsh", "fill.geo", "-3", "-nt", "1", "-format", "msh2", "-o", "body.msh"], scratch, "gmsh", TIME_LIMIT_S)
        try:
            return read_mesh((scratch.path / "body.msh").read_text(), vertex_m)
        except (OSError, ValueError, IndexError):
            scratch.keep()
            raise Failure(f"gmsh could not fill the surface; see {scratch.path}/gmsh.log, and ask tact-mesh whether the surface "
                          "is closed and does not cross itself", Code.OTHER) from None


def with_middles(node_m, corners, triangle):
    """Nodes (N, 3), elements (E, 10) and faces (F, 6), with a node in the middle of every edge."""
    a, b, c = (node_m[corners[:, [1, 2, 3]]] - node_m[corners[:, :1]]).transpose(1, 0, 2)
    inside_out = np.einsum("ei,ei->e", a, np.cross(b, c)) < 0.0
    corners[inside_out] = corners[inside_out][:, [0, 2, 1, 3]]
    ends = np.sort(corners[:, EDGES], axis=2)
    edges = ends[..., 0] << 32 | ends[..., 1]
    key = surface.as_met(edges, edges)
    element = np.hstack([corners, surface.middle_of(key, edges, len(node_m))])
    middles = surface.middle_of(key, surface.edges_of(triangle)[1], len(node_m))
    if (middles < 0).any():  # every triangle of the surface has to be a face of an element, or its six nodes are not known
        raise Failure("gmsh changed the surface; ask tact-mesh whether it crosses itself")
    node_m = np.vstack([node_m, 0.5 * (node_m[key >> 32] + node_m[key & 0xFFFFFFFF])])
    return node_m, element, np.hstack([triangle, middles])


def make_body(organ, lengths, circle=None):
    """Refines the surface, draws the circle on it, fills it and finds what is held; lengths.largest_m counts inside only."""
    lengths_of_surface = surface.EdgeLengths(lengths.at_m, lengths.radius_m, lengths.fine_m, lengths.growth, axis=lengths.axis)
    vertex_m, triangle = surface.refine(organ.vertex_m, organ.triangle, lengths_of_surface)
    if circle is not None:  # edges along the rim: there the stress ends, or is singular
        vertex_m, triangle = surface.cut_along(vertex_m, triangle, circle, 2.0 * circle.radius_m)
    node_m, element, face = with_middles(*fill(vertex_m, triangle, lengths), triangle)
    # A finer triangle may be held where its parent is not: the box is meant well away from the site.
    held = np.unique(face[organ.held(node_m[face[:, :3]]).all(axis=1)])
    if len(held) == 0:
        raise Failure("no triangle of the organ lies in the held box, so it would fly away; move elastic.fixed_min_m and "
                      "elastic.fixed_max_m (tact-mesh --align proposes them)")
    a, b, c = node_m[face[:, :3]].transpose(1, 0, 2)
    return Body(node_m, element, face, surface.unit(np.cross(b - a, c - a)), held)
