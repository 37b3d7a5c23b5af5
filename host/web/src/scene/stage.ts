// SPDX-License-Identifier: Apache-2.0
// stage.ts - light, ground, camera and the drawing loop. W as everywhere: +x towards the operator,
// +y to the right, +z up; the camera starts on the operator's side, a little above.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { follow_share, type Eyes } from "./eyes";
import { make_ground } from "./ground";
import { kSteel, look_material, paint } from "./look";
import { snapshot } from "./snapshot";

const kSlow_fps = 40; // below this the picture gets coarser, because smooth matters more than sharp
const kCoarsest = 0.6;
const kSight_deg = 32;
const kHome_aspect = 0.95; // in a narrower picture the first view is from farther off, and shows the same
const kEyes_deg = 48; // a person sees more at once
const kEyes_s = 0.15; // in which the eyes' camera goes two thirds of the way to the head

/** True where a processor draws instead of a graphics card. */
function draws_in_software(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(kSight_deg, 1, 0.01, 12);
  readonly controls: OrbitControls;

  readonly steel: THREE.Texture;
  fps = 0;
  readonly renderer: THREE.WebGLRenderer;
  /** In a headset: the camera of its wearer's eyes. The desk's own stays as it is meanwhile. */
  wearer: THREE.PerspectiveCamera | null = null;
  private home = new THREE.Sphere(new THREE.Vector3(), 0.1);
  private ground: THREE.Object3D | null = null;
  private with_operator = false;
  private at_home = true; // the view was not turned yet
  private eyes: Eyes | null = null;
  private readonly looks_at = new THREE.Vector3();
  private drawn_ms = 0;
  private readonly adapts: boolean;
  private sharpness = Math.min(window.devicePixelRatio, 2);
  private frames = 0;
  private counted_since_ms = performance.now();

  constructor(canvas: HTMLCanvasElement, draw: (now_ms: number) => void) {
    // #sharp in the address is for still pictures: full quality at any cost.
    const sharp = location.hash.slice(1).split("&").includes("sharp");
    const software = draws_in_software();
    this.adapts = !sharp;
    if (software && !sharp) this.sharpness = 0.8;
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      alpha: true, // the page's own gradient is the background
      antialias: sharp || !software,
      powerPreference: "high-performance",
    });
    this.steel = paint(kSteel);
    // Compiled while the scene is on its way; kept, for else the program goes with it.
    const warm = new THREE.Mesh(new THREE.BufferGeometry(), look_material(this.steel));
    this.renderer.compile(warm, this.camera);
    this.scene.userData.warm = warm;
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
    this.renderer.setAnimationLoop((now_ms) => {
      draw(now_ms);
      if (this.eyes) this.see_with(this.eyes, follow_share((now_ms - this.drawn_ms) / 1000, kEyes_s));
      else if (!this.wearer) this.controls.update();
      this.drawn_ms = now_ms;
      this.renderer.render(this.scene, this.wearer ?? this.camera);
      this.count(now_ms);
    });
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

  /** What is drawn now, with these lines under it; null while that is in a headset. */
  async picture(lines: readonly string[]): Promise<Blob | null> {
    if (this.wearer) return null;
    this.renderer.render(this.scene, this.camera); // the browser forgets what it has shown
    return snapshot(this.renderer.domElement, lines);
  }

  go_home(): void {
    const r = this.home.radius;
    const farther = Math.max(1, kHome_aspect / this.camera.aspect);
    this.at_home = true;
    if (this.with_operator) {
      this.controls.target.copy(this.home.center).add(new THREE.Vector3(0.17, 0.0, 0.235));
      this.camera.position.copy(this.controls.target).add(new THREE.Vector3(-1.42, 0.95, 0.42));
    } else {
      this.controls.target.copy(this.home.center).add(new THREE.Vector3(0, 0, 0.22 * r));
      this.camera.position.copy(this.home.center).add(new THREE.Vector3(3.4 * r, 1.5 * r, 2.2 * r));
    }
    this.camera.position.sub(this.controls.target).multiplyScalar(farther).add(this.controls.target);
    this.controls.update();
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
    this.camera.lookAt(this.camera.position.clone().add(this.looks_at));
  }

  /** For the force arrow; tissue and steel bring their light along. */
  private add_lights(): void {
    const key = new THREE.DirectionalLight("#fff1e3", 2.2);
    key.position.set(0.5, 0.7, 1.1);
    this.scene.add(key, new THREE.HemisphereLight("#c4d6ea", "#3a1c18", 1.2));
  }

  private resize(): void {
    if (this.wearer) return; // the headset has its own size
    this.renderer.setPixelRatio(this.sharpness);
    const { clientWidth, clientHeight } = this.renderer.domElement;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    if (this.at_home && !this.eyes) this.go_home();
    this.renderer.render(this.scene, this.camera); // a resized canvas is empty
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
