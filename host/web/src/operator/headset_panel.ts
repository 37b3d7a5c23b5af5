// SPDX-License-Identifier: Apache-2.0
// headset_panel.ts - who wears a headset does not see the page: state, force and faults on a panel in the scene, in the
// page's own words.

import * as THREE from "three";
import type { Said } from "../panels/hud";
import type { Vec } from "../link/protocol";

const kWide_px = 1024;
const kHigh_px = 576;
const kMargin_px = 40;
const kLowest_px = kHigh_px - 16; // of a line
const kWide_m = 0.32;
const kHigh_m = (kWide_m * kHigh_px) / kWide_px;
// To the left of the organ, behind it and above: the tool's handle does not cover it, and who looks at the organ sees it.
const kAt_m = new THREE.Vector3(-0.12, -0.22, 0.12);
const kInk = "#e8edf2", kSoft = "#93a1af";
const kTones: Record<string, string> = { good: "#7fd1c7", wait: "#f2b04e", bad: "#ff6f64" };

const font = (px: number, weight = 400): string => `${weight} ${px}px system-ui, "Segoe UI", "DejaVu Sans", sans-serif`;

export class HeadsetPanel {
  readonly object: THREE.Mesh;
  /** What it says, line by line. */
  told: string[] = [];
  private readonly canvas = document.createElement("canvas");
  private readonly pen: CanvasRenderingContext2D;
  private readonly texture: THREE.CanvasTexture;
  private painted = "";

  constructor(eyes_m: THREE.Vector3) {
    this.canvas.width = kWide_px;
    this.canvas.height = kHigh_px;
    this.pen = this.canvas.getContext("2d")!;
    this.texture = new THREE.CanvasTexture(this.canvas);
    this.texture.colorSpace = THREE.SRGBColorSpace;
    this.texture.anisotropy = 4;
    const material = new THREE.MeshBasicMaterial({ map: this.texture });
    this.object = new THREE.Mesh(new THREE.PlaneGeometry(kWide_m, kHigh_m), material);
    this.object.up.set(0, 0, 1);
    this.object.position.copy(kAt_m);
    this.object.lookAt(eyes_m);
  }

  get corners_m(): Vec[] {
    return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) =>
      new THREE.Vector3((x * kWide_m) / 2, (y * kHigh_m) / 2, 0).applyMatrix4(this.object.matrixWorld).toArray());
  }

  tell(said: Said): void {
    const all = JSON.stringify(said);
    if (all === this.painted) return;
    this.painted = all;
    this.told = [];
    this.paint_ground(said);
    const right_px = kWide_px - kMargin_px;
    this.pen.textAlign = "right";
    this.write(said.link, right_px, 84, font(38), kTones[said.link_tone] ?? kSoft);
    this.pen.textAlign = "left";
    this.write(said.state, kMargin_px, 90, font(62, 600), kTones[said.state_tone] ?? kInk);
    this.write(said.state_words, kMargin_px, 142, font(36), kSoft);
    const force = said.old ? `old: ${said.force_N} N` : `${said.force_N} N`;
    const wide_px = this.write(force, kMargin_px, 248, font(96, 300), said.old ? kSoft : kInk);
    this.write(said.force_of, kMargin_px + wide_px + 20, 248, font(40), kSoft);
    let at_px = 312;
    for (const { text, tone } of said.warnings) at_px = this.write_wrapped(text, at_px, kTones[tone] ?? kInk);
    this.texture.needsUpdate = true;
  }

  private paint_ground(said: Said): void {
    const pen = this.pen;
    pen.fillStyle = "#10151c";
    pen.fillRect(0, 0, kWide_px, kHigh_px);
    if (said.old) { // hatched, as on the page
      pen.strokeStyle = "rgb(160 180 200 / 14%)";
      pen.lineWidth = 9;
      pen.beginPath();
      for (let x = -kHigh_px; x < kWide_px; x += 28) {
        pen.moveTo(x, kHigh_px);
        pen.lineTo(x + kHigh_px, 0);
      }
      pen.stroke();
    }
    pen.strokeStyle = said.alarm ? kTones.bad : "#3a4653";
    pen.lineWidth = said.alarm ? 24 : 6;
    pen.strokeRect(0, 0, kWide_px, kHigh_px);
  }

  /** Its width, px. */
  private write(text: string, x_px: number, y_px: number, style: string, color: string): number {
    if (text === "") return 0;
    this.pen.font = style;
    this.pen.fillStyle = color;
    this.pen.fillText(text, x_px, y_px, kWide_px - 2 * kMargin_px);
    this.told.push(text);
    return this.pen.measureText(text).width;
  }

  /** Word by word; returns where the next line would stand. What has no room is not said: the worst comes first. */
  private write_wrapped(text: string, y_px: number, color: string): number {
    if (y_px >= kLowest_px) return y_px;
    this.pen.font = font(36);
    this.pen.fillStyle = color;
    let line = "";
    const end = (): void => {
      if (y_px < kLowest_px) this.pen.fillText(line, kMargin_px, y_px);
      y_px += 46;
    };
    for (const word of text.split(" ")) {
      const longer = line === "" ? word : `${line} ${word}`;
      if (this.pen.measureText(longer).width > kWide_px - 2 * kMargin_px && line !== "") {
        end();
        line = word;
      } else {
        line = longer;
      }
    }
    if (line !== "") end();
    this.told.push(text);
    return y_px;
  }
}
