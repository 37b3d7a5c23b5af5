// SPDX-License-Identifier: Apache-2.0
// organ_view.ts - what is touched. Tissue is warm, moist and paler where it is stretched; what a scene's [look] says else
// is in material.ts.

import * as THREE from "three";
import { Deformer, type Deformed } from "./deform";
import { look_material, paint } from "../scene/look";
import { organ_material, piece_tints, vertex_tints, type Material } from "../scene/material";
import type { Target } from "../scene/outside";
import { Cuts, decode_moved } from "./patch";
import { balls_of, kContactInside, type Frame, type Mesh, type Scene, type Sphere, type Vec } from "../link/protocol";
import { Wound } from "./wound";

// Factors on the baked colour of the tissue (look.ts).
const kFlesh = new THREE.Color(1.06, 1.06, 1.06);
const kDark = new THREE.Color(0.8, 0.76, 0.78);
const kPale = new THREE.Color(1.16, 1.45, 1.4);
const kPale_m = 0.012; // displacement at which the tissue looks fully pale

const kAbove_m = 0.03; // whence a sphere's depth is looked at
const kLeastPress_m = 0.001;

/** Smooth, repeatable unevenness of colour, -1 .. 1; a few waves are enough for an organ. */
function mottle(x_m: number, y_m: number, z_m: number): number {
  return (
    Math.sin(x_m * 160 + 3 * Math.sin(y_m * 90)) *
    Math.sin(y_m * 190 + 2 * Math.sin(z_m * 120)) *
    Math.cos(z_m * 140 + 2 * Math.sin(x_m * 110))
  );
}

export class OrganView {
  readonly object: THREE.Mesh;
  readonly deformed: Deformed = { moved: 0, most_m: 0 };
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material: THREE.ShaderMaterial;
  private readonly lines: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly deformer: Deformer;
  private readonly rest_tint: Float32Array;
  private readonly made_of: Material;
  private readonly picture: THREE.Texture;
  private readonly cuts = new Cuts();
  private readonly wound: Wound;
  private readonly spheres: readonly Sphere[];

  constructor(
    private readonly mesh: Mesh,
    scene: Scene,
  ) {
    this.spheres = scene.spheres;
    this.made_of = organ_material(scene, mesh);
    this.picture = paint(this.made_of.look);
    const position = new THREE.BufferAttribute(mesh.vertex_m.slice(), 3);
    position.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("position", position);
    this.geometry.setIndex(new THREE.BufferAttribute(mesh.triangle.slice(), 1));
    this.geometry.computeVertexNormals();
    this.geometry.computeBoundingSphere();
    this.rest_tint = mesh.color
      ? vertex_tints(mesh.color)
      : this.made_of.mottled > 0
        ? OrganView.tints(mesh, this.made_of.mottled)
        : piece_tints(mesh, scene.piece_color_ratio);
    const tint = new THREE.BufferAttribute(this.rest_tint.slice(), 3);
    tint.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("tint", tint);
    this.material = look_material(this.picture);
    this.object = new THREE.Mesh(this.geometry, this.material);
    this.lines = new THREE.Mesh(this.geometry, OrganView.line_material());
    this.lines.visible = false;
    this.lines.frustumCulled = false;
    this.wound = new Wound(mesh.triangle, mesh.vertex_m, this.material);
    this.object.add(this.lines, this.wound.object);
    this.object.frustumCulled = false; // its bounds move; it is nearly always in view
    const rest_normal = (this.geometry.getAttribute("normal").array as Float32Array).slice();
    this.deformer = new Deformer(mesh.vertex_m, rest_normal, scene.profile_points, scene.profile_pitch_m, mesh.triangle);
  }

  get vertex_count(): number {
    return this.geometry.getAttribute("position").count;
  }

  /** Middle and radius of the undeformed organ. */
  get bounds(): THREE.Sphere {
    return this.geometry.boundingSphere ?? new THREE.Sphere(new THREE.Vector3(), 0.1);
  }

  /** Lowest z of the undeformed organ. */
  get floor_m(): number {
    const { vertex_m } = this.mesh;
    let floor_m = Infinity;
    for (let i = 2; i < vertex_m.length; i += 3) floor_m = Math.min(floor_m, vertex_m[i]);
    return floor_m;
  }

  get target(): Target {
    return { at_m: this.bounds.center, radius_m: 0.5 * this.bounds.radius };
  }

