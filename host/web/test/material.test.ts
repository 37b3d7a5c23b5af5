// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync } from "node:fs";
import { kMaterials, organ_material, piece_tints, pieces_of, tool_material, vertex_tints } from "../src/scene/material";
import { split_meshes, type Scene, type Vec } from "../src/link/protocol";

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

const scene = (organ: string, tool: string, pieces: Vec[] = []) =>
  ({ organ_material: organ, tool_material: tool, piece_color_ratio: pieces }) as unknown as Scene;

test("organ and tool look as the scene says, else like tissue and steel", () => {
  assert.equal(organ_material(scene("skin", "glove"), mesh(0, [])), kMaterials.get("skin"));
  assert.equal(tool_material(scene("skin", "glove")), kMaterials.get("glove"));
  assert.equal(organ_material(scene("", ""), mesh(0, [])), kMaterials.get("tissue"));
  assert.equal(tool_material(scene("constructor", "constructor")), kMaterials.get("steel"));
});

test("each piece has its colour, and those that have none that of the last", () => {
  const three = mesh(9, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
  const tints = piece_tints(three, [
    [1, 0.5, 0.25],
    [2, 2, 2],
  ]);
  assert.deepEqual([...tints.slice(0, 3)], [1, 0.5, 0.25]);
  assert.deepEqual([...tints.slice(9, 12)], [2, 2, 2]);
  assert.deepEqual([...tints.slice(24, 27)], [2, 2, 2]);
  assert.ok(piece_tints(three, []).every((tint) => tint === 1));
  assert.equal(organ_material(scene("tissue", "steel", [[1, 1, 1]]), three).alive, false); // given colours stay
});

test("vertices have the colours of their mesh, over no colour of the material", () => {
  const bytes = new Uint8Array(72 + 24 + 9);
  bytes.set([255, 0, 128, 0, 255, 0, 255, 255, 255], 96);
  const parts = { organ_vertices: 3, organ_triangles: 1, tool_vertices: 3, tool_triangles: 1 };
  const whole = { ...scene("tissue", "steel"), ...parts } as unknown as Scene;
  const { organ } = split_meshes(whole, bytes.buffer);
  const tints = vertex_tints(organ.color!);
  assert.deepEqual([...tints.slice(3, 6)], [0, 1, 0]);
  assert.ok(Math.abs(tints[2] - 128 / 255) < 1e-6);
  const made_of = organ_material(whole, organ);
  assert.equal(made_of.alive, false);
  assert.ok(made_of.look.base.every((part) => part === made_of.look.base[0]));
  assert.equal(split_meshes(whole, bytes.buffer.slice(0, 96)).organ.color, undefined);
});

test("the page has a picture of each material that a scene may name, and of no other", () => {
  const keys = readFileSync("../../model/scene/scene_keys.cc", "utf8");
  const list = /kMaterials\{([^;]*)\};/.exec(keys)![1];
  assert.deepEqual(
    [...list.matchAll(/Choice\{"(\w+)"/g)].map((found) => found[1]),
    [...kMaterials.keys()],
  );
});
