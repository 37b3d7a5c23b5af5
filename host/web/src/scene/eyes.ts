// SPDX-License-Identifier: Apache-2.0
// eyes.ts - a person's eyes as the camera, and how it follows them. Vectors are [x, y, z] in frame W.

import type { Vec } from "../link/protocol";

/** Of who wears a headset: where the eyes are, and the turn w, x, y, z from looking along -x with +z up. */
export interface WornHead {
  at_m: Vec;
  turn: [number, number, number, number];
}

export interface Eyes {
  at_m: Vec;
  towards: Vec; // unit
}

/** The share of the way that a smooth follower goes in `dt_s`, with time constant `tau_s`. */
export function follow_share(dt_s: number, tau_s: number): number {
  return dt_s > 0 ? 1 - Math.exp(-dt_s / tau_s) : 0;
}
