// SPDX-License-Identifier: Apache-2.0
// smoothstep.ts - from 0 to 1 without a corner.

/** 0 below low, 1 above high, smooth between. */
export function smoothstep(low: number, high: number, x: number): number {
  const s = Math.min(1, Math.max(0, (x - low) / (high - low)));
  return s * s * (3 - 2 * s);
}
