// SPDX-License-Identifier: Apache-2.0
// boundary.ts - where the surface of an organ ends: 0 edges, and it is closed.

/** Edges that have one triangle. A mesh of tact has one or two at each (model/mesh/mesh.h). */
export function count_boundary_edges(triangle: Uint32Array): number {
  const vertices = triangle.reduce((most, vertex) => Math.max(most, vertex + 1), 0);
  const alone = new Set<number>();
  for (let i = 0; i < triangle.length; ++i) {
    const a = triangle[i];
    const b = triangle[i % 3 < 2 ? i + 1 : i - 2];
    const edge = Math.min(a, b) * vertices + Math.max(a, b);
    if (!alone.delete(edge)) alone.add(edge);
  }
  return alone.size;
}
