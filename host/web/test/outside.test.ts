// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { direction_words, edge_of } from "../src/scene/outside";

// A picture of 1000 x 800 px, 800 px of focal length, with a panel at its right; an arrow may be from 200 to 700, 100 to 600.
const free = { left: 200, top: 100, right: 700, bottom: 600 };
const picture = { left: 0, top: 0, right: 1000, bottom: 800 };
const panel = { left: 750, top: 0, right: 1000, bottom: 800 };
const edge = (right_m: number, up_m: number, back_m: number, radius_m = 0.01) =>
  edge_of([right_m, up_m, back_m], radius_m, [800, 800], { picture, panels: [panel], free });

test("what is seen needs no arrow", () => {
  assert.equal(edge(0, 0, -1), null);
  assert.equal(edge(-0.5, 0, -1), null); // at 100 px: beside the place of arrows, but seen
  assert.equal(edge(-0.63, 0, -1, 0.02), null); // at -4 px, but its rim is at 12
  assert.equal(edge(0.32, 0, -1), null); // at 756 px, but its rim is at 748, beside the panel
});

test("what lies behind a panel is not seen", () => {
  assert.equal(direction_words(edge(0.4, 0, -1)!.angle_rad), "to the right"); // at 820 px
  assert.equal(edge(0.4, 0, -1, 0.1), null); // looks out of it by 10 px
});

test("what is beside it has an arrow at that edge, pointing there", () => {
  const right = edge(0.5, 0.0625, -1)!; // at 900, 350: level with the middle of the free part
  assert.ok(Math.abs(right.angle_rad) < 1e-9);
  assert.ok(right.x_px > 640 && right.x_px < 700);
  assert.ok(Math.abs(right.y_px - 350) < 1e-9);
  assert.equal(direction_words(right.angle_rad), "to the right");
  const above = edge(-0.0625, 0.9, -1)!; // at 450, -320
  assert.equal(direction_words(above.angle_rad), "above");
  assert.ok(above.y_px > 100 && above.y_px < 130);
});

test("what is behind the camera is on the side to which one turns", () => {
  assert.equal(direction_words(edge(-0.3, 0, 1)!.angle_rad), "to the left");
  assert.equal(direction_words(edge(0.3, 0, 1)!.angle_rad), "to the right");
  assert.equal(direction_words(edge(0, -0.3, 1)!.angle_rad), "below");
  assert.ok(edge(0, 0, 1) !== null); // right behind: any side will do
  assert.ok(edge(0.2, 0, 0) !== null); // beside the lens
});

test("an arrow stays in the free part, however small that is", () => {
  for (const [right_m, up_m] of [
    [3, 1],
    [-3, 1],
    [1, 9],
    [-1, -9],
    [5, 5],
  ]) {
    const at = edge(right_m, up_m, -1)!;
    assert.ok(at.x_px >= free.left && at.x_px <= free.right && at.y_px >= free.top && at.y_px <= free.bottom);
  }
  const tiny = edge_of([3, 1, -1], 0.01, [800, 800], {
    picture,
    panels: [],
    free: { left: 10, top: 10, right: 30, bottom: 20 },
  })!;
  assert.ok(tiny.x_px >= 10 && tiny.x_px <= 30 && tiny.y_px >= 10 && tiny.y_px <= 20);
});
