// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { material_of, pieces_of } from "../src/material";

function mesh(vertices: number, triangle: number[]) {
  return { vertex_m: new Float32Array(3 * vertices), triangle: Uint32Array.from(triangle) };
}

test("pieces are numbered in the order of the mesh", () => {
  // Two pieces whose triangles come mixed, the first joined only by its last triangle.
  const two = mesh(8, [0, 1, 2, 4, 6, 5, 3, 7, 2]);
  assert.deepEqual([...pieces_of(two)], [0, 0, 0, 0, 1, 1, 1, 0]);
  assert.deepEqual([...pieces_of(mesh(5, [0, 4, 4, 2, 3, 3, 3, 1, 1]))], [0, 1, 1, 1, 0]);
  assert.deepEqual([...pieces_of(mesh(3, []))], [0, 1, 2]);
});

test("an unknown scene is tissue; the cover is two pieces of its own", () => {
  assert.equal(material_of("liver").pieces.length, 0);
  assert.equal(material_of("constructor").pieces.length, 0);
  assert.equal(material_of("maintenance").pieces.length, 2);
});
