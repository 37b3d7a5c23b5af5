// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  across,
  distance_to_line,
  eyes_of,
  grip_error_m,
  hides,
  joint,
  outline,
  turned,
  with_head,
} from "../src/operator/figure";
import { follow_share } from "../src/scene/eyes";
import type { FigureFrame, Skeleton } from "../src/link/protocol";

const kSkeleton: Skeleton = { joints: ["pelvis", "head", "hand"], capsules: [], sides: [0, 1], hand: 2, head: 1 };
const kFrame: FigureFrame = {
  kind: "figure",
  tick: 1,
  joint_m: [0, 0, 0, 0.4, -0.1, 0.5, 0, 0, 0.08],
  grip_m: [0, 0.003, 0.084],
  head: [1, 0, 0, 0],
  reached: true,
  error_mm: 0,
  sweeps: 1,
  updates: 2,
  full_chain: false,
  trouble: 0,
  words: "",
  head_tracked: false,
};
const near = (a: number, b: number): void => assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

test("joints are three numbers each", () => {
  assert.deepEqual(joint(kFrame, 1), [0.4, -0.1, 0.5]);
});

test("a capsule along the body's side has a way across it, with any rounding", () => {
  for (const along of [
    [1e-9, -1, 0],
    [0, 1, 1e-17],
    [1e-17, -1 + 1e-16, 1e-17],
  ] as const) {
    const x = across([...along], [1e-12, 1, 1e-17]);
    near(Math.hypot(...x), 1);
    assert.ok(Math.abs(x[0] * along[0] + x[1] * along[1] + x[2] * along[2]) < 1e-6, String(x));
  }
  assert.deepEqual(across([0, 0, 1], [0, 0.8, 0.6]), [0, 1, 0]);
});

test("a capsule's outline goes from tip to tip and keeps both radii", () => {
  const points = outline(0.3, 0.05, 0.02);
  near(points[0][1], -0.05);
  near(points[points.length - 1][1], 0.32);
  near(points[0][0], 0);
  near(points[points.length - 1][0], 0);
  assert.ok(points.every(([x]) => x >= 0 && x <= 0.05 + 1e-12));
  for (let i = 1; i < points.length; ++i) assert.ok(points[i][1] >= points[i - 1][1] - 1e-12, "never back");
});

test("the cone of a capsule is tangent to both of its spheres", () => {
  // The flank between the arcs is at a right angle to the radius at both of its ends.
  const [length_m, ra_m, rb_m] = [0.3, 0.05, 0.02];
  const points = outline(length_m, ra_m, rb_m);
  const [end_a, begin_b] = [points[10], points[11]];
  const flank = [begin_b[0] - end_a[0], begin_b[1] - end_a[1]];
  near(flank[0] * end_a[0] + flank[1] * end_a[1], 0);
  near(flank[0] * begin_b[0] + flank[1] * (begin_b[1] - length_m), 0);
});

test("a capsule without length is a ball", () => {
  outline(0, 0.05, 0.05).forEach(([x, y]) => near(Math.hypot(x, y), 0.05));
});

test("a part around the camera hides the view, one beside it does not", () => {
  near(distance_to_line([0, 1, 0], [-1, 0, 0], [1, 0, 0]), 1);
  near(distance_to_line([3, 0, 0], [-1, 0, 0], [1, 0, 0]), 2);
  near(distance_to_line([0, 0, 2], [0, 0, 0], [0, 0, 0]), 2);
  assert.equal(hides([0, 0.1, 0], [-1, 0, 0], [1, 0, 0], 0.08), true);
  assert.equal(hides([0, 0.2, 0], [-1, 0, 0], [1, 0, 0], 0.08), false);
});

test("a quarter turn about z takes x to y", () => {
  const half = Math.SQRT1_2;
  turned([half, 0, 0, half], [1, 0, 0]).forEach((value, i) => near(value, [0, 1, 0][i]));
});

test("the eyes are before the head and look down to the work, and turn with it", () => {
  const eyes = eyes_of(kFrame, kSkeleton);
  assert.ok(eyes.at_m[0] < 0.4 && eyes.at_m[2] > 0.5);
  assert.ok(eyes.towards[0] < -0.9 && eyes.towards[2] < -0.2);
  near(Math.hypot(...eyes.towards), 1);
  const right = eyes_of({ ...kFrame, head: [Math.SQRT1_2, 0, 0, -Math.SQRT1_2] }, kSkeleton);
  assert.ok(right.towards[1] > 0.9, "a head that turns to the right looks along +y");
});

test("a follower goes two thirds of its way in one time constant and stays without time", () => {
  near(follow_share(0.15, 0.15), 1 - Math.exp(-1));
  assert.equal(follow_share(0, 0.15), 0);
  assert.equal(follow_share(-1, 0.15), 0);
});

test("the grip's error is the way from the finger tips to the tool", () => {
  near(grip_error_m(kFrame, kSkeleton), 0.005);
});

test("a headset's pose is the figure's head, and the eyes are the wearer's", () => {
  const half = Math.sin(0.3);
  const worn = {
    at_m: [0.3, -0.05, 0.55] as [number, number, number],
    turn: [Math.cos(0.3), 0, 0, half] as [number, number, number, number],
  };
  const frame = with_head(kFrame, kSkeleton, worn);
  const eyes = eyes_of(frame, kSkeleton);
  worn.at_m.forEach((value, i) => near(eyes.at_m[i], value));
  assert.deepEqual(frame.head, worn.turn);
  assert.deepEqual(joint(frame, 0), joint(kFrame, 0));
  assert.deepEqual(joint(frame, 2), joint(kFrame, 2));
});

test("a wearer who has left the figure sees it whole", () => {
  const far = { at_m: [1.5, 0, 0.5] as [number, number, number], turn: [1, 0, 0, 0] as [number, number, number, number] };
  assert.equal(with_head(kFrame, kSkeleton, far), kFrame);
});
