// SPDX-License-Identifier: Apache-2.0
// A cut: both sides of the blade's path, and the walls between them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { kMaxCut, place, split, type Corner } from "../src/organ/cut_pieces";

const kSide = 8; // squares of 1 mm
const kDepth_m = 0.003;

/** A flat sheet of two triangles a square, z = 0, and the triangles that the line y = 4.3 mm crosses, x = 2 .. 6 mm. */
function sheet() {
  const at = (x: number, y: number): number => x * (kSide + 1) + y;
  const rest_m: number[] = [];
  const triangle: number[] = [];
  const cut = new Set<number>();
  for (let x = 0; x <= kSide; ++x) for (let y = 0; y <= kSide; ++y) rest_m.push(1e-3 * x, 1e-3 * y, 0);
  for (let x = 0; x < kSide; ++x)
    for (let y = 0; y < kSide; ++y) {
      if (y === 4 && x >= 2 && x < 6) [0, 1].forEach((k) => cut.add(triangle.length / 3 + k));
      triangle.push(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1));
    }
  const normal = new Float32Array(rest_m.length).map((_, i) => (i % 3 === 2 ? 1 : 0));
  return { rest_m: new Float32Array(rest_m), triangle: new Uint32Array(triangle), normal, cut };
}

/** Opened by 1 mm: all above the path goes up in y. */
function opened() {
  const made = sheet();
  const now_m = made.rest_m.slice();
  for (let i = 0; i < now_m.length; i += 3) if (made.rest_m[i + 1] > 4.5e-3) now_m[i + 1] += 1e-3;
  const pieces = split(made.triangle, made.rest_m, made.cut);
  const where = (corners: readonly Corner[], of_m: Float32Array): number[][] => {
    const out_m = new Float32Array(3 * corners.length);
    place(corners, made.rest_m, of_m, made.normal, kDepth_m, out_m);
    return corners.map((_, i) => [...out_m.subarray(3 * i, 3 * i + 3)]);
  };
  return { ...made, now_m, pieces, where };
}

function area_m2(points: number[][]): number {
  let sum = 0;
  for (let i = 0; i < points.length; i += 3) {
    const [p, q, r] = points.slice(i, i + 3);
    sum += 0.5 * Math.abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
  }
  return sum;
}

test("the pieces cover the triangles that were cut", () => {
  const { cut, pieces, rest_m, where } = opened();
  const area = area_m2(where(pieces.surface, rest_m));
  assert.ok(Math.abs(area - cut.size * 0.5e-6) < 1e-11, String(area));
});

test("the two edges of a cut move apart with their sides", () => {
  const { pieces, now_m, rest_m, where } = opened();
  const moved = where(pieces.surface, now_m);
  const before = where(pieces.surface, rest_m);
  pieces.surface.forEach(({ side }, i) => {
    const up_m = rest_m[3 * side + 1] > 4.5e-3 ? 1e-3 : 0;
    assert.ok(Math.abs(moved[i][1] - before[i][1] - up_m) < 1e-8);
  });
  assert.ok(
    pieces.surface.some(({ a, b, side }) => a !== b && side === a) &&
      pieces.surface.some(({ a, b, side }) => a !== b && side === b),
  );
});

test("walls close the cut: with the uncut surface no edge is open but the border of the sheet", () => {
  const { cut, now_m, pieces, rest_m, triangle, where } = opened();
  const points = [...where(pieces.surface, now_m), ...where(pieces.wall, now_m)];
  for (let t = 0; t < triangle.length / 3; ++t)
    if (!cut.has(t))
      for (let k = 0; k < 3; ++k) points.push([...now_m.subarray(3 * triangle[3 * t + k], 3 * triangle[3 * t + k] + 3)]);
  const name = (point: number[]): string => point.map((at_m) => Math.round(at_m * 1e7)).join(" ");
  const open = new Map<string, number[][]>();
  for (let i = 0; i < points.length; i += 3)
    for (let k = 0; k < 3; ++k) {
      const ends = [points[i + k], points[i + ((k + 1) % 3)]];
      const key = ends.map(name).sort().join(" | ");
      if (!open.delete(key)) open.set(key, ends);
    }
  const on_border = ([x, y]: number[]): boolean => [0, 8e-3].some((at_m) => Math.abs(x - at_m) < 1e-7) || y < 1e-7 || y > 8.9e-3;
  const wrong = [...open.values()].filter((ends) => !ends.every(on_border));
  assert.equal(wrong.length, 0, JSON.stringify(wrong.slice(0, 3)));
  assert.equal(rest_m.length, now_m.length);
});

test("walls lead below the surface, and the path is straight", () => {
  const { pieces, rest_m, where } = opened();
  const below = where(pieces.wall, rest_m).filter((_, i) => pieces.wall[i].side < 0);
  assert.ok(below.length > 0 && below.every(([, , z]) => Math.abs(z + kDepth_m) < 1e-8));
  const off_m = below.map(([, y]) => Math.abs(y - 4.5e-3));
  assert.ok(Math.max(...off_m) < 0.1e-3, `${Math.max(...off_m)} m`);
});

test("more triangles than its capacity are not split", () => {
  const triangle = new Uint32Array(3 * (kMaxCut + 5)).map((_, i) => i);
  const pieces = split(
    triangle,
    new Float32Array(3 * triangle.length),
    new Set(Array.from({ length: kMaxCut + 5 }, (_, i) => i)),
  );
  assert.equal(pieces.surface.length, 3 * kMaxCut);
});
