// SPDX-License-Identifier: Apache-2.0
// wound.ts - what one sees where the surface was cut away: the same triangles, a little deeper and raw.

import * as THREE from "three";

const kDepth_m = 0.0012;

export class Wound {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private corners: Uint32Array = new Uint32Array(0);

  constructor(private readonly triangle: Uint32Array) {
    const material = new THREE.MeshBasicMaterial({ color: "#4a0508", side: THREE.DoubleSide });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  /** These triangles are open now. */
  open(cut: ReadonlySet<number>): void {
    this.corners = new Uint32Array(3 * cut.size);
    let at = 0;
    for (const t of cut) for (let k = 0; k < 3; ++k) this.corners[at++] = this.triangle[3 * t + k];
    const position = new THREE.BufferAttribute(new Float32Array(3 * this.corners.length), 3);
    position.setUsage(THREE.DynamicDrawUsage);
    this.object.geometry.setAttribute("position", position);
    this.object.visible = cut.size > 0;
  }

  /** Follows the cut edges: vertices and normals of the surface as it is now. */
  follow(vertex_m: Float32Array, normal: Float32Array): void {
    if (!this.object.visible) return;
    const position = this.object.geometry.getAttribute("position") as THREE.BufferAttribute;
    const out_m = position.array as Float32Array;
    for (let i = 0; i < this.corners.length; ++i) {
      const v = 3 * this.corners[i];
      for (let k = 0; k < 3; ++k) out_m[3 * i + k] = vertex_m[v + k] - kDepth_m * normal[v + k];
    }
    position.needsUpdate = true;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
