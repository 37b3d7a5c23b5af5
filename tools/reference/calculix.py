# SPDX-License-Identifier: Apache-2.0
"""One elastic body under a load, solved by the program CalculiX (ccx 2.20; Debian: calculix-ccx).

Elements are C3D10, isotropic linear elastic. With large strain (NLGEOM) the material is neo-Hookean with the same E and nu at
small strain: W = C10 (I1' - 3) + (J - 1)^2 / D1, C10 = G / 2, D1 = 2 / K (CalculiX manual 6.8), G = E / (2 (1 + nu)),
K = E / (3 (1 - 2 nu)). Either nodes are moved by known ways, or a rigid frictionless tool of balls comes and its contact
area is found.
Units of a deck are mm, kPa and mN: CalculiX's tolerances suit numbers near one. Its x goes along the load, so that a moved
node needs no equation between its coordinates. Source: G. Dhondt, The Finite Element Method for Three-Dimensional
Thermomechanical Applications, Wiley 2004.

Contact of a ball is mortar contact (S. Sitzmann, K. Willner, B. Wohlmuth, Int. J. Numer. Meth. Engng 103 (2015) 60): pressure is
weighted over faces, not collected at nodes, so it holds on the quadratic faces of C3D10 and at large sliding. CalculiX keeps
the direction of a contact through a step, so a ball goes by a tenth of its radius at a time: at two radii deep, steps of a
fifth give 3 % more force, of a twentieth 1 % less.
"""
from dataclasses import dataclass, field

import numpy as np

import surface
from run import Code, Failure, Scratch, run_program

TIME_LIMIT_S = 4.0 * 3600.0  # chosen: a site with large strain takes about 25 min
MM, KPA, NEWTON = 1e3, 1e-3, 1e-3  # of m and of Pa; of mN
BALL_STIFFNESS = 5000.0  # of E / R: sinks in by 1e-4 of R and less
MAX_STEP, BALL_STEP = 0.2, 0.1  # of the way; of R
HALVINGS, BACK, INNER, MIDDLE = 3, -0.5, 0.8, 0.9  # of an octahedron: edges of 0.2 R; cosine beyond which nothing can touch
TET_FACES = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])  # S1 to S4, CalculiX manual 6.2


@dataclass
class Tool:
    """One rigid body of balls."""
    radius_m: np.ndarray  # (b,)
    centre_m: np.ndarray  # (b, 3), before it moves
    along_m: list[float]  # where it stops, rising
    face: np.ndarray  # (f, 6), that it may press


@dataclass
class Load:
    direction: np.ndarray  # (3,), unit
    moved: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=int))  # nodes, none of them held
    along_m: np.ndarray = field(default_factory=lambda: np.empty(0))  # how far each goes along the direction
    is_bonded: bool = False  # the moved nodes cannot move sideways; else they slide without friction
    large_strain: bool = False
    tool: Tool | None = None  # instead of moved nodes; needs large strain


@dataclass
class Answer:
    force_N: np.ndarray  # (3,), that moves the moved nodes, or the ball
    moved_force_N: np.ndarray  # (m, 3), of each moved node
    displacement_m: np.ndarray  # (N, 3), at the end; NaN where it was not asked for
    tool_N: np.ndarray | None = None  # (stops, b, 3), that moves each ball


def rows(first, table):
    """Numbered lines of a table of numbers, as "7,1.5,2,3"."""
    return "".join(f"{i},{','.join(map('{:.12g}'.format, row))}\n" for i, row in enumerate(table.tolist(), first))


def node_set(name, nodes):
    numbers = [str(n + 1) for n in nodes]  # a line takes at most 16
    return f"*NSET,NSET={name}\n" + "".join(",".join(numbers[i:i + 8]) + ",\n" for i in range(0, len(numbers), 8))


