// SPDX-License-Identifier: Apache-2.0
// profile.ts - a smooth curve through the displacements of the rings.
//
// Monotone cubic Hermite interpolation [F. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984)
// 300] through u_j at radius j * pitch: it never overshoots, so the tissue shows no ripple that the
// law did not make. The slope is zero at the centre (the surface has no spike there) and at the end,
// one ring after the last one, where u = 0.

export class Profile {
  /** Beyond this radius nothing moves, m. */
  reach_m = 0;
  private u: Float64Array;
  private slope: Float64Array; // du per ring
  private rings = 0;

  constructor(
    most_rings: number,
    private readonly pitch_m: number,
  ) {
    this.u = new Float64Array(most_rings + 1);
    this.slope = new Float64Array(most_rings + 1);
  }

  set(ring_m: readonly (number | null)[]): void {
    const n = Math.min(ring_m.length, this.u.length - 1);
    for (let j = 0; j < n; ++j) this.u[j] = ring_m[j] ?? 0;
    this.u[n] = 0;
    this.rings = n;
    this.reach_m = n * this.pitch_m;
    this.slope[0] = 0;
    this.slope[n] = 0;
    for (let j = 1; j < n; ++j) {
      const before = this.u[j] - this.u[j - 1];
      const after = this.u[j + 1] - this.u[j];
      // m = 2 d0 d1 / (d0 + d1) where both go the same way, else a flat top
      this.slope[j] = before * after > 0 ? (2 * before * after) / (before + after) : 0;
    }
  }

  /** u at a radius, m. */
  at(radius_m: number): number {
    if (!(radius_m < this.reach_m)) return 0;
    const x = radius_m / this.pitch_m;
    const j = Math.min(Math.floor(x), this.rings - 1);
    const s = x - j;
    const t = 1 - s;
    // u = h00 u_j + h10 m_j + h01 u_j+1 + h11 m_j+1
    return (
      t * t * (1 + 2 * s) * this.u[j] +
      t * t * s * this.slope[j] +
      s * s * (3 - 2 * s) * this.u[j + 1] -
      s * s * t * this.slope[j + 1]
    );
  }
}
