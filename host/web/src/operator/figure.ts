// SPDX-License-Identifier: Apache-2.0
// figure.ts - pure functions of the operator's figure: the outline of a capsule, when one hides the
// view, where the eyes are. Vectors are [x, y, z] in frame W, m.

import type { FigureFrame, Skeleton, Vec } from "../link/protocol";
import type { Eyes, WornHead } from "../scene/eyes";

/** Eyes are so far from the head's joint, in the head's own axes (-x is where the face looks). */
const kEyes_m: Vec = [-0.085, 0, 0.04];
/** A wearer who is farther from the figure's eyes has left it, and sees it whole. */
const kOwnHead_m = 0.4;
/** At work the eyes look below where the face points. */
const kGaze: Vec = [-Math.cos(0.28), 0, -Math.sin(0.28)];

export function joint(frame: FigureFrame, index: number): Vec {
  return [frame.joint_m[3 * index], frame.joint_m[3 * index + 1], frame.joint_m[3 * index + 2]];
}

/** Half of a round cone's section as [distance from the axis, place along it] from end to end. */
export function outline(length_m: number, radius_a_m: number, radius_b_m: number): [number, number][] {
  const steps = 10;
  // Both spheres and the cone around them touch at the same slope: sin = (ra - rb) / L
  const slope = Math.asin(Math.max(-1, Math.min(1, (radius_a_m - radius_b_m) / Math.max(length_m, 1e-9))));
  const points: [number, number][] = [];
  const arc = (radius_m: number, middle_m: number, from: number, to: number): void => {
    for (let i = 0; i <= steps; ++i) {
      const angle = from + ((to - from) * i) / steps;
      points.push([Math.max(0, radius_m * Math.cos(angle)), middle_m + radius_m * Math.sin(angle)]);
    }
  };
  arc(radius_a_m, 0, -Math.PI / 2, slope);
  arc(radius_b_m, length_m, slope, Math.PI / 2);
  return points;
}

/** A unit vector across the unit vector `along`, as near to `side` as can be; upward if they are parallel. */
export function across(along: Vec, side: Vec): Vec {
  const part = (v: Vec): Vec => {
    const share = v[0] * along[0] + v[1] * along[1] + v[2] * along[2];
    return [v[0] - share * along[0], v[1] - share * along[1], v[2] - share * along[2]];
  };
  let x = part(side);
  // What is left of a parallel one is rounding, of any direction.
  if (Math.hypot(...x) < 1e-3) x = part([0, 0, 1]);
  const length = Math.hypot(...x);
  return [x[0] / length, x[1] / length, x[2] / length];
}

/** Distance from a point to the line between two others. */
export function distance_to_line(p: Vec, a: Vec, b: Vec): number {
  const ab = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const ap = [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
  const length2 = ab[0] ** 2 + ab[1] ** 2 + ab[2] ** 2;
  const along = length2 > 0 ? (ap[0] * ab[0] + ap[1] * ab[1] + ap[2] * ab[2]) / length2 : 0;
  const t = Math.min(1, Math.max(0, along));
  return Math.hypot(ap[0] - t * ab[0], ap[1] - t * ab[1], ap[2] - t * ab[2]);
}

/** A capsule around the camera, or right before it, would be all that one sees. */
export function hides(camera_m: Vec, a_m: Vec, b_m: Vec, radius_m: number): boolean {
  return distance_to_line(camera_m, a_m, b_m) < radius_m + 0.05;
}

/** A quaternion w, x, y, z on a vector. */
export function turned(q: readonly number[], v: Vec): Vec {
  const [w, x, y, z] = q;
  const t: Vec = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
}

/** Where the figure's eyes are and look. */
export function eyes_of(frame: FigureFrame, skeleton: Skeleton): Eyes {
  const head_m = joint(frame, skeleton.head);
  const from_head_m = turned(frame.head, kEyes_m);
  return {
    at_m: [head_m[0] + from_head_m[0], head_m[1] + from_head_m[1], head_m[2] + from_head_m[2]],
    towards: turned(frame.head, kGaze),
  };
}

/** The figure with the head of a headset's wearer: eyes there, turned so from looking along -x; as it is, if far away. */
export function with_head(frame: FigureFrame, skeleton: Skeleton, eyes: WornHead): FigureFrame {
  const own_m = eyes_of(frame, skeleton).at_m;
  if (Math.hypot(...eyes.at_m.map((value, i) => value - own_m[i])) > kOwnHead_m) return frame;
  const from_head_m = turned(eyes.turn, kEyes_m);
  const joint_m = [...frame.joint_m];
  for (let i = 0; i < 3; ++i) joint_m[3 * skeleton.head + i] = eyes.at_m[i] - from_head_m[i];
  return { ...frame, joint_m, head: eyes.turn };
}

/** How far the finger tips are from the tool's grip. */
export function grip_error_m(frame: FigureFrame, skeleton: Skeleton): number {
  const hand_m = joint(frame, skeleton.hand);
  return Math.hypot(...hand_m.map((value, i) => value - frame.grip_m[i]));
}
