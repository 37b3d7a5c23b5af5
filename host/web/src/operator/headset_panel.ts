// SPDX-License-Identifier: Apache-2.0
// headset_panel.ts - who wears a headset does not see the page: state, force and faults on a panel in the scene, in the
// page's own words.

import * as THREE from "three";
import type { Said } from "../panels/hud";
import type { Vec } from "../link/protocol";

const kWide_px = 1024;
const kHigh_px = 576;
const kMargin_px = 40;
const kLine_px = 36; // letters of a line
const kRow_px = 46;
const kRows_px = 312; // the first line of the warnings
const kRows = Math.ceil((kHigh_px - 16 - kRows_px) / kRow_px);
const kWide_m = 0.32;
const kHigh_m = (kWide_m * kHigh_px) / kWide_px;
// To the left of the organ, behind it and above: the tool's handle does not cover it, and who looks at the organ sees it.
const kAt_m = new THREE.Vector3(-0.12, -0.22, 0.12);
const kInk = "#e8edf2";
const kSoft = "#93a1af";
const kTones: Record<string, string> = { good: "#7fd1c7", wait: "#f2b04e", bad: "#ff6f64" };

const font = (px: number, weight = 400): string => `${weight} ${px}px system-ui, "Segoe UI", "DejaVu Sans", sans-serif`;

/** A text word by word; a word that is wider than a line has one of its own. */
function wrapped(text: string, fits: (line: string) => boolean): string[] {
  const lines: string[] = [];
  for (const word of text.split(" ")) {
    const longer = lines.length === 0 ? word : `${lines[lines.length - 1]} ${word}`;
    if (lines.length > 0 && fits(longer)) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** What of each text is shown in so many rows, the first texts first. Where a row is missing the last one ends with "…". */
export function shown_lines(texts: readonly string[], rows: number, fits: (line: string) => boolean): string[][] {
  let free = rows;
  let cut = false;
  let last: string[] = []; // of the text that has the last row
  const shown = texts.map((text) => {
    const wanted = wrapped(text, fits);
    const lines = wanted.slice(0, free);
    free -= lines.length;
    cut ||= lines.length < wanted.length;
    if (lines.length > 0) last = lines;
    return lines;
  });
  if (cut && last.length > 0) {
    const words = last[last.length - 1].split(" ");
    while (words.length > 1 && !fits(`${words.join(" ")} …`)) words.pop();
    last[last.length - 1] = `${words.join(" ")} …`;
  }
  return shown;
}

export class HeadsetPanel {
  readonly object: THREE.Mesh;
  /** What is to be read on it, text by text. */
  shown: string[] = [];
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
    return [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([right, up]) =>
      new THREE.Vector3((right * kWide_m) / 2, (up * kHigh_m) / 2, 0).applyMatrix4(this.object.matrixWorld).toArray(),
    );
  }

  show(said: Said): void {
    const all = JSON.stringify(said);
    if (all === this.painted) return;
    this.painted = all;
    this.shown = [];
    this.paint_ground(said);
    const right_px = kWide_px - kMargin_px;
    this.pen.textAlign = "right";
    this.write(said.link, right_px, 84, font(38), kTones[said.link_tone] ?? kSoft);
    this.pen.textAlign = "left";
    this.write(said.state, kMargin_px, 90, font(62, 600), kTones[said.state_tone] ?? kInk);
    this.write(said.state_words, kMargin_px, 142, font(kLine_px), kSoft);
    const force = said.old ? `old: ${said.force_N} N` : `${said.force_N} N`;
    const wide_px = this.write(force, kMargin_px, 248, font(96, 300), said.old ? kSoft : kInk);
    this.write(said.force_of, kMargin_px + wide_px + 20, 248, font(40), kSoft);
    this.write_warnings(said.warnings);
    this.texture.needsUpdate = true;
  }

  private paint_ground(said: Said): void {
    const pen = this.pen;
    pen.fillStyle = "#10151c";
    pen.fillRect(0, 0, kWide_px, kHigh_px);
    if (said.old) {
      // hatched, as on the page
      pen.strokeStyle = "rgb(160 180 200 / 14%)";
      pen.lineWidth = 9;
      pen.beginPath();
      for (let x_px = -kHigh_px; x_px < kWide_px; x_px += 28) {
        pen.moveTo(x_px, kHigh_px);
        pen.lineTo(x_px + kHigh_px, 0);
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
    this.shown.push(text);
    return this.pen.measureText(text).width;
  }

  private write_warnings(warnings: Said["warnings"]): void {
    this.pen.font = font(kLine_px);
    const fits = (line: string): boolean => this.pen.measureText(line).width <= kWide_px - 2 * kMargin_px;
    let y_px = kRows_px;
    shown_lines(
      warnings.map(({ text }) => text),
      kRows,
      fits,
    ).forEach((lines, i) => {
      this.pen.fillStyle = kTones[warnings[i].tone] ?? kInk;
      for (const line of lines) {
        this.pen.fillText(line, kMargin_px, y_px, kWide_px - 2 * kMargin_px);
        y_px += kRow_px;
      }
      if (lines.length > 0) this.shown.push(lines.join(" "));
    });
  }
}
