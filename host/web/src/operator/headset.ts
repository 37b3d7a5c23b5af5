// SPDX-License-Identifier: Apache-2.0
// headset.ts - the scene in a headset (WebXR): its wearer's eyes are the camera, and a metre is a metre. Fetched after
// the first picture. It asks for no controller and no hand, and sends nothing: a headset looks on.

import * as THREE from "three";
import { HeadsetPanel } from "./headset_panel";
import { by_id } from "../document/dom";
import type { Said } from "../panels/hud";
import { kHeadsetBasis } from "../scene/headset_axes";
import type { Stage } from "../scene/stage";
import type { Vec } from "../link/protocol";

// Where the eyes are when a session begins and no figure is shown, from the middle of the device's workspace. That is 0.57 m away and 38 deg
// below the horizon: where hands work, with bent elbows, and not nearer than a headset's lenses bear for long. From
// the eyes and not from the floor (`local`), so that it is right seated and standing, and the headset's
// own recentring brings the scene before the wearer again.
const kBack_m = 0.45;
const kUp_m = 0.35;
const kDark = new THREE.Color("#131920");
const kAlarm = new THREE.Color("#4a1512"); // behind everything: seen wherever the wearer looks
const kNoFrame_ms = 250; // a headset that lies on the desk asks for no pictures: then the page on the desk updates by itself
const kMessage_ms = 8000;

function words_of(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

export class Headset {
  private readonly camera: THREE.PerspectiveCamera;
  private readonly place = new THREE.Group(); // of the headset's axes in W
  private readonly panel = new HeadsetPanel(new THREE.Vector3(kBack_m, 0, kUp_m));
  private readonly background = kDark.clone();
  private drawn_ms = 0;
  private watch = 0;
  private busy = false;
  private offered = false;

  /** `draw` is the page's picture, as the stage calls it; `figure_eyes_m`: where a session begins, if a figure is shown. */
  constructor(
    private readonly stage: Stage,
    private readonly renderer: THREE.WebGLRenderer,
    private readonly draw: (now_ms: number) => void,
    private readonly figure_eyes_m: () => Vec | null,
  ) {
    this.camera = new THREE.PerspectiveCamera(90, 1, 0.02, 12); // the session says its angles
    this.place.matrix.copy(kHeadsetBasis);
    this.place.matrixAutoUpdate = false;
    this.place.add(this.camera);
    renderer.xr.setReferenceSpaceType("local");
    renderer.xr.addEventListener("sessionstart", () => this.begin());
    renderer.xr.addEventListener("sessionend", () => this.end());
    navigator.xr?.addEventListener("devicechange", () => void this.offer());
  }

  get on(): boolean {
    return this.stage.wearer !== null;
  }

  /** What cannot be done is not offered. */
  async offer(): Promise<void> {
    this.offered = (await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false)) === true;
    document.body.classList.toggle("has_headset", this.offered || this.on);
  }

  async toggle(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    if (this.on) await this.leave();
    else if (this.offered) await this.enter();
    this.busy = false;
  }

  /** Once per picture, after the page's own panels. */
  report(now_ms: number, ask: () => Said): void {
    this.drawn_ms = now_ms;
    if (!this.on) return;
    const said = ask();
    this.panel.show(said);
    this.background.copy(said.alarm ? kAlarm : kDark);
  }

  /** For tests: what the panel says, and each eye's matrices, column by column. */
  get numbers() {
    const { cameras } = this.renderer.xr.getCamera();
    return {
      on: this.on,
      shown: this.panel.shown,
      alarm: this.background.equals(kAlarm),
      panel_m: this.panel.corners_m,
      figure_eyes_m: this.figure_eyes_m(),
      eyes: cameras.map((eye) => ({ projection: eye.projectionMatrix.toArray(), view: eye.matrixWorldInverse.toArray() })),
    };
  }

  private async enter(): Promise<void> {
    const { xr } = this.renderer;
    let session: XRSession | undefined;
    try {
      session = await navigator.xr!.requestSession("immersive-vr");
      xr.enabled = true;
      await xr.setSession(session);
    } catch (error) {
      await session?.end().catch(() => undefined);
      xr.enabled = false;
      this.say(`no picture in the headset: ${words_of(error)}`);
      setTimeout(() => this.on || this.say(""), kMessage_ms);
    }
  }

  /** The headset may be gone already: then its end is reported all the same. */
  private async leave(): Promise<void> {
    await this.renderer.xr
      .getSession()
      ?.end()
      .catch(() => undefined);
  }

  private begin(): void {
    const [x_m, y_m, z_m] = this.figure_eyes_m() ?? [kBack_m, 0, kUp_m];
    this.place.matrix.setPosition(x_m, y_m, z_m);
    this.place.matrixWorldNeedsUpdate = true;
    this.stage.wear(this.camera);
    this.stage.scene.add(this.place, this.panel.object);
    this.stage.scene.background = this.background;
    this.watch = window.setInterval(() => {
      const now_ms = performance.now();
      if (now_ms - this.drawn_ms > kNoFrame_ms) this.draw(now_ms);
    }, 100);
    this.show("Leave VR");
    this.say("the picture is in the headset; the one here is paused");
  }

  private end(): void {
    clearInterval(this.watch);
    this.stage.scene.background = null;
    this.stage.scene.remove(this.place, this.panel.object);
    this.renderer.xr.enabled = false;
    this.stage.wear(null);
    this.show("Enter VR");
    this.say("");
    void this.offer();
  }

  private show(word: string): void {
    by_id("headset_word").textContent = word;
    by_id("headset").setAttribute("aria-pressed", String(this.on));
    by_id("headset").classList.toggle("on", this.on);
    document.body.classList.toggle("in_headset", this.on);
  }

  private say(words: string): void {
    by_id("headset_words").hidden = words === "";
    by_id("headset_words").textContent = words;
  }
}
