// SPDX-License-Identifier: Apache-2.0
// outside.ts - an arrow at the picture's edge, with its word, to what is not in the picture: the organ, the tool.

import * as THREE from "three";
import { by_id } from "../document/dom";
import type { Vec } from "../link/protocol";

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

export interface Edge {
  x_px: number;
  y_px: number;
  angle_rad: number; // on the screen, clockwise from the right
}

const kLook_ms = 250; // how often the panels are asked where they are
const kPanels = ["about", "tools", "now", "timeline", "plots"];
const kNothing: Box = { left: 0, top: 0, right: 0, bottom: 0 };
const kHalf_px: [number, number] = [46, 18]; // of an arrow with its word

/** What a person sees of the picture, px from its left upper corner. */
export interface View {
  picture: Box;
  panels: Box[]; // that lie on it
  free: Box; // a part without panels
}

/**
 * The place of an arrow to a ball which is not seen; null when it is. `ball_m`: its middle in the camera's axes (right, up,
 * backwards); `focal_px`: of a ray at 45 deg, px from the middle of the picture.
 */
export function edge_of(ball_m: Vec, radius_m: number, focal_px: [number, number], view: View): Edge | null {
  const { picture, free } = view;
  const [right_m, up_m, back_m] = ball_m;
  const from_px = [(free.left + free.right) / 2, (free.top + free.bottom) / 2];
  let towards = [right_m * focal_px[0], -up_m * focal_px[1]]; // on the screen, of any length: which way to turn
  if (back_m < -1e-3) {
    // before the camera
    const x_px = (picture.left + picture.right) / 2 + towards[0] / -back_m;
    const y_px = (picture.top + picture.bottom) / 2 + towards[1] / -back_m;
    const radius_px = (radius_m * focal_px[1]) / -back_m;
    const inside = [picture, ...view.panels].map((box) =>
      // how far its middle is from the nearest edge
      Math.min(x_px - box.left, box.right - x_px, y_px - box.top, box.bottom - y_px),
    );
    const [in_picture_px, ...in_panels_px] = inside;
    if (in_picture_px > -radius_px && in_panels_px.every((px) => px < radius_px)) return null;
    towards = [x_px - from_px[0], y_px - from_px[1]];
  }
  if (Math.hypot(...towards) < 1e-9) towards = [1, 0];
  // To the nearer of two sides: from + t towards
  const half_px = [(free.right - free.left) / 2 - kHalf_px[0], (free.bottom - free.top) / 2 - kHalf_px[1]];
  const t = Math.min(Math.max(0, half_px[0]) / Math.abs(towards[0]), Math.max(0, half_px[1]) / Math.abs(towards[1]));
  return {
    x_px: from_px[0] + t * towards[0],
    y_px: from_px[1] + t * towards[1],
    angle_rad: Math.atan2(towards[1], towards[0]),
  };
}

/** An angle on the screen in words. */
export function direction_words(angle_rad: number): string {
  const words = ["to the right", "below right", "below", "below left", "to the left", "above left", "above", "above right"];
  return words[(Math.round(angle_rad / (Math.PI / 4)) + 8) % 8];
}

export interface Target {
  at_m: THREE.Vector3;
  radius_m: number;
}

export class Outside {
  private view: View = { picture: kNothing, panels: [], free: kNothing };
  private asked_ms = -Infinity;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: THREE.PerspectiveCamera,
  ) {}

  /** Once per picture; null: not known, or nothing to point at. */
  draw(now_ms: number, organ: Target | null, tool: Target | null): void {
    if (now_ms - this.asked_ms > kLook_ms) {
      this.asked_ms = now_ms;
      this.view = this.look();
    }
    const to_organ = organ && this.edge(organ);
    const to_tool = tool && this.edge(tool);
    if (
      to_organ &&
      to_tool &&
      Math.abs(to_organ.x_px - to_tool.x_px) < 2 * kHalf_px[0] &&
      Math.abs(to_organ.y_px - to_tool.y_px) < 2 * kHalf_px[1]
    ) {
      // side by side, towards the middle
      to_tool.y_px = to_organ.y_px + (to_organ.y_px > (this.view.free.top + this.view.free.bottom) / 2 ? -2 : 2) * kHalf_px[1];
    }
    this.show("organ", to_organ);
    this.show("tool", to_tool);
  }

  private edge(target: Target): Edge | null {
    const { clientWidth, clientHeight } = this.canvas;
    const ball_m = target.at_m.clone().applyMatrix4(this.camera.matrixWorldInverse).toArray();
    const of = this.camera.projectionMatrix.elements;
    return edge_of(ball_m, target.radius_m, [(of[0] * clientWidth) / 2, (of[5] * clientHeight) / 2], this.view);
  }

  /** Where the panels are. On a desk they lie on the picture, and what is in the middle of them is free. */
  private look(): View {
    const from = this.canvas.getBoundingClientRect();
    const box = (id: string): Box => {
      const { left, right, top, bottom } = by_id(id).getBoundingClientRect();
      return { left: left - from.left, right: right - from.left, top: top - from.top, bottom: bottom - from.top };
    };
    const picture = box("view");
    const middle = box("middle");
    const free = {
      left: Math.max(0, middle.left),
      right: Math.min(picture.right, middle.right),
      top: Math.max(0, middle.top, box("banner").bottom),
      bottom: Math.min(picture.bottom, middle.bottom),
    };
    const on_desk = free.right - free.left > 2 * kHalf_px[0] && free.bottom - free.top > 4 * kHalf_px[1];
    return { picture, panels: kPanels.map(box), free: on_desk ? free : picture };
  }

  private show(word: string, edge: Edge | null): void {
    const arrow = by_id(`to_${word}`);
    arrow.hidden = edge === null;
    if (!edge) return;
    arrow.style.transform = `translate(${edge.x_px.toFixed(0)}px, ${edge.y_px.toFixed(0)}px) translate(-50%, -50%)`;
    arrow.querySelector("i")!.style.transform = `rotate(${edge.angle_rad.toFixed(2)}rad)`;
    const name = `the ${word} is outside the picture, ${direction_words(edge.angle_rad)}`;
    if (arrow.getAttribute("aria-label") !== name) arrow.setAttribute("aria-label", name);
  }
}
