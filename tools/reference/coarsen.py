# SPDX-License-Identifier: Apache-2.0
"""Fewer triangles far from the tool: a body at finite strain is solved a hundred times, and most of it is far away.

A vertex v moves onto a neighbour w and its edge v w is gone (half-edge collapse), shortest edge first, where

    far       v and all its neighbours lie where edges may be long: every new edge is at most h(x) of EdgeLengths
    near      the planes of all triangles that met v, also those collapsed before, are within the tolerance of w (quadric
              error: the root of a sum of squares)
    smooth    no triangle turns by more than 37 degrees, none becomes a needle
    sound     v and w have two neighbours in common; both lie in the held box, or neither does

Source: M. Garland, P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997.
"""
import heapq

import numpy as np

TURN, NEEDLE = 0.8, 0.15  # cosine; of an equal-sided triangle's quality


def normals(p):
    """Of triangles (t, 3, 3), not unit."""
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


class Collapse:
    def __init__(self, vertex_m, triangle, lengths, held, tolerance_m):
        self.p, self.held, self.tolerance_m = vertex_m, held, tolerance_m
        self.triangle = [list(t) for t in triangle.tolist()]
        self.h = lengths.at(vertex_m)
        self.around = [set() for _ in vertex_m]  # rows of triangles
        for row, corners in enumerate(self.triangle):
            for v in corners:
                self.around[v].add(row)
        n = normals(vertex_m[triangle])
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        plane = np.hstack([n, -np.einsum("ti,ti->t", n, vertex_m[triangle[:, 0]])[:, None]])
        self.quadric = np.zeros((len(vertex_m), 4, 4))
        for k in range(3):
            np.add.at(self.quadric, triangle[:, k], np.einsum("ti,tj->tij", plane, plane))

    def neighbours(self, v):
        return {w for row in self.around[v] for w in self.triangle[row]} - {v}

    def is_good(self, v, w):
        """May v move onto w?"""
        ring = self.neighbours(v)
        if self.held[v] != self.held[w] or len(ring & self.neighbours(w)) != 2:
            return False
        far = np.array(sorted(ring - {w}))
        if (np.linalg.norm(self.p[far] - self.p[w], axis=1) > self.h[w]).any():
            return False
        at = np.append(self.p[w], 1.0)
        if at @ (self.quadric[v] + self.quadric[w]) @ at > self.tolerance_m**2:
            return False
        kept = np.array([self.triangle[row] for row in self.around[v] if w not in self.triangle[row]])
        moved_m = self.p[np.where(kept == v, w, kept)]
        before, after = normals(self.p[kept]), normals(moved_m)
        length = np.linalg.norm(after, axis=1)
        edges_m2 = ((moved_m - moved_m[:, [1, 2, 0]])**2).sum(axis=(1, 2))
        if (2.0 * 3.0**0.5 * length < NEEDLE * edges_m2).any():
            return False
        return (np.einsum("ti,ti->t", before, after) >= TURN * np.linalg.norm(before, axis=1) * length).all()

    def collapse(self, v, w):
        self.quadric[w] += self.quadric[v]
        for row in self.around[v]:
            if w in self.triangle[row]:
                for other in self.triangle[row]:
                    if other != v:
                        self.around[other].discard(row)
                self.triangle[row] = None
            else:
                self.triangle[row] = [w if corner == v else corner for corner in self.triangle[row]]
                self.around[w].add(row)
        self.around[v] = set()

    def run(self):
        """The triangles (T, 3) that are left."""
        def edges_of(v):
            return [(float(np.linalg.norm(self.p[v] - self.p[w])), v, w) for w in self.neighbours(v)]

        queue = [edge for v in range(len(self.p)) for edge in edges_of(v)]
        heapq.heapify(queue)
        while queue:
            length_m, v, w = heapq.heappop(queue)
            if length_m > self.h[w] or not self.around[v] or w not in self.neighbours(v) or not self.is_good(v, w):
                continue
            self.collapse(v, w)
            for u in self.neighbours(w):
                for edge in edges_of(u):
                    heapq.heappush(queue, edge)
        return np.array([corners for corners in self.triangle if corners])


def coarsened(organ, lengths, tolerance_m):
    """Vertices and triangles of the organ's surface with edges up to h(x) where that keeps its shape."""
    triangle = Collapse(organ.vertex_m, organ.triangle, lengths, organ.held(organ.vertex_m), tolerance_m).run()
    used, triangle = np.unique(triangle, return_inverse=True)
    return organ.vertex_m[used], triangle.reshape(-1, 3)
