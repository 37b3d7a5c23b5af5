// SPDX-License-Identifier: Apache-2.0
// headset_axes.ts - a headset's axes in W as a session begins: x to the right, y up, z backwards.

import * as THREE from "three";

export const kHeadsetBasis = new THREE.Matrix4().makeBasis(
  new THREE.Vector3(0, 1, 0),
  new THREE.Vector3(0, 0, 1),
  new THREE.Vector3(1, 0, 0),
);
export const kHeadsetAxes = new THREE.Quaternion().setFromRotationMatrix(kHeadsetBasis);