  /** Its corners as it is drawn now: least, most. */
  get drawn_m(): [Vec, Vec] {
    const box = new THREE.Box3().setFromBufferAttribute(this.geometry.getAttribute("position") as THREE.BufferAttribute);
    box.applyMatrix4(this.object.matrixWorld);
    return [box.min.toArray(), box.max.toArray()];
  }

  /** Of each sphere that presses in this frame: depth of the drawn surface along the normal through it, by its own. */
  drawn_ratios(frame: Frame): number[] {
    const balls = balls_of(frame, this.spheres);
    return frame.contacts.flatMap(({ contact, state, depth_m, normal }) => {
      if (state === kContactInside || depth_m < kLeastPress_m) return [];
      const outward = new THREE.Vector3(...normal).normalize();
      const lowest_m = new THREE.Vector3(...balls[contact].centre_m).addScaledVector(outward, -balls[contact].radius_m);
      const from_m = lowest_m.addScaledVector(outward, kAbove_m);
      const [hit] = new THREE.Raycaster(from_m, outward.negate()).intersectObject(this.object, false);
      return hit ? [1 - (kAbove_m - hit.distance) / depth_m] : [];
    });
  }

  set wireframe(on: boolean) {
    this.lines.visible = on;
  }

  get cut_triangles(): number {
    return this.cuts.triangles.size;
  }

  /** How far the two sides of a cut are apart, m. */
  get cut_gap_m(): number {
    return this.wound.gap_m;
  }

  show(frame: Frame): void {
    const { contacts, patch } = frame;
    if (patch && this.cuts.learn(patch)) this.open();
    const position = this.geometry.getAttribute("position") as THREE.BufferAttribute;
    const vertex_m = position.array as Float32Array;
    const moved = patch ? decode_moved(patch) : null;
    const tool = { balls: balls_of(frame, this.spheres), cut: this.cuts.triangles };
    if (!this.deformer.apply(contacts, moved, vertex_m, this.deformed, tool)) return;
    position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    const tint = this.geometry.getAttribute("tint") as THREE.BufferAttribute;
    if (this.made_of.alive) {
      this.pale(tint.array as Float32Array);
      tint.needsUpdate = true;
    }
    this.wound.follow(vertex_m, this.geometry.getAttribute("normal").array as Float32Array, tint.array as Float32Array);
  }

  /** Cut triangles are no longer surface: their corners fall together, and their pieces are the wound's. */
  private open(): void {
    const index = this.geometry.getIndex() as THREE.BufferAttribute;
    const corner = index.array as Uint32Array;
    corner.set(this.mesh.triangle);
    for (const t of this.cuts.triangles) corner.fill(corner[3 * t], 3 * t, 3 * t + 3);
    index.needsUpdate = true;
    this.wound.open(this.cuts.triangles);
  }

  dispose(): void {
    this.wound.dispose();
    this.geometry.dispose();
    this.material.dispose();
    this.picture.dispose();
    this.lines.material.dispose();
  }

  /** Stretched tissue lets its blood go: it turns paler. */
  private pale(tint: Float32Array): void {
    tint.set(this.rest_tint);
    const travel_m = this.deformer.travel_m;
    for (let v = 0; v < travel_m.length; ++v) {
      const stretch = Math.min(1, travel_m[v] / kPale_m);
      const share = stretch * stretch;
      if (share <= 0) continue;
      tint[3 * v] += share * (kPale.r - tint[3 * v]);
      tint[3 * v + 1] += share * (kPale.g - tint[3 * v + 1]);
      tint[3 * v + 2] += share * (kPale.b - tint[3 * v + 2]);
    }
  }

  private static line_material(): THREE.MeshBasicMaterial {
    return new THREE.MeshBasicMaterial({ color: "#ffd9cc", wireframe: true, transparent: true, opacity: 0.35 });
  }

  private static tints(mesh: Mesh, mottled: number): Float32Array {
    const out = new Float32Array(mesh.vertex_m.length);
    const color = new THREE.Color();
    for (let i = 0; i < out.length; i += 3) {
      const share = mottle(mesh.vertex_m[i], mesh.vertex_m[i + 1], mesh.vertex_m[i + 2]);
      color.lerpColors(kFlesh, kDark, 0.5 * mottled * (1 + share)).toArray(out, i);
    }
    return out;
  }
}