def rigid_ball():
    """A ball as a shell of quadratic wedges, its pole along +x: nodes (n, 3), of its radius, and C3D15 (w, 15).

    A wedge has inner corners, outer corners, middles of the inner edges, of the outer edges, of the spokes; its face 2 is the
    outer one, with six nodes on the sphere, so that it is round to 1e-4 of its radius and its normal turns smoothly.
    """
    point = np.vstack([np.eye(3), -np.eye(3)])
    triangle = np.array([[0, 1, 2], [0, 2, 4], [0, 4, 5], [0, 5, 1], [3, 2, 1], [3, 4, 2], [3, 5, 4], [3, 1, 5]])
    for _ in range(HALVINGS + 1):  # the last time only for the middles
        corners, key = triangle, surface.edges_of(triangle)[1]
        edges = np.unique(key)
        middles = surface.middle_of(edges, key, len(point))
        point = np.vstack([point, surface.unit(point[edges >> 32] + point[edges & 0xFFFFFFFF])])
        (a, b, c), (ab, bc, ca) = corners.T, middles.T
        triangle = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    seen = point[corners, 0].mean(axis=1) >= BACK
    corners, middles = corners[seen], middles[seen]
    used, number = np.unique(np.hstack([corners, middles]), return_inverse=True)
    corner, middle = number.reshape(-1, 6)[:, :3], number.reshape(-1, 6)[:, 3:]
    n = len(used)  # all nodes move by one vector: the inner layers only give the wedges their thickness
    wedge = np.hstack([corner, corner + n, middle, middle + n, corner + 2 * n])
    kept, wedge = np.unique(wedge, return_inverse=True)  # a middle has no spoke
    return np.vstack([INNER * point[used], point[used], MIDDLE * point[used]])[kept], wedge.reshape(-1, 15)


def tool_text(organ, body, tool, axes):
    node, wedge = rigid_ball()
    size, modulus_kPa = len(body.node_m), organ.youngs_modulus_Pa * KPA
    node_mm = (tool.radius_m[:, None, None] * node + (tool.centre_m @ axes.T)[:, None]) * MM
    number = size + 1 + len(node) * np.arange(len(node_mm))[:, None, None] + wedge
    lines = "".join(f"{i},{','.join(map(str, w[:12]))},\n{','.join(map(str, w[12:]))}\n"
                    for i, w in enumerate(number.reshape(-1, 15).tolist(), len(body.element) + 1))
    key, wanted = (np.sort(corners, axis=-1) @ [size**2, size, 1] for corners in (body.element[:, TET_FACES], tool.face[:, :3]))
    touched = "".join(f"{e + 1},S{f + 1}\n" for e, f in np.argwhere(np.isin(key, wanted)).tolist())
    # Every node of the tool is moved by the same way: its own stiffness does not matter.
    return (f"*NODE,NSET=TOOL\n{rows(size + 1, node_mm.reshape(-1, 3))}*ELEMENT,TYPE=C3D15,ELSET=TOOL\n{lines}"
            f"*MATERIAL,NAME=TOOL\n*ELASTIC\n{modulus_kPa:.12g},0.3\n*SOLID SECTION,ELSET=TOOL,MATERIAL=TOOL\n"
            f"*SURFACE,NAME=TOOL,TYPE=ELEMENT\nTOOL,S2\n*SURFACE,NAME=TOUCHED,TYPE=ELEMENT\n{touched}"
            "*SURFACE INTERACTION,NAME=SLIDES\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n"
            f"{BALL_STIFFNESS * modulus_kPa / (tool.radius_m.min() * MM):.12g}\n"
            "*CONTACT PAIR,INTERACTION=SLIDES,TYPE=MORTAR\nTOUCHED,TOOL\n")


def material_text(organ, large_strain):
    modulus_kPa, nu = organ.youngs_modulus_Pa * KPA, organ.poisson_ratio
    bulk_kPa = modulus_kPa / (3.0 * (1.0 - 2.0 * nu))
    law = (f"*HYPERELASTIC,NEO HOOKE\n{0.5 * organ.shear_modulus_Pa * KPA:.12g},{2.0 / bulk_kPa:.12g}\n" if large_strain
           else f"*ELASTIC\n{modulus_kPa:.12g},{nu:.12g}\n")
    return f"*MATERIAL,NAME=TISSUE\n{law}*SOLID SECTION,ELSET=BODY,MATERIAL=TISSUE\n"


def step_text(load, along_m, before_m, printed):
    """One step, to where all moved nodes or the tool stop."""
    text = f"*STEP{',NLGEOM,INC=1000' if load.large_strain else ''}\n*STATIC\n"
    if load.large_strain:
        way_m, only = along_m - before_m, not load.tool or len(load.tool.along_m) == 1
        largest = min(MAX_STEP if only else 1.0, BALL_STEP * load.tool.radius_m.min() / way_m if load.tool else 1.0)
        text += f"{0.5 * largest:.6g},1.,1e-5,{largest:.6g}\n"
    text += "*BOUNDARY\n"
    for node, node_along_m in zip(load.moved, load.along_m):
        text += f"{node + 1},1,1,{node_along_m * MM:.12g}\n" + (f"{node + 1},2,3\n" if load.is_bonded else "")
    return text + (f"TOOL,1,1,{along_m * MM:.12g}\nTOOL,2,3\n" if load.tool else "") + printed + "*END STEP\n"


