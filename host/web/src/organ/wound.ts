// SPDX-License-Identifier: Apache-2.0
// wound.ts - what one sees of a cut: the surface on both sides of it, and two raw walls that meet below.

import * as THREE from "three";
import { kMaxCut, place, split, type Corner, type Pieces } from "./cut_pieces";

const kDepth_m = 0.003; // drawn; how deep a blade has gone is not known
const kMaxSurface = 9 * kMaxCut; // corners: at most three triangles of one
const kMaxWall = 21 * kMaxCut; // at most seven
const kRaw = new THREE.Color("#b3262b"); // at the surface
const kDeep = new THREE.Color("#3a0407");

function buffer(corners: number, names: readonly string[]): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  for (const name of names) {
    const attribute = new THREE.BufferAttribute(new Float32Array(3 * corners), 3);
    attribute.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute(name, attribute);
  }
  geometry.setDrawRange(0, 0);
  return geometry;
}

export class Wound {
  readonly object = new THREE.Group();
  private readonly surface = buffer(kMaxSurface, ["position", "normal", "tint"]);
  private readonly wall = buffer(kMaxWall, ["position", "color"]);
  private readonly raw = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide });
  private pieces: Pieces = { surface: [], wall: [] };

  /** `skin`: the material of the organ. */
  constructor(
    private readonly triangle: Uint32Array,
    private readonly rest_m: Float32Array,
    skin: THREE.Material,
  ) {
    this.object.add(new THREE.Mesh(this.surface, skin), new THREE.Mesh(this.wall, this.raw));
    for (const part of this.object.children) part.frustumCulled = false;
    this.object.visible = false;
  }

  /** These triangles are cut. */
  open(cut: ReadonlySet<number>): void {
    this.pieces = split(this.triangle, this.rest_m, cut);
    this.pieces.surface.length = Math.min(this.pieces.surface.length, kMaxSurface);
    this.pieces.wall.length = Math.min(this.pieces.wall.length, kMaxWall);
    this.surface.setDrawRange(0, this.pieces.surface.length);
    this.wall.setDrawRange(0, this.pieces.wall.length);
    const color = this.wall.getAttribute("color") as THREE.BufferAttribute;
    this.pieces.wall.forEach(({ side }, i) => (side < 0 ? kDeep : kRaw).toArray(color.array, 3 * i));
    color.needsUpdate = true;
    this.object.visible = cut.size > 0;
  }

  /** Vertices, normals and tints of the surface as it is now. */
  follow(vertex_m: Float32Array, normal: Float32Array, tint: Float32Array): void {
    if (!this.object.visible) return;
    const put = (geometry: THREE.BufferGeometry, corners: readonly Corner[]): void => {
      const position = geometry.getAttribute("position") as THREE.BufferAttribute;
      place(corners, this.rest_m, vertex_m, normal, kDepth_m, position.array as Float32Array);
      position.needsUpdate = true;
    };
    put(this.surface, this.pieces.surface);
    put(this.wall, this.pieces.wall);
    for (const [name, from] of [
      ["normal", normal],
      ["tint", tint],
    ] as const) {
      const attribute = this.surface.getAttribute(name) as THREE.BufferAttribute;
      this.pieces.surface.forEach(({ side }, i) => attribute.array.set(from.subarray(3 * side, 3 * side + 3), 3 * i));
      attribute.needsUpdate = true;
    }
  }

  /** How far the two sides of the cut are apart where that is most, m. */
  get gap_m(): number {
    const at = this.wall.getAttribute("position").array;
    const sides = new Map<number, number>(); // the first corner of each cut edge
    let most_m = 0;
    this.pieces.wall.forEach(({ a, b, side }, i) => {
      if (side < 0 || a === b) return;
      const key = a * (this.rest_m.length / 3) + b;
      const other = sides.get(key);
      if (other === undefined) return void sides.set(key, i);
      most_m = Math.max(most_m, Math.hypot(...[0, 1, 2].map((k) => at[3 * i + k] - at[3 * other + k])));
    });
    return most_m;
  }

  dispose(): void {
    this.surface.dispose();
    this.wall.dispose();
    this.raw.dispose();
  }
}
