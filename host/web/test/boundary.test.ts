// SPDX-License-Identifier: Apache-2.0
// A hole is reported by the edges at its rim.

import assert from "node:assert/strict";
import { test } from "node:test";

import { count_boundary_edges } from "../src/organ/boundary";

const tetrahedron = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];

test("a closed surface has no boundary", () => {
  assert.equal(count_boundary_edges(new Uint32Array(tetrahedron)), 0);
  assert.equal(count_boundary_edges(new Uint32Array()), 0);
});

test("a triangle that is missing leaves its three edges", () => {
  assert.equal(count_boundary_edges(new Uint32Array(tetrahedron.slice(3))), 3);
});

test("two triangles have the boundary of their square", () => {
  assert.equal(count_boundary_edges(new Uint32Array([0, 1, 2, 0, 2, 3])), 4);
});
