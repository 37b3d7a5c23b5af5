// SPDX-License-Identifier: Apache-2.0
// tool_turn.ts - how far the hand has turned the tool against its rest, as far as the simulated wrist goes.

import * as THREE from "three";
import type { Vec } from "../link/protocol";

const kMaxTurn_rad = (20 * Math.PI) / 180; // hal/sim/sim_wrist.h

/** Axis times angle, W. */
export function rotation_rad(turn: THREE.Quaternion): Vec {
  const axis = new THREE.Vector3(turn.x, turn.y, turn.z);
  const sine = axis.length();
  const angle_rad = 2 * Math.atan2(sine, Math.abs(turn.w));
  return axis.multiplyScalar(sine > 0 ? (Math.sign(turn.w || 1) * angle_rad) / sine : 0).toArray();
}

/** Turned on about an axis of W, never farther than the wrist goes. */
export function turned_on(turn: THREE.Quaternion, axis: THREE.Vector3, by_rad: number): THREE.Quaternion {
  const next = new THREE.Quaternion().setFromAxisAngle(axis, by_rad).multiply(turn);
  const angle_rad = Math.hypot(...rotation_rad(next));
  return new THREE.Quaternion().slerp(next, angle_rad > kMaxTurn_rad ? kMaxTurn_rad / angle_rad : 1);
}
