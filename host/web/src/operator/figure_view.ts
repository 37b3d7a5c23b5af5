// SPDX-License-Identifier: Apache-2.0
// figure_view.ts - the operator: light, plain capsules; the arm that holds the tool in the accent.

import * as THREE from "three";
import { across, hides, joint, outline } from "./figure";
import { kAccent, kFigure, look_material, paint } from "../scene/look";
import type { Capsule, FigureFrame, Skeleton, Vec } from "../link/protocol";

const kSegments = 32;

class Part {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  private length_m = 0;

  constructor(
    readonly capsule: Capsule,
    material: THREE.ShaderMaterial,
  ) {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
  }

  /** From a to b; `side` is across the body, so that the flat way is front to back. */
  place(a: THREE.Vector3, b: THREE.Vector3, side: THREE.Vector3): void {
    const along = b.clone().sub(a);
    const length_m = along.length();
    // Bones keep their length; only what spans two of them is made again.
    if (Math.abs(length_m - this.length_m) > 0.002) this.shape(length_m);
    along.normalize();
    const x = new THREE.Vector3(...across(along.toArray(), side.toArray()));
    const z = x.clone().cross(along).multiplyScalar(this.capsule.depth_ratio);
    this.mesh.matrix.makeBasis(x, along, z).setPosition(a);
  }

  /** Its two ends as they are drawn. */
  get ends_m(): [Vec, Vec] {
    const end = (along_m: number): Vec => new THREE.Vector3(0, along_m, 0).applyMatrix4(this.mesh.matrixWorld).toArray();
    return [end(0), end(this.length_m)];
  }

  private shape(length_m: number): void {
    this.length_m = length_m;
    const { radius_a_m, radius_b_m } = this.capsule;
    const points = outline(length_m, radius_a_m, radius_b_m).map(([x, y]) => new THREE.Vector2(x, y));
    const geometry = new THREE.LatheGeometry(points, kSegments);
    const count = geometry.getAttribute("position").count;
    geometry.setAttribute("tint", new THREE.BufferAttribute(new Float32Array(3 * count).fill(1), 3));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }
}

export class FigureView {
  readonly object = new THREE.Group();
  private readonly parts: Part[];
  private readonly materials: THREE.ShaderMaterial[];
  private readonly textures = [paint(kFigure), paint(kAccent)];

  constructor(private readonly skeleton: Skeleton) {
    this.materials = this.textures.map((texture) => look_material(texture));
    this.parts = skeleton.capsules.map((capsule) => new Part(capsule, this.materials[capsule.holds_tool ? 1 : 0]));
    this.object.add(...this.parts.map((part) => part.mesh));
  }

  show(frame: FigureFrame): void {
    const [left, right] = this.skeleton.sides.map((index) => new THREE.Vector3(...joint(frame, index)));
    const side = right.sub(left).normalize();
    for (const part of this.parts) {
      const { a, b } = part.capsule;
      part.place(new THREE.Vector3(...joint(frame, a)), new THREE.Vector3(...joint(frame, b)), side);
    }
  }

  /** Parts around the camera step aside. */
  clear_view(frame: FigureFrame, eye: Vec): void {
    for (const part of this.parts) {
      const { a, b, radius_a_m, radius_b_m } = part.capsule;
      part.mesh.visible = !hides(eye, joint(frame, a), joint(frame, b), Math.max(radius_a_m, radius_b_m));
    }
  }

  /** Where joints are drawn, by index; null while nothing is. */
  get drawn_m(): Map<number, Vec> | null {
    if (!this.object.visible || !this.object.parent) return null;
    const out = new Map<number, Vec>();
    for (const part of this.parts) {
      const { a, b } = part.capsule;
      const [a_m, b_m] = part.ends_m;
      out.set(a, a_m);
      if (!out.has(b)) out.set(b, b_m);
    }
    return out;
  }

  dispose(): void {
    for (const part of this.parts) part.mesh.geometry.dispose();
    for (const material of this.materials) material.dispose();
    for (const texture of this.textures) texture.dispose();
  }
}
