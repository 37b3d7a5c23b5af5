// SPDX-License-Identifier: Apache-2.0
// tool_view.ts - the instrument, its probe spheres, force and torque on the hand, and the mark of the hand.

import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { look_material, paint } from "./look";
import { kMaterials, tool_material } from "./material";
import type { Target } from "./outside";
import { dot, kContactInside, length_of, type Frame, type Mesh, type Scene, type Sphere, type Vec } from "../link/protocol";

const kTouch = new THREE.Color("#7fd1c7");
const kHeld = new THREE.Color("#f2b04e");
const kInside = new THREE.Color("#c58bff"); // in the organ, without force
const kCalm = new THREE.Color("#7fd1c7");
const kStrong = new THREE.Color("#f2b04e");
const kLimit = new THREE.Color("#ff5d52");
const kTip_m = 0.01; // what is to be seen of a tool that is in the picture
const kArrow_m = 0.08; // length at the force limit

function color_of(share: number, material: THREE.MeshLambertMaterial): void {
  if (share < 0.5) material.color.lerpColors(kCalm, kStrong, 2 * share);
  else material.color.lerpColors(kStrong, kLimit, Math.min(1, 2 * share - 1));
  material.emissive.copy(material.color).multiplyScalar(0.45);
}

/** Unit cylinder and cone along +y, scaled by set(). */
class Arrow {
  readonly object = new THREE.Group();
  private readonly material = new THREE.MeshLambertMaterial();
  private readonly shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 16), this.material);
  private readonly head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 20), this.material);
  private readonly direction = new THREE.Vector3();

  constructor() {
    this.object.add(this.shaft, this.head);
    this.object.visible = false;
  }

  /**
   * At a point along a force; colour and length say its share of the limit. A force into the tissue
   * ends at the point instead of starting there, so that the tissue does not hide it.
   */
  set(at_m: THREE.Vector3, force_N: Vec, share: number, into_tissue: boolean): void {
    this.object.visible = share > 0.002;
    if (!this.object.visible) return;
    // The root makes small forces visible: soft tissue needs a few percent of what a device can do.
    const length_m = kArrow_m * Math.sqrt(Math.min(1, share));
    const head_m = Math.min(0.011, 0.45 * length_m);
    const radius_m = 0.0011;
    this.shaft.scale.set(radius_m, length_m - head_m, radius_m);
    this.shaft.position.y = 0.5 * (length_m - head_m);
    this.head.scale.set(0.0032, head_m, 0.0032);
    this.head.position.y = length_m - 0.5 * head_m;
    this.direction.set(...force_N).normalize();
    this.object.position.copy(at_m).addScaledVector(this.direction, into_tissue ? -length_m : 0);
    this.object.quaternion.setFromUnitVectors(THREE.Object3D.DEFAULT_UP, this.direction);
    color_of(share, this.material);
  }
}

const kArc_m = 0.02; // radius

/** Three quarters of a circle about a torque, with a head that says which way. */
class Arc {
  readonly object = new THREE.Group();
  private readonly material = new THREE.MeshLambertMaterial();

  constructor() {
    const ring = new THREE.Mesh(new THREE.TorusGeometry(kArc_m, 0.0011, 10, 48, 1.5 * Math.PI), this.material);
    const head = new THREE.Mesh(new THREE.ConeGeometry(0.0032, 0.011, 20), this.material);
    // The ring goes anticlockwise about +z from +x to -y; there +x is onwards.
    head.position.set(0, -kArc_m, 0);
    head.rotation.z = -0.5 * Math.PI;
    this.object.add(ring, head);
    this.object.visible = false;
  }

  /** Colour and size say its share of the limit, as of the arrow. */
  set(at_m: THREE.Vector3, torque_Nm: Vec, share: number): void {
    this.object.visible = share > 0.002;
    if (!this.object.visible) return;
    this.object.position.copy(at_m);
    this.object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...torque_Nm).normalize());
    this.object.scale.setScalar(Math.sqrt(Math.min(1, share)));
    color_of(share, this.material);
  }
}

export class ToolView {
  readonly object = new THREE.Group();
  private readonly tool = new THREE.Group();
  private readonly arrow = new Arrow();
  private readonly arc = new Arc();
  private readonly mark: THREE.Mesh; // where the mouse wants the hand to be
  private readonly spheres: THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>[] = [];
  private readonly picture: THREE.Texture | null = null; // of its own

