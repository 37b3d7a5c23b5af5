// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Deformer } from "../src/organ/deform";
import { Profile } from "../src/organ/profile";
import type { Contact } from "../src/link/protocol";

const kPitch_m = 0.004;
const kRings = [0.01, 0.006, 0.003, 0.001, 0];

function profile(rings: (number | null)[] = kRings): Profile {
  const made = new Profile(32, kPitch_m);
  made.set(rings);
  return made;
}

/** A flat sheet at z = 0 that looks up, and its far side at z = -0.03 that looks down. */
function slab(): { rest_m: Float32Array; normal: Float32Array } {
  const rest_m: number[] = [];
  const normal: number[] = [];
  for (const [z, up] of [
    [0, 1],
    [-0.03, -1],
  ]) {
    for (let x = -20; x <= 20; ++x) {
      for (let y = -20; y <= 20; ++y) {
        rest_m.push(x * 1e-3, y * 1e-3, z);
        normal.push(0, 0, up);
      }
    }
  }
  return { rest_m: new Float32Array(rest_m), normal: new Float32Array(normal) };
}

function contact(changes: Partial<Contact> = {}): Contact {
  return {
    contact: 0,
    state: 1,
    surface_point_m: [0, 0, 0],
    normal: [0, 0, 1],
    shift_m: [0, 0, 0],
    depth_m: 0.01,
    profile_m: kRings,
    tilt: [0, 0, 0],
    ...changes,
  };
}

function pressed(contacts: Contact[]): { rest_m: Float32Array; out_m: Float32Array; moved: number; most_m: number } {
  const { rest_m, normal } = slab();
  const out_m = rest_m.slice();
  const result = { moved: 0, most_m: 0 };
  new Deformer(rest_m, normal, 32, kPitch_m, new Uint32Array(0)).apply(contacts, null, out_m, result);
  return { rest_m, out_m, ...result };
}

test("The profile goes through its rings", () => {
  kRings.forEach((u_m, j) => assert.ok(Math.abs(profile().at(j * kPitch_m) - u_m) < 1e-12));
});

test("The profile never overshoots and decays where the rings decay", () => {
  let before = Infinity;
  for (let r = 0; r < 0.03; r += 1e-4) {
    const u_m = profile().at(r);
    assert.ok(u_m <= before + 1e-12 && u_m >= 0 && u_m <= 0.01);
    before = u_m;
  }
});

test("The profile is smooth: no step larger than its steepest slope allows", () => {
  for (let r = 0; r < 0.03; r += 1e-5) {
    assert.ok(Math.abs(profile().at(r + 1e-5) - profile().at(r)) < 1e-5 * 3);
  }
});

test("The profile ends one ring after the last and stays zero", () => {
  const open = profile([0.01, 0.008]);
  assert.equal(open.reach_m, 2 * kPitch_m);
  assert.equal(open.at(2 * kPitch_m), 0);
  assert.equal(open.at(1), 0);
  assert.equal(open.at(Number.NaN), 0);
});

test("A press moves the contact by its depth against the normal", () => {
  const { most_m, out_m, rest_m } = pressed([contact()]);
  assert.ok(Math.abs(most_m - 0.01) < 1e-7);
  for (let i = 2; i < out_m.length; i += 3) assert.ok(out_m[i] <= rest_m[i]);
});

test("A pull moves the tissue outwards", () => {
  const { out_m, rest_m } = pressed([contact({ depth_m: -0.01, profile_m: kRings.map((u) => -u) })]);
  for (let i = 2; i < out_m.length; i += 3) assert.ok(out_m[i] >= rest_m[i]);
});

test("The far side of the organ does not move", () => {
  const { out_m, rest_m } = pressed([contact()]);
  for (let i = out_m.length / 2; i < out_m.length; ++i) assert.equal(out_m[i], rest_m[i]);
});

test("The indentations of two contacts add up", () => {
  const other = contact({ contact: 1, surface_point_m: [0.004, 0, 0], profile_m: kRings.map((u) => u / 2) });
  const one = pressed([contact()]);
  const two = pressed([other]).out_m;
  const both = pressed([contact(), other]).out_m;
  for (let i = 0; i < both.length; ++i) {
    const sum_m = one.out_m[i] + two[i] - one.rest_m[i];
    assert.ok(Math.abs(both[i] - sum_m) < 1e-8);
  }
});

test("Of two sideways shifts the larger is shown", () => {
  const shifted = pressed([contact({ shift_m: [0.002, 0, 0], profile_m: kRings.map((u) => u / 2) })]);
  const both = pressed([
    contact({ shift_m: [0.002, 0, 0], profile_m: kRings.map((u) => u / 2) }),
    contact({ contact: 1, shift_m: [0.001, 0, 0], profile_m: kRings.map((u) => u / 2) }),
  ]);
  for (let i = 0; i < both.out_m.length; i += 3) assert.ok(Math.abs(both.out_m[i] - shifted.out_m[i]) < 1e-8);
});

test("A tilted indentation is deeper on one side by as much as it is shallower on the other", () => {
  const { out_m, rest_m } = pressed([contact({ tilt: [0.05, 0, 0] })]);
  const straight = pressed([contact()]).out_m;
  const lean_m = (x_mm: number): number => {
    const i = 3 * ((x_mm + 20) * 41 + 20); // y = 0
    assert.ok(Math.abs(rest_m[i] - x_mm * 1e-3) < 1e-9);
    return straight[i + 2] - out_m[i + 2];
  };
  assert.ok(Math.abs(lean_m(4) - 0.05 * 0.004) < 1e-7);
  assert.ok(Math.abs(lean_m(-4) + 0.05 * 0.004) < 1e-7);
  assert.ok(Math.abs(lean_m(0)) < 1e-7);
});

test("A tilted surface does not rise out of an indentation", () => {
  const { out_m, rest_m } = pressed([contact({ tilt: [2, 0, 0] })]);
  for (let i = 2; i < out_m.length; i += 3) assert.ok(out_m[i] <= rest_m[i]);
});

test("The tangential shift fades with the same shape", () => {
  const { out_m, rest_m } = pressed([contact({ shift_m: [0.002, 0, 0] })]);
  for (let i = 0; i < out_m.length; i += 3) {
    const sideways = out_m[i] - rest_m[i];
    const down = rest_m[i + 2] - out_m[i + 2];
    assert.ok(Math.abs(sideways - 0.2 * down) < 1e-7);
  }
});

test("Release brings every vertex back", () => {
  const { rest_m, normal } = slab();
  const out_m = rest_m.slice();
  const deformer = new Deformer(rest_m, normal, 32, kPitch_m, new Uint32Array(0));
  const result = { moved: 0, most_m: 0 };
  assert.equal(deformer.apply([contact()], null, out_m, result), true);
  assert.ok(result.moved > 100);
  assert.equal(deformer.apply([], null, out_m, result), true);
  assert.deepEqual(out_m, rest_m);
  assert.equal(deformer.apply([], null, out_m, result), false);
});

test("Numbers that are missing leave the mesh whole", () => {
  const nothing = [null, null, null] as unknown as number[];
  const { out_m, rest_m } = pressed([contact({ profile_m: nothing, normal: [Number.NaN, 0, 0] })]);
  assert.deepEqual(out_m, rest_m);
});
