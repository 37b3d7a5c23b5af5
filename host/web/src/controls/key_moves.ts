// SPDX-License-Identifier: Apache-2.0
// key_moves.ts - what the mouse does by dragging and turning its wheel, by keys: turns the view, with Shift moves the
// simulated hand.

import type { HandControl } from "./hand_control";
import type { Stage } from "../scene/stage";
import type { Vec } from "../link/protocol";

const kTurn_rad = (5 * Math.PI) / 180; // each for a press of a key; held down it goes on
const kNearer_ratio = 0.9;
const kStep_m = 0.002;

/** To the right, up and into the picture. */
const kTowards: Record<string, Vec> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

/** False when this key moves nothing now. */
export function move_by_key(key: string, shift: boolean, stage: Stage, hand: HandControl): boolean {
  const towards = Object.hasOwn(kTowards, key) ? kTowards[key] : null;
  if (!towards) return false;
  if (shift || hand.mode) return hand.step(towards.map((share) => share * kStep_m) as Vec);
  return stage.turn(kTurn_rad * towards[0], kTurn_rad * towards[1], Math.pow(kNearer_ratio, towards[2]));
}
