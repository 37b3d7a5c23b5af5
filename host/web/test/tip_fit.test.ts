// SPDX-License-Identifier: Apache-2.0
// Is the drawn surface below the tip wherever, however deep and however wide it presses?
import assert from "node:assert/strict";
import { test } from "node:test";
import { Deformer } from "../src/organ/deform";
import { FoldGuard } from "../src/organ/fold_guard";
import { balls_of, dot, type Ball, type Contact, type Frame, type Vec } from "../src/link/protocol";
import { kPitch_m, organ, rings_m, vector, type Surface } from "./surfaces";

/** Repeatable, 0 .. 1. */
function random(seed: number): () => number {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

const along = (p: Vec, n: Vec, length_m: number): Vec => p.map((x, i) => x + n[i] * length_m) as Vec;

/** How far the topmost triangle at p looks out along n, m; NaN: there is none near. */
function height_m(surface: Surface, out_m: Float32Array, p: Vec, n: Vec): number {
  let top_m = NaN;
  const most_m = 0.02;
  for (let t = 0; t < surface.triangle.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => vector(out_m, surface.triangle[t + k]).map((x, i) => x - p[i]) as Vec);
    if (Math.hypot(...a) > most_m) continue;
    // volumes that the line spans with each edge
    const volume = (u: Vec, v: Vec): number =>
      n[0] * (u[1] * v[2] - u[2] * v[1]) + n[1] * (u[2] * v[0] - u[0] * v[2]) + n[2] * (u[0] * v[1] - u[1] * v[0]);
    const [x, y, z] = [volume(b, c), volume(c, a), volume(a, b)];
    if (!(Math.min(x, y, z) >= 0) || x + y + z < 1e-14) continue;
    const at_m = (x * dot(a, n) + y * dot(b, n) + z * dot(c, n)) / (x + y + z);
    if (!(at_m <= top_m)) top_m = at_m;
  }
  return top_m;
}

interface Press {
  ball: Ball;
  contact: Contact;
}

/** Nothing of the surface is in a ball that lies there. */
function has_room(surface: Surface, { centre_m: [x, y, z], radius_m }: Ball): boolean {
  const { vertex_m } = surface;
  for (let v = 0; v < vertex_m.length; v += 3)
    if (Math.hypot(vertex_m[v] - x, vertex_m[v + 1] - y, vertex_m[v + 2] - z) < 0.95 * radius_m) return false;
  return true;
}

/** On a random triangle that looks up, anywhere in it where the ball fits. */
function press(surface: Surface, dice: () => number, depth_m: number, radius_m: number): Press {
  for (let n = 0; n < 10000; ++n) {
    const t = 3 * Math.floor((dice() * surface.triangle.length) / 3);
    const corner = [0, 1, 2].map((k) => surface.triangle[t + k]);
    const [u, v] = [Math.sqrt(dice()), dice()];
    const w = [1 - u, u * (1 - v), u * v];
    const mix = (from: Float32Array): Vec =>
      [0, 1, 2].map((i) => corner.reduce((s, c, k) => s + w[k] * from[3 * c + i], 0)) as Vec;
    const normal = mix(surface.normal);
    const length = Math.hypot(...normal);
    if (normal[2] < 0.7 * length || length < 0.95) continue; // an edge of the mesh
    for (let i = 0; i < 3; ++i) normal[i] /= length;
    const surface_point_m = mix(surface.vertex_m);
    if (!has_room(surface, { centre_m: along(surface_point_m, normal, radius_m), radius_m })) continue;
    const contact: Contact = {
      contact: 0,
      state: 1,
      surface_point_m,
      normal,
      shift_m: [0, 0, 0],
      depth_m,
      profile_m: rings_m(depth_m, radius_m),
      tilt: [0, 0, 0],
    };
    return { contact, ball: { radius_m, centre_m: along(surface_point_m, normal, radius_m - depth_m) } };
  }
  throw new Error("no room for the ball");
}

