// SPDX-License-Identifier: Apache-2.0
// Surfaces and indentations for tests of what is drawn.
import { readFileSync } from "node:fs";
import type { Vec } from "../src/link/protocol";

export const kPitch_m = 0.001; // of rings_m

export interface Surface {
  vertex_m: Float32Array;
  triangle: Uint32Array;
  normal: Float32Array;
}

export function with_normals(vertex_m: Float32Array, triangle: Uint32Array): Surface {
  const normal = new Float32Array(vertex_m.length);
  for (let t = 0; t < triangle.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangle[t + k]);
    for (let i = 0; i < 3; ++i) {
      const [j, k] = [(i + 1) % 3, (i + 2) % 3];
      const n =
        (vertex_m[b + j] - vertex_m[a + j]) * (vertex_m[c + k] - vertex_m[a + k]) -
        (vertex_m[b + k] - vertex_m[a + k]) * (vertex_m[c + j] - vertex_m[a + j]);
      for (const v of [a, b, c]) normal[v + i] += n;
    }
  }
  for (let v = 0; v < normal.length; v += 3) {
    const length = Math.hypot(normal[v], normal[v + 1], normal[v + 2]);
    for (let i = v; i < v + 3; ++i) normal[i] /= length;
  }
  return { vertex_m, triangle, normal };
}

/** Of model/scenes/meshes, all of which are in mm. */
export function organ(name: string): Surface {
  const vertex_m: number[] = [];
  const triangle: number[] = [];
  for (const line of readFileSync(`../../model/scenes/meshes/${name}.obj`, "utf8").split("\n")) {
    const [kind, ...words] = line.trim().split(/\s+/);
    if (kind === "v") vertex_m.push(...words.map((word) => Number(word) * 1e-3));
    if (kind === "f") triangle.push(...words.map((word) => parseInt(word) - 1));
  }
  return with_normals(new Float32Array(vertex_m), new Uint32Array(triangle));
}

/** A ball's indentation: round in the contact area, then as a half-space under a disc. */
export function rings_m(depth_m: number, tip_m: number): number[] {
  const contact_m = Math.min(0.97 * tip_m, Math.sqrt(depth_m * tip_m));
  const edge_m = depth_m - tip_m + Math.sqrt(tip_m ** 2 - contact_m ** 2);
  return Array.from({ length: 32 }, (_, j) => {
    const r_m = j * kPitch_m;
    if (r_m <= contact_m) return depth_m - tip_m + Math.sqrt(tip_m ** 2 - r_m ** 2);
    return ((2 * edge_m) / Math.PI) * Math.asin(contact_m / r_m) * (1 - (j / 31) ** 4);
  });
}

export function vector(from: Float32Array, v: number): Vec {
  return [from[3 * v], from[3 * v + 1], from[3 * v + 2]];
}
