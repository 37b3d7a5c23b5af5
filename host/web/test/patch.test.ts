// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Deformer } from "../src/organ/deform";
import { Cuts, decode_moved } from "../src/organ/patch";
import type { Patch } from "../src/link/protocol";

/** Two vertices, 7 and 70 000, moved by 1, -2, 3 um and by 32 767, 0, -1 um: as tact-view writes it. */
const kPatch: Patch = { count: 2, moved: "BwAAAHARAQABAP7/AwD/fwAA//8=", cut_total: 0, cut: [] };

test("displaced vertices arrive with their numbers and in metres", () => {
  const moved = decode_moved(kPatch);
  assert.deepEqual([...moved.vertex], [7, 70_000]);
  const expected_m = [1e-6, -2e-6, 3e-6, 0.032767, 0, -1e-6];
  moved.displacement_m.forEach((u_m, i) => assert.ok(Math.abs(u_m - expected_m[i]) < 1e-8)); // float32
});

test("a patch whose bytes do not fit its count moves nothing", () => {
  assert.equal(decode_moved({ ...kPatch, count: 3 }).vertex.length, 0);
});

test("vertices that are reported move exactly so, others stay, and unknown ones are ignored", () => {
  const rest_m = new Float32Array([0, 0, 0, 1, 0, 0, 2, 0, 0]);
  const out_m = rest_m.slice();
  const result = { moved: 0, most_m: 0 };
  const deformer = new Deformer(rest_m, new Float32Array(9), 0, 0, new Uint32Array(0));
  const moved = { vertex: new Uint32Array([1, 99]), displacement_m: new Float32Array([0, 0, -0.5, 1, 1, 1]) };
  assert.equal(deformer.apply([], moved, out_m, result), true);
  assert.deepEqual([...out_m], [0, 0, 0, 1, 0, -0.5, 2, 0, 0]);
  assert.equal(result.moved, 1);
  assert.equal(result.most_m, 0.5);
});

test("cuts are collected from windows in any order, and a new run forgets them", () => {
  const cuts = new Cuts();
  assert.equal(cuts.learn({ ...kPatch, cut_total: 4, cut: [5, 6] }), true);
  assert.equal(cuts.learn({ ...kPatch, cut_total: 4, cut: [6, 7] }), true);
  assert.equal(cuts.learn({ ...kPatch, cut_total: 4, cut: [5] }), false);
  assert.deepEqual([...cuts.triangles].sort(), [5, 6, 7]);
  assert.equal(cuts.learn({ ...kPatch, cut_total: 1, cut: [9] }), true);
  assert.deepEqual([...cuts.triangles], [9]);
});
