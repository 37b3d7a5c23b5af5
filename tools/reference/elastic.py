# SPDX-License-Identifier: Apache-2.0
"""What many loads do to an isotropic linear elastic body of quadratic tetrahedra with straight edges.

    K_ai,bj = integral of  lambda N_a,i N_b,j + mu (N_a,j N_b,i + delta_ij N_a,k N_b,k)  dV
    lambda  = E nu / ((1 + nu)(1 - 2 nu)),   mu = G = E / (2 (1 + nu))

E Young's modulus, Pa; nu Poisson ratio; N_a shape function of node a. Four Gauss points an element are exact [Zienkiewicz,
Taylor, The Finite Element Method, 5th ed., vol. 1, 8.8 and table 8.3].

compliance() eliminates by nested dissection: a part of the body is two parts and the nodes that both have, and when these are
solved for, what is left is a dense matrix of its outer nodes and of the loads, which the next larger part takes over (the
multifrontal method: A. George, SIAM J. Numer. Anal. 10 (1973) 345; I. Duff, J. Reid, ACM Trans. Math. Softw. 9 (1983) 302).
The loads are rows beside the stiffness, so that nothing is kept for a substitution.
"""
import numpy as np
import scipy.linalg
import scipy.sparse

from body import EDGES
from run import Failure

CHUNK = 4000  # elements at a time: their stiffness is 30 x 30
LEAF = 60  # elements of a part that is not divided


