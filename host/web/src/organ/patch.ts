// SPDX-License-Identifier: Apache-2.0
// patch.ts - what a mass-spring tissue shows: displaced vertices one by one, and triangles that a
// blade has cut. Cuts come in windows over one growing list, so a lost frame costs nothing: the
// window moves on and comes round again.

import type { Patch } from "../link/protocol";

const kVertexBytes = 4;
const kMoveBytes = 6; // three int16, micrometres
const kMetrePerCount = 1e-6;

export interface Moved {
  vertex: Uint32Array;
  displacement_m: Float32Array; // 3 per vertex
}

/** Vertex numbers, then displacements; what does not fit together is nothing. */
export function decode_moved(patch: Patch): Moved {
  const text = atob(patch.moved);
  if (text.length !== patch.count * (kVertexBytes + kMoveBytes)) {
    return { vertex: new Uint32Array(0), displacement_m: new Float32Array(0) };
  }
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const split = patch.count * kVertexBytes;
  const vertex = new Uint32Array(bytes.buffer, 0, patch.count);
  const counts = new Int16Array(bytes.buffer, split, 3 * patch.count);
  const displacement_m = new Float32Array(counts.length);
  for (let i = 0; i < counts.length; ++i) displacement_m[i] = kMetrePerCount * counts[i];
  return { vertex, displacement_m };
}

/** All cut triangles that were ever received. */
export class Cuts {
  readonly triangles = new Set<number>();

  /** True when there were new ones. A shorter list than known is a new run. */
  learn(patch: Patch): boolean {
    const before = this.triangles.size;
    if (patch.cut_total < before) this.triangles.clear();
    for (const triangle of patch.cut) this.triangles.add(triangle);
    return this.triangles.size !== before;
  }
}
