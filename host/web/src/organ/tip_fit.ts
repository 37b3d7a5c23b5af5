// SPDX-License-Identifier: Apache-2.0
// tip_fit.ts - no drawn tissue covers the lower half of a sphere that presses, where the triangles of the organ are
// wider than that sphere, or where the shift of a rough surface is not the law's.
//
//     h = sum w_k x_k . n - y      by how much a triangle is above the sphere, along a line parallel to n
//     x_k -= n h w_k / sum w^2     where h > 0, but none below the sphere
//
//     n   normal at the contact     w_k  weights of the triangle's corners x_k at the line
//     y   height of the sphere's lower half there
//
// A few lines through the sphere are enough. At an edge the weight of the opposite corner is 0 in both triangles, so
// a sphere that slides makes no vertex jump.

import { cross, length_of, type Ball, type Vec } from "../link/protocol";

/** Lines: through the centre, then rings at these shares of the radius. */
const kRings = [0.5, 0.85];
const kPerRing = 8;
const kAbove_m = 0.002; // what lies higher above a sphere than this and 1.5 times its depth is another part of the organ

const kLines: readonly (readonly [number, number])[] = [
  [0, 0],
  ...kRings.flatMap((share) =>
    Array.from({ length: kPerRing }, (_, i): [number, number] => {
      const angle = (2 * Math.PI * (i + 0.5 * kRings.indexOf(share))) / kPerRing;
      return [share * Math.cos(angle), share * Math.sin(angle)];
    }),
  ),
];

/** Two unit vectors across n: a x b = n. */
function across(n: Vec): [Vec, Vec] {
  const axis: Vec = Math.abs(n[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
  const b = unit(cross(n, axis));
  return [cross(b, n), b];
}

function unit(a: Vec): Vec {
  const length = length_of(a);
  return [a[0] / length, a[1] / length, a[2] / length];
}

export class TipFit {
  private readonly at: Float64Array[] = [0, 1, 2].map(() => new Float64Array(3)); // corners: across, across, along n
  private readonly wide_m: Float32Array; // no corner of a triangle at rest is farther from its first

  constructor(
    rest_m: Float32Array,
    private readonly triangle: Uint32Array,
  ) {
    this.wide_m = Float32Array.from({ length: triangle.length / 3 }, (_, t) => {
      const [a, b, c] = [0, 1, 2].map((k) => rest_m.subarray(3 * triangle[3 * t + k], 3 * triangle[3 * t + k] + 3));
      const length_m = (to: Float32Array): number => Math.hypot(to[0] - a[0], to[1] - a[1], to[2] - a[2]);
      return Math.max(length_m(b), length_m(c));
    });
  }

  /** Sinks what covers the ball, of these triangles. Returns by how much at most, m. */
  sink(ball: Ball, normal: Vec, depth_m: number, triangles: Uint32Array, out_m: Float32Array): number {
    let most_m = 0;
    if (!normal.every(Number.isFinite) || !(length_of(normal) > 0.5)) return most_m;
    const axes = [...across(normal), normal];
    for (const t of triangles) {
      if (this.is_far(t, ball, depth_m, out_m) || !this.project(t, ball, axes, out_m)) continue;
      for (const [x, y] of kLines) {
        const below_m = ball.radius_m * Math.sqrt(1 - x * x - y * y);
        const w = this.weights(x * ball.radius_m, y * ball.radius_m);
        if (w) most_m = Math.max(most_m, this.lower(t, w, below_m, ball.radius_m, depth_m, normal, out_m));
      }
    }
    return most_m;
  }

  private is_far(t: number, { centre_m, radius_m }: Ball, depth_m: number, out_m: Float32Array): boolean {
    const v = 3 * this.triangle[3 * t];
    const most_m = radius_m + this.wide_m[t] + 2 * depth_m;
    for (let i = 0; i < 3; ++i) if (Math.abs(out_m[v + i] - centre_m[i]) > most_m) return true;
    return false;
  }

  /** Corners of a triangle in the axes of the contact; false: it is next to the sphere, or faces away. */
  private project(t: number, ball: Ball, axes: readonly Vec[], out_m: Float32Array): boolean {
    const c = ball.centre_m;
    for (let k = 0; k < 3; ++k) {
      const v = 3 * this.triangle[3 * t + k];
      const [x, y, z] = [out_m[v] - c[0], out_m[v + 1] - c[1], out_m[v + 2] - c[2]];
      for (let i = 0; i < 3; ++i) this.at[k][i] = x * axes[i][0] + y * axes[i][1] + z * axes[i][2];
    }
    const [p, q, s] = this.at;
    for (let i = 0; i < 2; ++i) {
      if (Math.min(p[i], q[i], s[i]) > ball.radius_m || Math.max(p[i], q[i], s[i]) < -ball.radius_m) return false;
    }
    return (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0]) > 0;
  }

  /** Of the corners where a line goes through the triangle; null: it passes by. */
  private weights(x: number, y: number): Vec | null {
    const [p, q, s] = this.at;
    const area = (q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0]);
    const u = ((x - p[0]) * (s[1] - p[1]) - (y - p[1]) * (s[0] - p[0])) / area;
    const v = ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area;
    return u >= 0 && v >= 0 && u + v <= 1 ? [1 - u - v, u, v] : null;
  }

  private lower(t: number, w: Vec, below_m: number, radius_m: number, depth_m: number, n: Vec, out_m: Float32Array): number {
    const h_m = w[0] * this.at[0][2] + w[1] * this.at[1][2] + w[2] * this.at[2][2] + below_m;
    if (!(h_m > 0) || h_m > 1.5 * depth_m + kAbove_m) return 0;
    const share = h_m / (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (let k = 0; k < 3; ++k) {
      const v = 3 * this.triangle[3 * t + k];
      const down_m = Math.min(share * w[k], Math.max(0, this.at[k][2] + radius_m));
      for (let i = 0; i < 3; ++i) out_m[v + i] -= n[i] * down_m;
      this.at[k][2] -= down_m;
    }
    return h_m;
  }
}
