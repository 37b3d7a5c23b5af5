// SPDX-License-Identifier: Apache-2.0
// fold_guard.ts - keeps the drawn surface from folding over where indentations are deep and steep.
//
//     A . A0 >= kMin |A0|^2       A0, A  area vector of a triangle at rest and now
//     d_k += (mean d - d_k) / 2     its three corners, where that is not so
//
// Alike displacements leave a triangle as it was at rest, so what is too steep spreads to its
// neighbours, a pass after the other, and the rest of the indentation stays as the law says. Without a
// fold it costs one check of each triangle that moved.

const kMin = 0.1;
const kMaxPasses = 60; // 20 mm deep: the liver needs 14, a surface of 1 mm edges 40

export class FoldGuard {
  private readonly moved: Uint32Array; // triangles, the first so many

  constructor(
    private readonly rest_m: Float32Array,
    private readonly triangle: Uint32Array,
  ) {
    this.moved = new Uint32Array(triangle.length / 3);
  }

  /** Repairs out_m; returns the passes that this took. */
  hold(out_m: Float32Array): number {
    const moved = this.find_moved(out_m);
    for (let pass = 0; pass < kMaxPasses; ++pass) {
      let folded = 0;
      for (const t of moved) {
        if (!this.is_folded(t, out_m)) continue;
        this.even_out(t, out_m);
        ++folded;
      }
      if (folded === 0) return pass;
    }
    return kMaxPasses;
  }

  is_folded(t: number, out_m: Float32Array): boolean {
    const a = 3 * this.triangle[3 * t];
    const b = 3 * this.triangle[3 * t + 1];
    const c = 3 * this.triangle[3 * t + 2];
    let along = 0;
    let rest = 0;
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3;
      const k = (i + 2) % 3;
      const now = turn(out_m, a, b, c, j, k);
      const before = turn(this.rest_m, a, b, c, j, k);
      along += now * before;
      rest += before * before;
    }
    return along < kMin * rest;
  }

  /** Triangles with a corner that moved, until the next call. */
  find_moved(out_m: Float32Array): Uint32Array {
    let count = 0;
    for (let t = 0; t < this.moved.length; ++t)
      if (this.is_moved(3 * t, out_m) || this.is_moved(3 * t + 1, out_m) || this.is_moved(3 * t + 2, out_m))
        this.moved[count++] = t;
    return this.moved.subarray(0, count);
  }

  private is_moved(corner: number, out_m: Float32Array): boolean {
    const v = 3 * this.triangle[corner];
    const rest_m = this.rest_m;
    return out_m[v] !== rest_m[v] || out_m[v + 1] !== rest_m[v + 1] || out_m[v + 2] !== rest_m[v + 2];
  }

  private even_out(t: number, out_m: Float32Array): void {
    for (let i = 0; i < 3; ++i) {
      let mean_m = 0;
      for (let k = 0; k < 3; ++k) {
        const v = 3 * this.triangle[3 * t + k] + i;
        mean_m += (out_m[v] - this.rest_m[v]) / 3;
      }
      for (let k = 0; k < 3; ++k) {
        const v = 3 * this.triangle[3 * t + k] + i;
        out_m[v] += 0.5 * (mean_m - (out_m[v] - this.rest_m[v]));
      }
    }
  }
}

/** One component of (b - a) x (c - a); a, b, c begin a vertex. */
function turn(at_m: Float32Array, a: number, b: number, c: number, j: number, k: number): number {
  return (at_m[b + j] - at_m[a + j]) * (at_m[c + k] - at_m[a + k]) - (at_m[b + k] - at_m[a + k]) * (at_m[c + j] - at_m[a + j]);
}