def axes_of(load):
    """(3, 3): a vector v is axes @ v in the deck."""
    return np.stack([load.direction, *surface.across(load.direction)])


def deck_of(organ, body, load, reported):
    """Prints forces of the set FORCED (moved, or in contact) and displacements of REPORTED, at the end of each step."""
    axes = axes_of(load)
    sets = {"HELD": body.held, "FORCED": forced(load), "REPORTED": reported}
    printed = "".join(f"*NODE PRINT,NSET={name},FREQUENCY=1000\n{what}\n" for name, what in (("FORCED", "RF"), ("REPORTED", "U")))
    stops_m = load.tool.along_m if load.tool else [0.0]
    return (f"*NODE,NSET=ALL\n{rows(1, body.node_m @ axes.T * MM)}"
            f"*ELEMENT,TYPE=C3D10,ELSET=BODY\n{rows(1, body.element + 1)}" +
            "".join(node_set(name, nodes) for name, nodes in sets.items() if len(nodes)) +
            material_text(organ, load.large_strain) +
            (tool_text(organ, body, load.tool, axes) if load.tool else "") +
            ("*BOUNDARY\nHELD,1,3\n" if len(body.held) else "") +
            "".join(step_text(load, *ends_m, printed) for ends_m in zip(stops_m, [0.0, *stops_m])))


def forced_by(tool):
    return np.unique(tool.face)


def forced(load):
    return forced_by(load.tool) if load.tool else load.moved


def read_vectors(text, heading, nodes, size):
    """(steps, N, 3), NaN but for the nodes asked for, from the lines "node x y z" below each heading."""
    parts = text.split(heading)[1:]
    out = np.full((len(parts), size, 3), np.nan)
    for one, part in zip(out, parts):
        table = np.array(part.split("\n\n")[1].split(), dtype=float).reshape(-1, 4)
        one[table[:, 0].astype(int) - 1] = table[:, 1:]
    if not len(parts) or not np.isfinite(out[:, nodes]).all():
        raise ValueError
    return out


def tool_force_N(body, tool, force_N, moved_m, direction):
    """(stops, b, 3): the force on a node is that of the ball nearest to it."""
    out = np.zeros((len(force_N), len(tool.radius_m), 3))
    for stop, along_m in enumerate(tool.along_m):
        off_m = (body.node_m + moved_m[stop])[forced_by(tool), None] - tool.centre_m - along_m * direction
        nearest = (np.linalg.norm(off_m, axis=2) - tool.radius_m).argmin(axis=1)
        np.add.at(out[stop], nearest, force_N[stop])
    return out


def read_answer(text, body, load, reported):
    size, axes, nodes = len(body.node_m), axes_of(load), forced(load)
    force_N = read_vectors(text, "forces (fx,fy,fz) for set FORCED ", nodes, size)[:, nodes] @ axes * NEWTON
    moved_m = read_vectors(text, "displacements (vx,vy,vz) for set REPORTED ", reported, size) @ axes / MM
    tool_N = tool_force_N(body, load.tool, force_N, moved_m, load.direction) if load.tool else None
    return Answer(force_N[-1].sum(axis=0), force_N[-1], moved_m[-1], tool_N)


def solve(organ, body, load, reported):
    """On one core. A Failure has NO_SOLUTION if CalculiX ran and gave up; folder with deck and log stay."""
    no_solution = "CalculiX found no solution"
    with Scratch("tact-ccx") as scratch:
        (scratch.path / "case.inp").write_text(deck_of(organ, body, load, reported))
        try:
            run_program(["ccx", "-i", "case"], scratch, "calculix-ccx", TIME_LIMIT_S)
            return read_answer((scratch.path / "case.dat").read_text(), body, load, reported)
        except Failure as failure:
            if failure.code != Code.PROGRAM_ENDED:
                raise
            raise Failure(f"{no_solution}: {failure.message}", Code.NO_SOLUTION) from None
        except (OSError, ValueError, IndexError):
            scratch.keep()
            raise Failure(f"{no_solution}; its deck case.inp and ccx.log are in {scratch.path}", Code.NO_SOLUTION) from None


def version():
    """ "2.20", of the ccx in PATH."""
    with Scratch("tact-ccx") as scratch:
        text = run_program(["ccx", "-v"], scratch, "calculix-ccx", 60.0, any_status=True)  # ends with 201
        return text.split()[-1] if text.split() else ""
