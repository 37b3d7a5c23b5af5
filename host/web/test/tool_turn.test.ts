// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { rotation_rad, turned_on } from "../src/controls/tool_turn";

const kUp = new THREE.Vector3(0, 0, 1);
const kRight = new THREE.Vector3(0, 1, 0);

test("a turn becomes axis times angle", () => {
  const [x, y, z] = rotation_rad(turned_on(new THREE.Quaternion(), kUp, -0.2));
  assert.ok(Math.hypot(x, y, z + 0.2) < 1e-12);
  assert.deepEqual(rotation_rad(new THREE.Quaternion()), [0, 0, 0]);
  const same = rotation_rad(new THREE.Quaternion(0, 0, Math.sin(0.1), -Math.cos(0.1)));
  assert.ok(Math.abs(same[2] + 0.2) < 1e-12, "q and -q are one turn");
});

test("turns add up, the newest about an axis of W", () => {
  const turn = turned_on(turned_on(new THREE.Quaternion(), kUp, 0.1), kRight, 0.1);
  const want = new THREE.Quaternion().setFromAxisAngle(kRight, 0.1);
  want.multiply(new THREE.Quaternion().setFromAxisAngle(kUp, 0.1));
  assert.ok(turn.angleTo(want) < 1e-7);
});

test("no turn goes farther than the simulated wrist", () => {
  let turn = new THREE.Quaternion();
  for (let i = 0; i < 50; ++i) turn = turned_on(turn, kUp, 0.05);
  assert.ok(Math.abs(rotation_rad(turn)[2] - Math.PI / 9) < 1e-12);
  turn = turned_on(turn, kUp, -0.05);
  assert.ok(Math.abs(rotation_rad(turn)[2] - Math.PI / 9 + 0.05) < 1e-12, "and comes back at once");
});
