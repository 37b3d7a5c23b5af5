// SPDX-License-Identifier: Apache-2.0
// hand_control.ts - the mouse as the hand of a simulated device: drag moves it in the picture's
// plane, the wheel or two fingers into the picture, Ctrl and drag turn the tool, G closes the grip; or keys (key_moves.ts).
// Only a request is sent; forces stay in tactd.
// The request is repeated until a few seconds after the last move, or as long as the mode is on.

import * as THREE from "three";
import type { Stage } from "../scene/stage";
import type { Frame, Vec } from "../link/protocol";
import { rotation_rad, turned_on } from "./tool_turn";

const kMinGap_ms = 1000 / 60;
const kWheel_m = 0.00002; // per wheel unit: a notch of 100 is 2 mm
const kTurn_rad = 0.004; // per pixel
const kRepeat_ms = 250; // tactd forgets a target after a second
const kForget_ms = 4000; // after the last move the hand goes back to its script

export class HandControl {
  /** Where the hand shall go; null while the mouse has nothing to say. */
  target: THREE.Vector3 | null = null;
  mode = false; // the mouse moves the hand without Shift
  private grip_ratio = 0;
  private turn = new THREE.Quaternion(); // of the tool against its rest
  private tool_m: Vec | null = null;
  private readonly fingers = new Map<number, [number, number]>(); // or the mouse; where they are, px
  private turns = false; // what a drag does, from its begin to its end
  private sent_ms = -Infinity;
  private touched_ms = -Infinity;
  private waiting = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly allowed: () => boolean,
    private readonly send: (position_m: Vec, rotation_rad: Vec, grip_ratio: number) => void,
  ) {
    // Before the orbit controls, which listen on the same canvas.
    const first = { capture: true };
    canvas.addEventListener("pointerdown", (event) => this.begin(event), first);
    canvas.addEventListener("pointermove", (event) => this.drag(event), first);
    canvas.addEventListener("pointerup", (event) => this.end(event), first);
    canvas.addEventListener("pointercancel", (event) => this.end(event), first);
    canvas.addEventListener("wheel", (event) => this.wheel(event), { capture: true, passive: false });
  }

  /** The tool is where the next move starts. */
  frame(frame: Frame, now_ms: number): void {
    this.tool_m = frame.tool_position_m;
    if (!this.target) {
      this.grip_ratio = frame.grip_ratio ?? 0;
      const [w, x, y, z] = frame.tool_orientation;
      this.turn.set(x, y, z, w).normalize();
    }
    const holds = this.mode || this.fingers.size > 0 || now_ms - this.touched_ms < kForget_ms;
    if (!holds || !this.allowed()) this.target = null;
    else if (now_ms - this.sent_ms > kRepeat_ms) this.send_now();
  }

  toggle_grip(): void {
    this.grip(this.grip_ratio > 0.5 ? 0 : 1);
  }

  /** 0 open, 1 closed. */
  grip(ratio: number): void {
    if (!this.allowed()) return;
    this.grip_ratio = ratio;
    this.move(new THREE.Vector3());
  }

  /** To the right, up and into the picture. False when there is no hand to move. */
  step([right_m, up_m, into_m]: Vec): boolean {
    if (!this.allowed() || !this.tool_m) return false;
    const camera = this.stage.camera;
    const by_m = camera.getWorldDirection(new THREE.Vector3()).multiplyScalar(into_m);
    by_m.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0), right_m);
    this.move(by_m.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1), up_m));
    return true;
  }

  /** About the tool's own axis. */
  twist(by_rad: number): void {
    if (this.allowed()) this.turn_on(new THREE.Vector3(0, 0, 1).applyQuaternion(this.turn), by_rad);
  }

  private turn_on(axis: THREE.Vector3, by_rad: number): void {
    this.turn = turned_on(this.turn, axis, by_rad);
    this.move(new THREE.Vector3());
  }

  private wanted(event: MouseEvent): boolean {
    return this.allowed() && (this.mode || event.shiftKey);
  }

  private begin(event: PointerEvent): void {
    if (event.button !== 0 || !(this.wanted(event) || (event.ctrlKey && this.allowed()))) return;
    event.stopImmediatePropagation();
    this.canvas.setPointerCapture(event.pointerId);
    if (this.fingers.size === 0) this.turns = event.ctrlKey;
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  private drag(event: PointerEvent): void {
    const from = this.fingers.get(event.pointerId);
    if (!from) return;
    event.stopImmediatePropagation();
    const right_px = event.clientX - from[0];
    const up_px = from[1] - event.clientY;
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const camera = this.stage.camera;
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    if (this.turns) {
      // As a ball under the mouse would turn: what is nearest follows it.
      const axis = up.multiplyScalar(right_px).addScaledVector(right, -up_px);
      return this.turn_on(axis.normalize(), kTurn_rad * Math.hypot(right_px, up_px));
    }
    const at = this.target ?? (this.tool_m ? new THREE.Vector3(...this.tool_m) : null);
    if (!at) return;
    // One pixel at the tool's distance: 2 d tan(fov / 2) / height
    const distance_m = at.clone().sub(camera.position).dot(camera.getWorldDirection(new THREE.Vector3()));
    const per_pixel_m = (2 * distance_m * Math.tan((camera.fov * Math.PI) / 360)) / this.canvas.clientHeight;
    if (this.fingers.size > 1) {
      // each of them checks its half
      const into = camera.getWorldDirection(new THREE.Vector3());
      return this.move(into.multiplyScalar((up_px * per_pixel_m) / this.fingers.size));
    }
    this.move(right.multiplyScalar(right_px * per_pixel_m).addScaledVector(up, up_px * per_pixel_m));
  }

  private end(event: PointerEvent): void {
    if (!this.fingers.delete(event.pointerId)) return;
    event.stopImmediatePropagation();
  }

  private wheel(event: WheelEvent): void {
    if (!this.wanted(event)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const turn = event.deltaY !== 0 ? event.deltaY : event.deltaX; // Shift turns the wheel sideways
    const into = this.stage.camera.getWorldDirection(new THREE.Vector3());
    this.move(into.multiplyScalar(-turn * kWheel_m));
  }

  private move(by_m: THREE.Vector3): void {
    if (!this.tool_m) return;
    this.target ??= new THREE.Vector3(...this.tool_m);
    this.target.add(by_m);
    this.touched_ms = performance.now();
    if (this.waiting) return; // the send that waits will take the newest target
    const wait_ms = Math.max(0, this.sent_ms + kMinGap_ms - this.touched_ms);
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      this.send_now();
    }, wait_ms);
  }

  private send_now(): void {
    if (!this.target) return;
    this.sent_ms = performance.now();
    this.send(this.target.toArray() as Vec, rotation_rad(this.turn), this.grip_ratio);
  }
}
