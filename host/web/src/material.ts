// SPDX-License-Identifier: Apache-2.0
// material.ts - what the touched body of a scene is made of: tissue, unless the scene is named here.

import { kCover, kTissue, type Look } from "./look";
import type { Mesh, Vec } from "./protocol";

export interface Material {
  look: Look;
  /** Factors on the colour of the look, for each connected piece of the mesh; none: flesh. */
  pieces: readonly Vec[];
}

// By the scene's name, because neither scene.json nor mesh.bin says what a body is made of: what
// travels is shape, law and limits, and a soft gasket has the law of a tissue.
const kFlesh: Material = { look: kTissue, pieces: [] };
const kMaterials = new Map<string, Material>([
  // Painted metal and the silicone of its gasket.
  ["maintenance", { look: kCover, pieces: [[0.92, 1.0, 1.06], [1.55, 0.72, 0.4]] }],
]);

export function material_of(scene_name: string): Material {
  return kMaterials.get(scene_name) ?? kFlesh;
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