def gradients(corner):
    """dN_a / dL_i, (10, 3), at the barycentric point L (4,), where L_0 = 1 - L_1 - L_2 - L_3."""
    dl = np.array([[-1, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    p, q = EDGES.T  # N_a = L_a (2 L_a - 1) at a corner, 4 L_p L_q in the middle of the edge p q
    return np.vstack([(4.0 * corner - 1.0)[:, None] * dl, 4.0 * (corner[p, None] * dl[q] + corner[q, None] * dl[p])])


def modulus_ratio(lumps, at_m):
    """Of the points (n, 3)."""
    ratio = np.ones(len(at_m))
    for lump in lumps:
        ratio[np.linalg.norm(at_m - lump.center_m, axis=1) <= lump.radius_m] = lump.modulus_ratio
    return ratio


def element_stiffness(corner_m, lame_Pa, shear_Pa, lumps=()):
    """(e, 30, 30), N/m, row 3 a + i, of elements by their corners (e, 4, 3)."""
    edge_m = corner_m[:, 1:] - corner_m[:, :1]  # dx_i / dL_j, transposed
    volume_m3 = np.linalg.det(edge_m) / 24.0  # of a Gauss point
    if not (volume_m3 > 0.0).all():
        raise Failure("finite elements: an element is inside out or flat; ask for another mesh level")
    to_m = np.linalg.inv(edge_m)
    k = np.zeros((len(corner_m), 10, 3, 10, 3))
    near = (5.0 - 5.0**0.5) / 20.0
    for point in np.full((4, 4), near) + np.eye(4) * (1.0 - 4.0 * near):
        g = np.einsum("aj,eij->eai", gradients(point), to_m)
        weight_m3 = volume_m3 * modulus_ratio(lumps, point @ corner_m) if lumps else volume_m3
        both = np.einsum("e,eai,ebj->eaibj", weight_m3, g, g)
        k += lame_Pa * both + shear_Pa * both.transpose(0, 1, 4, 3, 2)
        dots = shear_Pa * np.einsum("eakbk->eab", both)
        for i in range(3):
            k[:, :, i, :, i] += dots
    return k.reshape(-1, 30, 30)


def stiffness(organ, body):
    """K of all nodes, (3 N, 3 N), sparse."""
    nu = organ.poisson_ratio
    lame_Pa = organ.youngs_modulus_Pa * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    size = 3 * len(body.node_m)
    total = scipy.sparse.csr_matrix((size, size))
    for first in range(0, len(body.element), CHUNK):
        element = body.element[first:first + CHUNK]
        row = (3 * element[:, :, None] + np.arange(3)).reshape(-1, 30, 1)
        row, column = np.broadcast_arrays(row, row.transpose(0, 2, 1))
        k = element_stiffness(body.node_m[element[:, :4]], lame_Pa, organ.shear_modulus_Pa, organ.lumps)
        total += scipy.sparse.coo_matrix((k.ravel(), (row.ravel(), column.ravel())), (size, size)).tocsr()
    return total


def part_of_nodes(body, depth):
    """The least part (N,) that has all elements of a node: 1 is the whole, 2 p and 2 p + 1 are the halves of p."""
    centre_m, parts = body.node_m[body.element[:, :4]].mean(axis=1), [np.arange(len(body.element))]
    for _ in range(depth):
        halves = []
        for part in parts:  # across its longest direction
            off_m = centre_m[part] - centre_m[part].mean(axis=0)
            along = off_m @ np.linalg.eigh(off_m.T @ off_m)[1][:, 2]
            halves += np.split(part[np.argsort(along, kind="stable")], [len(part) // 2])
        parts = halves
    leaf = np.empty(len(body.element), dtype=np.int64)
    leaf[np.concatenate(parts)] = np.repeat(np.arange(2**depth, 2**(depth + 1)), [len(part) for part in parts])
    low, high = np.full(len(body.node_m), 2**(depth + 1)), np.zeros(len(body.node_m), dtype=np.int64)
    for column in body.element.T:
        np.minimum.at(low, column, leaf)
        np.maximum.at(high, column, leaf)
    return low >> np.ceil(np.log2((low ^ high) + 1)).astype(np.int64)


class Elimination:
    """Takes the unknowns of the parts out of a symmetric sparse matrix, but not those of part 0."""

    def __init__(self, matrix, part, depth):
        self.matrix, self.leaves = matrix, 2**depth
        self.order = np.argsort(part, kind="stable")
        self.start = np.searchsorted(part[self.order], np.arange(2**(depth + 1) + 1))
        self.is_left = np.ones(len(part), dtype=bool)
        self.place = np.zeros(len(part), dtype=np.int64)

    def left_of(self, part):
        """Unknowns around a part and the matrix (b, b) that it leaves of them."""
        halves = [self.left_of(half) for half in (2 * part, 2 * part + 1)] if part < self.leaves else []
        own = self.order[self.start[part]:self.start[part + 1]]
        self.is_left[own] = False
        rows = self.matrix[own].tocoo()
        around = np.unique(np.concatenate([rows.col, *(unknowns for unknowns, _ in halves)]))
        around, n = around[self.is_left[around]], len(own)
        self.place[:] = -1
        self.place[own], self.place[around] = np.arange(n), np.arange(n, n + len(around))
        front = np.zeros((n + len(around), n + len(around)), order="F")
        here = self.place[rows.col] >= 0  # what was eliminated before is in the halves
        front[self.place[rows.col[here]], rows.row[here]] = rows.data[here]
        for unknowns, left in halves:
            front[np.ix_(self.place[unknowns], self.place[unknowns])] += left
        if n == 0:
            return around, front
        lower = scipy.linalg.cholesky(front[:n, :n], lower=True, check_finite=False)
        solved = scipy.linalg.solve_triangular(lower, front[n:, :n].T, lower=True, check_finite=False)
        self.keep(part, own, around, lower, solved)
        return around, front[n:, n:] - solved.T @ solved

    def keep(self, part, own, around, lower, solved):
        """For who substitutes: L of a part's own unknowns (n, n) and L^-1 K to those around it (n, b)."""


def compliance(organ, body, loads):
    """B' K^-1 B, (m, m), of loads B, sparse (3 N, m), on the body that is held at its held nodes."""
    depth = max(0, int(np.ceil(np.log2(len(body.element) / LEAF))))
    is_free = np.ones(len(body.node_m), dtype=bool)
    is_free[body.held] = False
    unknown = np.flatnonzero(np.repeat(is_free, 3))
    k, b = stiffness(organ, body)[unknown][:, unknown], loads.tocsr()[unknown]
    part = np.concatenate([np.repeat(part_of_nodes(body, depth), 3)[unknown], np.zeros(b.shape[1], dtype=np.int64)])
    matrix = scipy.sparse.bmat([[k, b], [b.T, None]]).tocsr()
    try:
        around, left = Elimination(matrix, part, depth).left_of(1)
    except np.linalg.LinAlgError:  # a part of the body can move without force
        raise Failure("finite elements: the stiffness is not positive definite; make the box from elastic.fixed_min_m to "
                      "elastic.fixed_max_m hold every part of the organ") from None
    out = np.zeros((b.shape[1], b.shape[1]))  # a load on held nodes alone moves nothing
    out[np.ix_(around - len(unknown), around - len(unknown))] = -0.5 * (left + left.T)  # symmetric by Betti; rounding is not
    return out
