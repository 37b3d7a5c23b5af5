// SPDX-License-Identifier: Apache-2.0
// When does a task end, and when do all begin again?
import assert from "node:assert/strict";
import { test } from "node:test";

import type { Frame, Vec } from "../src/link/protocol";
import { Exercise, type Task } from "../src/panels/tasks";

const press: Task = {
  text: "press",
  place_m: [0, 0, 0],
  radius_m: 0.005,
  by_grip: false,
  force_min_N: 0.5,
  force_max_N: 2,
  grip_min_ratio: 0.8,
  grip_max_ratio: 1,
  hold_s: 0,
};

function frame(time_s: number, force_N: number, at_m: Vec | null = [0, 0, 0], grip_ratio = 0, state = 1): Frame {
  const contacts = at_m ? [{ contact: 0, state, surface_point_m: at_m }] : [];
  return { time_ns: time_s * 1e9, force_N: [0, 0, force_N], grip_ratio, contacts } as unknown as Frame;
}

function done(tasks: Task[], frames: Frame[]): number {
  const exercise = new Exercise(tasks);
  for (const one of frames) exercise.frame(one);
  return exercise.done;
}

test("A task ends by a force in its range, its ends included", () => {
  for (const [force_N, ends] of [
    [0.49, 0],
    [0.5, 1],
    [2, 1],
    [2.01, 0],
    [Number.NaN, 0],
  ])
    assert.equal(done([press], [frame(1, force_N)]), ends, `${force_N} N`);
});

test("It ends at its place alone, and by a contact alone", () => {
  assert.equal(done([press], [frame(1, 1, [0.003, 0, 0.0039])]), 1);
  assert.equal(done([press], [frame(1, 1, [0.003, 0, 0.0041])]), 0);
  assert.equal(done([press], [frame(1, 1, null)]), 0);
  assert.equal(done([press], [frame(1, 1, [0, 0, 0], 0, 3)]), 0, "inside the organ");
});

test("A grip ends one as well", () => {
  const grip = { ...press, by_grip: true };
  assert.equal(done([grip], [frame(1, 1, [0, 0, 0], 0.7)]), 0);
  assert.equal(done([grip], [frame(1, 0, [0, 0, 0], 0.9)]), 1);
});

test("A hold is without a break", () => {
  const hold = { ...press, hold_s: 0.5 };
  const forces = (list: number[]): Frame[] => list.map((force_N, i) => frame(0.1 * i, force_N));
  assert.equal(done([hold], forces([1, 1, 1, 1, 1])), 0);
  assert.equal(done([hold], forces([1, 1, 1, 1, 1, 1, 1])), 1);
  assert.equal(done([hold], forces([1, 1, 1, 0, 1, 1, 1, 1, 1])), 0);
});

test("One task at a time, in their order", () => {
  const there = { ...press, place_m: [0.02, 0, 0] as Vec };
  assert.equal(done([press, there], [frame(1, 1, [0.02, 0, 0])]), 0);
  assert.equal(done([press, there], [frame(1, 1), frame(1.1, 1), frame(1.2, 1, [0.02, 0, 0])]), 2);
  assert.equal(done([press, press], [frame(1, 1)]), 1, "a frame ends one task");
  assert.equal(done([press], [frame(1, 1), frame(1.1, 1), frame(1.2, 1)]), 1);
});

test("Another run, or a recording sought back, begins again", () => {
  assert.equal(done([press], [frame(1, 1), frame(0.5, 0)]), 0);
  assert.equal(done([press], [frame(2, 1), frame(1, 0)]), 0);
  assert.equal(done([press], [frame(1, 1), frame(9, 0)]), 1, "a pause of the frames is no other run");
  assert.equal(done([press], [frame(1, 1), frame(1.5, 0)]), 1);
});

test("A scene without tasks has none to do", () => {
  assert.equal(done([], [frame(1, 1)]), 0);
});
