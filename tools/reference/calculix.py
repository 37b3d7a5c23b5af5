# SPDX-License-Identifier: Apache-2.0
"""One elastic body under a load, solved by the program CalculiX (ccx 2.20; Debian: calculix-ccx).

Elements are C3D10, isotropic linear elastic. With large strain (NLGEOM) the material is neo-Hookean with the same E and nu at
small strain: W = C10 (I1' - 3) + (J - 1)^2 / D1, C10 = G / 2, D1 = 2 / K (CalculiX manual 6.8), G = E / (2 (1 + nu)),
K = E / (3 (1 - 2 nu)). Either nodes are moved by known ways, or a rigid frictionless ball comes and its contact area is found.
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
class Ball:
    radius_m: float
    centre_m: np.ndarray  # (3,), before it moves
    along_m: float
    corners: np.ndarray  # (f, 3), of the faces that it may touch


@dataclass
class Load:
    direction: np.ndarray  # (3,), unit
    moved: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=int))  # nodes, none of them held
    along_m: np.ndarray = field(default_factory=lambda: np.empty(0))  # how far each goes along the direction
    is_bonded: bool = False  # the moved nodes cannot move sideways; else they slide without friction
    large_strain: bool = False
    ball: Ball | None = None  # instead of moved nodes; needs large strain


@dataclass
class Answer:
    force_N: np.ndarray  # (3,), that moves the moved nodes, or the ball
    moved_force_N: np.ndarray  # (m, 3), of each moved node
    displacement_m: np.ndarray  # (N, 3); NaN where it was not asked for


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


def ball_text(organ, body, ball, axes):
    node, wedge = rigid_ball()
    first_node, modulus_kPa = len(body.node_m), organ.youngs_modulus_Pa * KPA
    node_mm = ((node * ball.radius_m) + axes @ ball.centre_m) * MM
    number = wedge + first_node + 1
    lines = "".join(f"{i},{','.join(map(str, w[:12]))},\n{','.join(map(str, w[12:]))}\n"
                    for i, w in enumerate(number.tolist(), len(body.element) + 1))
    size = len(body.node_m)
    key, wanted = (np.sort(corners, axis=-1) @ [size**2, size, 1] for corners in (body.element[:, TET_FACES], ball.corners))
    touched = "".join(f"{e + 1},S{f + 1}\n" for e, f in np.argwhere(np.isin(key, wanted)).tolist())
    # Every node of the ball is moved by the same way: its own stiffness does not matter.
    return (f"*NODE,NSET=BALL\n{rows(first_node + 1, node_mm)}*ELEMENT,TYPE=C3D15,ELSET=BALL\n{lines}"
            f"*MATERIAL,NAME=BALL\n*ELASTIC\n{modulus_kPa:.12g},0.3\n*SOLID SECTION,ELSET=BALL,MATERIAL=BALL\n"
            f"*SURFACE,NAME=BALL,TYPE=ELEMENT\nBALL,S2\n*SURFACE,NAME=TOUCHED,TYPE=ELEMENT\n{touched}"
            "*SURFACE INTERACTION,NAME=SLIDES\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n"
            f"{BALL_STIFFNESS * modulus_kPa / (ball.radius_m * MM):.12g}\n"
            "*CONTACT PAIR,INTERACTION=SLIDES,TYPE=MORTAR\nTOUCHED,BALL\n")


def material_text(organ, large_strain):
    modulus_kPa, nu = organ.youngs_modulus_Pa * KPA, organ.poisson_ratio
    bulk_kPa = modulus_kPa / (3.0 * (1.0 - 2.0 * nu))
    law = (f"*HYPERELASTIC,NEO HOOKE\n{0.5 * organ.shear_modulus_Pa * KPA:.12g},{2.0 / bulk_kPa:.12g}\n" if large_strain
           else f"*ELASTIC\n{modulus_kPa:.12g},{nu:.12g}\n")
    return f"*MATERIAL,NAME=TISSUE\n{law}*SOLID SECTION,ELSET=BODY,MATERIAL=TISSUE\n"


def step_text(load):
    text = f"*STEP{',NLGEOM,INC=1000' if load.large_strain else ''}\n*STATIC\n"
    if load.large_strain:
        largest = min(MAX_STEP, BALL_STEP * load.ball.radius_m / load.ball.along_m) if load.ball else MAX_STEP
        text += f"{0.5 * largest:.6g},1.,1e-5,{largest:.6g}\n"
    text += "*BOUNDARY\n"
    for node, along_m in zip(load.moved, load.along_m):
        text += f"{node + 1},1,1,{along_m * MM:.12g}\n" + (f"{node + 1},2,3\n" if load.is_bonded else "")
    if load.ball:
        text += f"BALL,1,1,{load.ball.along_m * MM:.12g}\nBALL,2,3\n"
    return text


def axes_of(load):
    """(3, 3): a vector v is axes @ v in the deck."""
    return np.stack([load.direction, *surface.across(load.direction)])


def deck_of(organ, body, load, reported):
    """Prints forces of the set MOVED (with a ball: HELD) and displacements of the set REPORTED, at the end of the way."""
    axes = axes_of(load)
    sets = {"HELD": body.held, "MOVED": load.moved, "REPORTED": reported}
    return (f"*NODE,NSET=ALL\n{rows(1, body.node_m @ axes.T * MM)}"
            f"*ELEMENT,TYPE=C3D10,ELSET=BODY\n{rows(1, body.element + 1)}" +
            "".join(node_set(name, nodes) for name, nodes in sets.items() if len(nodes)) +
            material_text(organ, load.large_strain) +
            (ball_text(organ, body, load.ball, axes) if load.ball else "") +
            ("*BOUNDARY\nHELD,1,3\n" if len(body.held) else "") + step_text(load) +
            f"*NODE PRINT,NSET={'HELD' if load.ball else 'MOVED'},FREQUENCY=1000\nRF\n"
            "*NODE PRINT,NSET=REPORTED,FREQUENCY=1000\nU\n*END STEP\n")


def read_vectors(text, heading, nodes, size):
    """(N, 3), NaN but for the nodes asked for, from the lines "node x y z" below a heading."""
    lines = text.split(heading)[1].split("\n\n")[1]
    table = np.array(lines.split(), dtype=float).reshape(-1, 4)
    out = np.full((size, 3), np.nan)
    out[table[:, 0].astype(int) - 1] = table[:, 1:]
    if not np.isfinite(out[nodes]).all():
        raise ValueError
    return out


def read_answer(text, body, load, reported):
    size, axes = len(body.node_m), axes_of(load)
    name, nodes = ("HELD", body.held) if load.ball else ("MOVED", load.moved)
    force_N = read_vectors(text, f"forces (fx,fy,fz) for set {name} ", nodes, size)[nodes] @ axes * NEWTON
    moved_m = read_vectors(text, "displacements (vx,vy,vz) for set REPORTED ", reported, size) @ axes / MM
    # What is held keeps the body from following the ball.
    return Answer(force_N.sum(axis=0) * (-1.0 if load.ball else 1.0), force_N, moved_m)


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
