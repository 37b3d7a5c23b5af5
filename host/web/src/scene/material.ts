// SPDX-License-Identifier: Apache-2.0
// material.ts - what organ and tool look like: the materials that [look] of a scene may name (model/scene/scene_keys.cc).

import { kCover, kGlove, kSkin, kSteel, kTissue, type Look } from "./look";
import type { Mesh, Scene, Vec } from "../link/protocol";

export interface Material {
  look: Look;
  mottled: number; // unevenness of its colour, 0 .. 1
  alive: boolean; // paler where it is stretched
  soft: boolean; // has no sharp edges
}

// Linear; the vertices' colours multiply the picture that is painted of them.
const kGrey = { base: [0.7, 0.7, 0.7] as Vec, glow: [0.06, 0.06, 0.06] as Vec };
const kPlain = { mottled: 0, alive: false };
export const kMaterials: ReadonlyMap<string, Material> = new Map([
  ["tissue", { look: kTissue, mottled: 1, alive: true, soft: true }],
  ["skin", { look: kSkin, mottled: 0.35, alive: true, soft: true }],
  ["glove", { look: kGlove, ...kPlain, soft: true }],
  ["paint", { look: kCover, ...kPlain, soft: false }],
  ["steel", { look: kSteel, ...kPlain, soft: false }],
]);

/** A name that this page does not know is tissue. Colours that are given are shown as they are. */
export function organ_material(scene: Scene, mesh: Mesh): Material {
  const made_of = kMaterials.get(scene.organ_material) ?? kMaterials.get("tissue")!;
  if (mesh.color) return { ...made_of, ...kPlain, look: { ...made_of.look, ...kGrey } };
  return scene.piece_color_ratio.length > 0 ? { ...made_of, ...kPlain } : made_of;
}

/** Red, green and blue of each vertex, times the picture of the material, which is of sRGB as they are. */
export function vertex_tints(color: Uint8Array): Float32Array {
  return Float32Array.from(color, (level) => level / 255);
}

/** Of the tool it is steel. */
export function tool_material(scene: Scene): Material {
  return kMaterials.get(scene.tool_material) ?? kMaterials.get("steel")!;
}

/** Red, green and blue of each vertex, times the material's; one colour for each connected piece. */
export function piece_tints(mesh: Mesh, colors: readonly Vec[]): Float32Array {
  const out = new Float32Array(mesh.vertex_m.length).fill(1);
  if (colors.length === 0) return out;
  pieces_of(mesh).forEach((piece, v) => out.set(colors[Math.min(piece, colors.length - 1)], 3 * v));
  return out;
}

/** The piece of each vertex: 0 is the piece of the first vertex, 1 the next one in the mesh. */
export function pieces_of(mesh: Mesh): Uint32Array {
  const count = mesh.vertex_m.length / 3;
  const first = Uint32Array.from({ length: count }, (_, v) => v); // a vertex of the same piece
  const root = (v: number): number => {
    while (first[v] !== v) v = first[v] = first[first[v]];
    return v;
  };
  for (let i = 0; i < mesh.triangle.length; i += 3) {
    for (const other of [mesh.triangle[i + 1], mesh.triangle[i + 2]]) {
      const a = root(mesh.triangle[i]);
      const b = root(other);
      first[Math.max(a, b)] = Math.min(a, b);
    }
  }
  const piece = new Uint32Array(count);
  let pieces = 0;
  for (let v = 0; v < count; ++v) piece[v] = root(v) === v ? pieces++ : piece[root(v)];
  return piece;
}