  constructor(
    mesh: Mesh,
    private readonly scene: Scene,
    steel: THREE.Texture,
  ) {
    const made_of = tool_material(scene);
    if (made_of !== kMaterials.get("steel")) this.picture = paint(made_of.look);
    let geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(mesh.vertex_m, 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangle, 1));
    if (made_of.soft) geometry.computeVertexNormals();
    else geometry = toCreasedNormals(geometry, Math.PI / 5);
    const count = geometry.getAttribute("position").count;
    geometry.setAttribute("tint", new THREE.BufferAttribute(new Float32Array(3 * count).fill(1), 3));
    const material = look_material(this.picture ?? steel);
    material.side = THREE.DoubleSide;
    this.tool.add(new THREE.Mesh(geometry, material));
    for (const sphere of scene.spheres) this.add_sphere(sphere.radius_m, sphere.offset_m);
    this.mark = new THREE.Mesh(
      new THREE.SphereGeometry(0.004, 20, 12),
      new THREE.MeshBasicMaterial({ color: "#f2b04e", transparent: true, opacity: 0.45 }),
    );
    this.mark.visible = false;
    this.object.add(this.tool, this.arrow.object, this.arc.object, this.mark);
  }

  show(frame: Frame): void {
    const [w, x, y, z] = frame.tool_orientation;
    this.tool.position.set(...frame.tool_position_m);
    this.tool.quaternion.set(x, y, z, w).normalize();
    this.spheres.forEach((sphere, index) => {
      const contact = frame.contacts.find((candidate) => candidate.contact === index);
      sphere.material.opacity = contact ? 0.42 : 0.16;
      sphere.material.color.copy(contact?.state === 2 ? kHeld : contact?.state === kContactInside ? kInside : kTouch);
    });
    const share = length_of(frame.force_N) / (this.scene.force_limit_N || 1);
    const into_tissue = frame.contacts.some((contact) => dot(contact.normal, frame.force_N) < 0);
    const in_contact = frame.contacts.flatMap((contact) => this.scene.spheres[contact.contact] ?? []);
    const at_m = this.middle_m(in_contact); // where eyes are; the hand may hold the tool outside the picture
    this.arrow.set(at_m, frame.force_N, share, into_tissue);
    const most_Nm = this.scene.torque_limit_Nm;
    this.arc.set(at_m, frame.torque_Nm, most_Nm > 0 ? length_of(frame.torque_Nm) / most_Nm : 0);
  }

  /** Its tip. */
  get target(): Target {
    return { at_m: this.middle_m(this.scene.spheres), radius_m: kTip_m };
  }

  /** Until the next frame. */
  hide_force(): void {
    this.arrow.object.visible = false;
    this.arc.object.visible = false;
  }

  /** Share of the torque's limit that the arc shows; 0: none is drawn. */
  get arc_share(): number {
    return this.arc.object.visible ? this.arc.object.scale.x ** 2 : 0;
  }

  /** A place in the tool's own axes, where it is drawn. */
  drawn_m(place_m: Vec): Vec {
    return new THREE.Vector3(...place_m).applyMatrix4(this.tool.matrixWorld).toArray();
  }

  /** null hides the mark. */
  show_hand_target(position_m: Vec | null): void {
    this.mark.visible = position_m !== null;
    if (position_m) this.mark.position.set(...position_m);
  }

  dispose(): void {
    this.picture?.dispose();
    this.object.traverse((part) => {
      if (!(part instanceof THREE.Mesh)) return;
      (part.geometry as THREE.BufferGeometry).dispose();
      (part.material as THREE.Material).dispose();
    });
  }

  private add_sphere(radius_m: number, offset_m: Vec): void {
    const sphere = new THREE.Mesh(
      new THREE.SphereGeometry(radius_m, 20, 14),
      new THREE.MeshBasicMaterial({ color: kTouch, transparent: true, opacity: 0.16 }),
    );
    sphere.position.set(...offset_m);
    this.spheres.push(sphere);
    this.tool.add(sphere);
  }

  /** Of these spheres; of none, the tool's origin. */
  private middle_m(spheres: Sphere[]): THREE.Vector3 {
    const middle_m = new THREE.Vector3();
    for (const sphere of spheres) middle_m.addScaledVector(new THREE.Vector3(...sphere.offset_m), 1 / spheres.length);
    return middle_m.applyQuaternion(this.tool.quaternion).add(this.tool.position);
  }
}
