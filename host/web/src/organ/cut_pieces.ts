// SPDX-License-Identifier: Apache-2.0
// cut_pieces.ts - splits cut triangles along the path of the blade. tactd names the triangles alone: an edge that two of
// them share is cut, and the path crosses it where it runs straightest.
//
//     one cut edge     the end of a cut, which closes at the opposite corner
//     two              the path goes through: a corner on its one side, two triangles on the other
//     three            the path forks
//
// Under each cut edge of the surface a wall leads down to where the two walls meet.

export const kMaxCut = 1024; // kMaxCutTriangles of model/springs/patch_region.h
const kRelaxations = 12;
const kLeast = 0.2; // of an edge, so near the path comes to its ends

/** A corner of a piece: between vertices a and b at ratio t from a; moves with vertex `side`, with both of them if -1. */
export interface Corner {
  a: number;
  b: number;
  t: number;
  side: number;
}

export interface Pieces {
  surface: Corner[]; // 3 per triangle, as wide as the triangles that were cut
  wall: Corner[]; // 3 per triangle; side -1 is below
}

interface Cut {
  a: number; // the lesser vertex
  b: number;
  t: number;
  neighbours: Cut[]; // across the triangles
}

type Point = [number, number, number];

export function split(triangle: Uint32Array, rest_m: Float32Array, cut: ReadonlySet<number>): Pieces {
  const marked = [...cut].slice(0, kMaxCut).filter((t) => 3 * t + 2 < triangle.length);
  const edges = cut_edges(triangle, rest_m.length / 3, marked);
  straighten(edges.values(), rest_m);
  const pieces: Pieces = { surface: [], wall: [] };
  for (const t of marked) split_one([...triangle.subarray(3 * t, 3 * t + 3)], edges, rest_m.length / 3, pieces);
  return pieces;
}

function key_of(a: number, b: number, vertices: number): number {
  return Math.min(a, b) * vertices + Math.max(a, b);
}

function cut_edges(triangle: Uint32Array, vertices: number, marked: readonly number[]): Map<number, Cut> {
  const once = new Set<number>();
  const edges = new Map<number, Cut>();
  const keys_of = (t: number): [number, number, number][] =>
    [0, 1, 2].map((k) => {
      const [a, b] = [triangle[3 * t + k], triangle[3 * t + ((k + 1) % 3)]];
      return [key_of(a, b, vertices), Math.min(a, b), Math.max(a, b)];
    });
  for (const t of marked)
    for (const [key, a, b] of keys_of(t))
      if (once.has(key)) edges.set(key, { a, b, t: 0.5, neighbours: [] });
      else once.add(key);
  for (const t of marked) {
    const crossed = keys_of(t).flatMap(([key]) => edges.get(key) ?? []);
    for (const one of crossed) one.neighbours.push(...crossed.filter((other) => other !== one));
  }
  return edges;
}

/** Each crossing goes to where its edge is nearest to the middle of its two neighbours. */
function straighten(edges: Iterable<Cut>, rest_m: Float32Array): void {
  const through = [...edges].filter((edge) => edge.neighbours.length === 2);
  for (let i = 0; i < kRelaxations; ++i)
    for (const edge of through) {
      const [p, q] = edge.neighbours.map((other) => at(other, rest_m));
      const from = at({ ...edge, t: 0 }, rest_m);
      const to = at({ ...edge, t: 1 }, rest_m);
      let along = 0;
      let length2 = 0;
      for (let k = 0; k < 3; ++k) {
        along += (0.5 * (p[k] + q[k]) - from[k]) * (to[k] - from[k]);
        length2 += (to[k] - from[k]) ** 2;
      }
      edge.t = Math.min(Math.max(length2 > 0 ? along / length2 : 0.5, kLeast), 1 - kLeast);
    }
}

function at({ a, b, t }: Pick<Cut, "a" | "b" | "t">, rest_m: Float32Array): Point {
  return [0, 1, 2].map((k) => (1 - t) * rest_m[3 * a + k] + t * rest_m[3 * b + k]) as Point;
}

function split_one(corners: number[], edges: ReadonlyMap<number, Cut>, vertices: number, out: Pieces): void {
  const edge_at = (k: number): Cut | undefined => edges.get(key_of(corners[k % 3], corners[(k + 1) % 3], vertices));
  const count = [0, 1, 2].filter((k) => edge_at(k)).length;
  // Begins so that the first edge is cut, and of two the last one, too.
  const first = [0, 1, 2].find((k) => edge_at(k) && (count !== 2 || edge_at(k + 2))) ?? 0;
  const [a, b, c] = [0, 1, 2].map((k) => corners[(first + k) % 3]);
  const [ab, bc, ca] = [0, 1, 2].map((k) => edge_at(first + k));
  const whole = (v: number): Corner => ({ a: v, b: v, t: 0, side: v });
  const on = (edge: Cut, side: number): Corner => ({ a: edge.a, b: edge.b, t: edge.t, side });
  const wall = (from: Corner, to: Corner, under_to: Corner, under_from: Corner): void =>
    void out.wall.push(from, to, under_to, from, under_to, under_from);
  if (count === 0) out.surface.push(whole(a), whole(b), whole(c));
  else if (count === 1 && ab) {
    out.surface.push(whole(a), on(ab, a), whole(c), on(ab, b), whole(b), whole(c));
    out.wall.push(on(ab, a), whole(c), on(ab, -1), on(ab, b), whole(c), on(ab, -1));
  } else if (count === 2 && ab && ca) {
    out.surface.push(whole(a), on(ab, a), on(ca, a));
    out.surface.push(on(ab, b), whole(b), whole(c), on(ab, b), whole(c), on(ca, c));
    wall(on(ab, a), on(ca, a), on(ca, -1), on(ab, -1));
    wall(on(ab, b), on(ca, c), on(ca, -1), on(ab, -1));
  } else if (ab && bc && ca) {
    for (const [v, next, before] of [
      [a, ab, ca],
      [b, bc, ab],
      [c, ca, bc],
    ] as [number, Cut, Cut][]) {
      out.surface.push(whole(v), on(next, v), on(before, v));
      wall(on(next, v), on(before, v), on(before, -1), on(next, -1));
    }
    out.wall.push(on(ab, -1), on(bc, -1), on(ca, -1));
  }
}

/** Where the corners are now, 3 numbers each; those below `depth_m` under the surface. */
export function place(
  corners: readonly Corner[],
  rest_m: Float32Array,
  now_m: Float32Array,
  normal: Float32Array,
  depth_m: number,
  out_m: Float32Array,
): void {
  corners.forEach(({ a, b, t, side }, i) => {
    for (let k = 0; k < 3; ++k) {
      const between = (of: Float32Array): number => (1 - t) * of[3 * a + k] + t * of[3 * b + k];
      out_m[3 * i + k] =
        side < 0 ? between(now_m) - depth_m * between(normal) : between(rest_m) + now_m[3 * side + k] - rest_m[3 * side + k];
    }
  });
}
