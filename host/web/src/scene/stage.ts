// SPDX-License-Identifier: Apache-2.0
// stage.ts - light, ground, camera and the drawing loop. W as everywhere: +x towards the operator,
// +y to the right, +z up; the camera starts on the operator's side, a little above.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { follow_share, type Eyes, type WornHead } from "./eyes";
import { make_ground } from "./ground";
import { kHeadsetAxes } from "./headset_axes";
import { kSteel, look_material, paint } from "./look";
import { snapshot } from "./snapshot";
import type { Vec } from "../link/protocol";

const kSlow_fps = 40; // below this the picture gets coarser, because smooth matters more than sharp
const kCoarsest = 0.6;
const kSight_deg = 32;
const kHome_aspect = 0.95; // in a narrower picture the first view is from farther off, and shows the same
const kNarrow_aspect = 1.2; // of a phone
const kInside_ratio = 0.8; // of the way from the middle of the picture to its edge
const kStepBack_ratio = 1.04;
const kMaxStepsBack = 60; // to ten times the distance
const kTurnSteps = 12; // halvings of the way from the gaze to the tool
const kPole_rad = 0.02; // as near as the view comes to straight down
const kEyes_deg = 48; // a person sees more at once
const kEyes_s = 0.15; // in which the eyes' camera goes two thirds of the way to the head