// Organ, radius of its scene's tip, deepest press of its script; m.
const kScenes: [string, number, number][] = [
  ["liver_3116", 0.004, 0.0095],
  ["heart_4002", 0.0065, 0.0088],
  ["skin", 0.0025, 0.0077],
  ["gum", 0.001, 0.0036],
  ["cover", 0.004, 0.0054],
];

for (const [name, radius_m, most_m] of kScenes) {
  test(`The drawn ${name} is as deep as a tip anywhere`, () => {
    const surface = organ(name);
    const dice = random(7);
    const deformer = new Deformer(surface.vertex_m, surface.normal, 32, kPitch_m, surface.triangle);
    const guard = new FoldGuard(surface.vertex_m, surface.triangle);
    const out_m = surface.vertex_m.slice();
    for (let i = 0; i < 150; ++i) {
      const depth_m = 0.001 + (most_m - 0.001) * dice();
      const { contact, ball } = press(surface, dice, depth_m, (0.5 + dice()) * radius_m);
      const { normal, surface_point_m } = contact;
      deformer.apply([contact], null, out_m, { moved: 0, most_m: 0 }, { balls: [ball], cut: new Set() });
      const ratio = -height_m(surface, out_m, surface_point_m, normal) / depth_m;
      assert.ok(ratio >= 0.9 && ratio < 1.3, `${ratio} of ${depth_m} m at ${surface_point_m}`);
      for (const t of guard.find_moved(out_m)) assert.ok(!guard.is_folded(t, out_m), `triangle ${t} folds`);
    }
  });
}

test("A sliding tip moves no vertex by more than 20 of its steps", () => {
  const surface = organ("skin");
  const deformer = new Deformer(surface.vertex_m, surface.normal, 32, kPitch_m, surface.triangle);
  const { contact, ball } = press(surface, random(3), 0.005, 0.0025);
  const step_m = 2e-5;
  let before_m: Float32Array | null = null;
  for (let i = 0; i < 300; ++i) {
    const out_m = surface.vertex_m.slice();
    deformer.apply([contact], null, out_m, { moved: 0, most_m: 0 }, { balls: [ball], cut: new Set() });
    if (before_m) {
      const most_m = out_m.reduce((most, x, k) => Math.max(most, Math.abs(x - before_m![k])), 0);
      assert.ok(most_m < 20 * step_m, `${most_m} m at step ${i}`);
    }
    before_m = out_m;
    contact.surface_point_m = along(contact.surface_point_m, [1, 0, 0], step_m);
    ball.centre_m = along(ball.centre_m, [1, 0, 0], step_m);
  }
});

test("A cut triangle covers nothing, and a sphere inside the organ moves nothing", () => {
  const surface = organ("skin");
  const { contact, ball } = press(surface, random(5), 0.005, 0.0025);
  const drawn = (state: number, cut: Set<number>): number => {
    const out_m = surface.vertex_m.slice();
    const deformer = new Deformer(surface.vertex_m, surface.normal, 32, kPitch_m, surface.triangle);
    const flat = { ...contact, state, profile_m: [2e-6, 2e-6, 2e-6, 2e-6, 2e-6] }; // moves the triangles, hardly
    const result = { moved: 0, most_m: 0 };
    deformer.apply([flat], null, out_m, result, { balls: [ball], cut });
    return result.most_m;
  };
  assert.ok(drawn(1, new Set()) > 0.004);
  assert.ok(drawn(3, new Set()) < 1e-5);
  assert.ok(drawn(1, new Set(Array.from({ length: surface.triangle.length / 3 }, (_, t) => t))) < 1e-5);
});

test("A sphere is where the tool's pose puts it", () => {
  const half = Math.SQRT1_2; // a quarter turn about z
  const frame = { tool_position_m: [1, 2, 3], tool_orientation: [half, 0, 0, half] } as unknown as Frame;
  const [{ centre_m, radius_m }] = balls_of(frame, [{ radius_m: 0.5, offset_m: [0.1, 0, 0.2] }]);
  [1, 2.1, 3.2].forEach((x, i) => assert.ok(Math.abs(centre_m[i] - x) < 1e-12));
  assert.equal(radius_m, 0.5);
});