/** True where a processor draws instead of a graphics card; null where nothing draws in three dimensions. */
function draws_in_software(): boolean | null {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return null;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

/** What becomes of the picture. */
export interface StageEvents {
  draw(now_ms: number): void; // once per picture, also where there is none
  drawn(): void;
  /** There is no picture, and why; empty: there is one again. */
  missing(words: string, remedy: string): void;
}

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(kSight_deg, 1, 0.01, 12);
  readonly controls: OrbitControls;

  readonly steel: THREE.Texture;
  fps = 0;
  /** Null: this browser draws nothing in three dimensions, and the page shows numbers alone. */
  readonly renderer: THREE.WebGLRenderer | null;
  /** In a headset: the camera of its wearer's eyes. The desk's own stays as it is meanwhile. */
  wearer: THREE.PerspectiveCamera | null = null;
  private home = new THREE.Sphere(new THREE.Vector3(), 0.1);
  private ground: THREE.Object3D | null = null;
  private with_operator = false;
  private kept_m: Vec | null = null;
  private at_home = true; // the view was not turned yet
  private eyes: Eyes | null = null;
  private readonly looks_at = new THREE.Vector3();
  private drawn_ms = 0;
  private readonly adapts: boolean;
  private sharpness = Math.min(window.devicePixelRatio, 2);
  private frames = 0;
  private counted_since_ms = performance.now();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly events: StageEvents,
  ) {
    // #sharp in the address is for still pictures: full quality at any cost.
    const sharp = location.hash.slice(1).split("&").includes("sharp");
    const software = draws_in_software();
    this.adapts = !sharp;
    if (software && !sharp) this.sharpness = 0.8;
    this.steel = paint(kSteel);
    this.renderer = software === null ? null : this.open_renderer(sharp || !software);
    this.add_lights();
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.addEventListener("start", () => (this.at_home = false));
    this.controls.minDistance = 0.04;
    this.controls.maxDistance = 4;
    this.go_home();
    this.resize();
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  /** Pictures from now on. */
  start(): void {
    if (this.renderer) return this.renderer.setAnimationLoop((now_ms) => this.next_picture(now_ms));
    this.events.missing("no 3D picture: this browser has no WebGL 2", "switch on its hardware acceleration, or take another");
    const next = (now_ms: number): void => {
      requestAnimationFrame(next);
      this.next_picture(now_ms);
    };
    requestAnimationFrame(next);
  }

  private open_renderer(antialias: boolean): THREE.WebGLRenderer | null {
    const { canvas } = this;
    let renderer: THREE.WebGLRenderer;
    try {
      // alpha: the page's own gradient is the background
      renderer = new THREE.WebGLRenderer({ canvas, alpha: true, antialias, powerPreference: "high-performance" });
    } catch {
      return null;
    }
    canvas.addEventListener("webglcontextlost", () =>
      this.events.missing("no 3D picture: the browser took the graphics away", "it comes back, or reload the page"),
    );
    canvas.addEventListener("webglcontextrestored", () => this.events.missing("", ""));
    // Compiled while the scene is on its way; kept, for else the program goes with it.
    const warm = new THREE.Mesh(new THREE.BufferGeometry(), look_material(this.steel));
    renderer.compile(warm, this.camera);
    this.scene.userData.warm = warm;
    return renderer;
  }

  private next_picture(now_ms: number): void {
    this.events.draw(now_ms);
    if (this.eyes) this.see_with(this.eyes, follow_share((now_ms - this.drawn_ms) / 1000, kEyes_s));
    else if (!this.wearer) this.controls.update();
    this.drawn_ms = now_ms;
    this.count(now_ms);
    if (!this.renderer || this.renderer.getContext().isContextLost()) return;
    this.renderer.render(this.scene, this.wearer ?? this.camera);
    this.events.drawn();
  }

  /** Puts an organ in the middle of the picture. */
  set_home(bounds: THREE.Sphere, floor_m: number): void {
    this.home = bounds.clone();
    if (this.ground) this.scene.remove(this.ground);
    this.ground = make_ground(bounds.radius);
    this.ground.position.set(bounds.center.x, bounds.center.y, floor_m);
    this.scene.add(this.ground);
    this.go_home();
  }

  /** The first view shows the tissue; with the operator, the tissue and the body above it. */
  set_operator(shown: boolean): void {
    this.with_operator = shown;
    this.go_home();
  }

  /** Draws for a headset from now on; null: on the desk again. */
  wear(camera: THREE.PerspectiveCamera | null): void {
    this.wearer = camera;
    this.free_controls();
    this.resize();
  }

  /** Where the head of a headset's wearer is, of the last picture; null without a headset. */
  get worn_head(): WornHead | null {
    if (!this.wearer) return null;
    const { x, y, z, w } = this.wearer.getWorldQuaternion(new THREE.Quaternion()).multiply(kHeadsetAxes.clone().invert());
    return { at_m: this.wearer.getWorldPosition(new THREE.Vector3()).toArray(), turn: [w, x, y, z] };
  }

  /** What is drawn now, with these lines under it; null while that is in a headset. */
  async picture(lines: readonly string[]): Promise<Blob | null> {
    if (this.wearer || !this.renderer) return null;
    this.renderer.render(this.scene, this.camera); // the browser forgets what it has shown
    return snapshot(this.renderer.domElement, lines);
  }

  go_home(): void {
    const r = this.home.radius;
    const farther = Math.max(1, kHome_aspect / this.camera.aspect);
    this.at_home = true;
    if (this.eyes) return; // they have the camera
    if (this.with_operator) {
      this.controls.target.copy(this.home.center).add(new THREE.Vector3(0.17, 0.0, 0.235));
      this.camera.position.copy(this.controls.target).add(new THREE.Vector3(-1.42, 0.95, 0.42));
    } else {
      this.controls.target.copy(this.home.center).add(new THREE.Vector3(0, 0, 0.22 * r));
      this.camera.position.copy(this.home.center).add(new THREE.Vector3(3.4 * r, 1.5 * r, 2.2 * r));
    }
    this.camera.position.sub(this.controls.target).multiplyScalar(farther).add(this.controls.target);
    this.controls.update();
    this.keep_in_view(this.kept_m);
  }

  /** In the first view of a narrow picture: goes so far off that this place is in it. */
  keep_in_view(place_m: Vec | null): void {
    this.kept_m = place_m;
    if (!place_m || !this.at_home || this.eyes || this.wearer || this.camera.aspect > kNarrow_aspect) return;
    const { position } = this.camera;
    for (let i = 0; i < kMaxStepsBack && !this.is_inside(place_m); ++i) {
      position.sub(this.controls.target).multiplyScalar(kStepBack_ratio).add(this.controls.target);
    }
  }

  private is_inside(place_m: Vec): boolean {
    this.camera.updateMatrixWorld();
    const { x, y, z } = new THREE.Vector3(...place_m).project(this.camera);
    return z < 1 && Math.max(Math.abs(x), Math.abs(y)) < kInside_ratio;
  }

  /** As a drag to the right and up, and so many times the distance. False while the view is not the desk's own. */
  turn(right_rad: number, up_rad: number, distance_ratio: number): boolean {
    if (!this.controls.enabled) return false;
    const from = this.camera.position.clone().sub(this.controls.target);
    const r = from.length();
    const azimuth_rad = Math.atan2(from.y, from.x) - right_rad;
    const polar_rad = Math.min(Math.max(Math.acos(from.z / r) + up_rad, kPole_rad), Math.PI - kPole_rad);
    const across = Math.sin(polar_rad);
    from.set(across * Math.cos(azimuth_rad), across * Math.sin(azimuth_rad), Math.cos(polar_rad));
    this.at_home = false;
    this.camera.position.copy(this.controls.target).addScaledVector(from, r * distance_ratio);
    this.controls.update();
    return true;
  }

  /** The camera where the operator's eyes are; null gives it back to the mouse. */
  look_through(eyes: Eyes | null): void {
    const begins = eyes !== null && this.eyes === null;
    const ends = eyes === null && this.eyes !== null;
    this.eyes = eyes;
    this.free_controls();
    if (begins || ends) {
      this.camera.fov = eyes ? kEyes_deg : kSight_deg;
      this.camera.updateProjectionMatrix();
    }
    if (begins && eyes) this.see_with(eyes, 1);
    if (ends) this.go_home();
  }

  private free_controls(): void {
    this.controls.enabled = this.eyes === null && this.wearer === null;
  }

  private see_with(eyes: Eyes, share: number): void {
    this.camera.position.lerp(new THREE.Vector3(...eyes.at_m), share);
    this.looks_at.lerp(new THREE.Vector3(...eyes.towards), share);
    this.look_along(this.looks_at);
    if (this.kept_m && this.camera.aspect <= kNarrow_aspect && !this.is_inside(this.kept_m)) this.turn_to(this.kept_m);
  }

  private look_along(direction: THREE.Vector3): void {
    this.camera.lookAt(this.camera.position.clone().add(direction));
  }

  /** From where the eyes look, by the least turn after which this place is in the picture. */
  private turn_to(place_m: Vec): void {
    const to_place = new THREE.Vector3(...place_m).sub(this.camera.position).normalize();
    const gaze = this.looks_at.clone().normalize();
    let [outside, inside] = [0, 1];
    for (let i = 0; i < kTurnSteps; ++i) {
      const half = 0.5 * (outside + inside);
      this.look_along(gaze.clone().lerp(to_place, half));
      if (this.is_inside(place_m)) inside = half;
      else outside = half;
    }
    this.look_along(gaze.lerp(to_place, inside));
  }

  /** For the force arrow; tissue and steel bring their light along. */
  private add_lights(): void {
    const key = new THREE.DirectionalLight("#fff1e3", 2.2);
    key.position.set(0.5, 0.7, 1.1);
    this.scene.add(key, new THREE.HemisphereLight("#c4d6ea", "#3a1c18", 1.2));
  }

  private resize(): void {
    if (this.wearer) return; // the headset has its own size
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer?.setPixelRatio(this.sharpness);
    this.renderer?.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    if (this.at_home && !this.eyes) this.go_home();
    this.renderer?.render(this.scene, this.camera); // a resized canvas is empty
  }

  private count(now_ms: number): void {
    ++this.frames;
    const elapsed_ms = now_ms - this.counted_since_ms;
    if (elapsed_ms < 1000) return;
    this.fps = (this.frames * 1000) / elapsed_ms;
    this.frames = 0;
    this.counted_since_ms = now_ms;
    const hidden = elapsed_ms > 3000; // a page in the background is not slow
    if (this.adapts && this.fps < kSlow_fps && !hidden && !this.wearer && this.sharpness > kCoarsest) {
      this.sharpness = Math.max(kCoarsest, this.sharpness * 0.85);
      this.resize();
    }
  }
}
