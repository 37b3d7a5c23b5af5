// SPDX-License-Identifier: Apache-2.0
// Deep presses: no triangle of the drawn surface turns over.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Deformer } from "../src/organ/deform";
import { FoldGuard } from "../src/organ/fold_guard";
import type { Contact } from "../src/link/protocol";
import { organ, kPitch_m, rings_m, vector, with_normals, type Surface } from "./surfaces";

const kTip_m = 0.004;
const kDeep_m = 0.02; // five radii, beyond every shipped law

/** A hill of 15 mm radius, a vertex each millimetre. */
function hill(): Surface {
  const vertex_m: number[] = [];
  const triangle: number[] = [];
  const n = 41;
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < n; ++j) {
      const [x, y] = [(i - 20) * 1e-3, (j - 20) * 1e-3];
      vertex_m.push(x, y, Math.sqrt(Math.max(1e-5, 0.015 ** 2 - x * x - y * y)) - 0.015);
      if (i === 0 || j === 0) continue;
      const at = i * n + j;
      triangle.push(at, at - n - 1, at - 1, at, at - n, at - n - 1);
    }
  return with_normals(new Float32Array(vertex_m), new Uint32Array(triangle));
}

function contact(surface: Surface, vertex: number, depth_m: number): Contact {
  return {
    contact: 0,
    state: 1,
    surface_point_m: vector(surface.vertex_m, vertex),
    normal: vector(surface.normal, vertex),
    shift_m: [0, 0, 0],
    depth_m,
    profile_m: rings_m(depth_m, kTip_m),
    tilt: [0, 0, 0],
  };
}

/** The vertex on the same side that lies nearest to the other jaw's place, 8 mm off. */
function other_jaw(surface: Surface, vertex: number): number {
  const at = vector(surface.vertex_m, vertex);
  const up = vector(surface.normal, vertex);
  let best = vertex;
  let best_m = Infinity;
  for (let v = 0; v < surface.vertex_m.length / 3; ++v) {
    const there = vector(surface.vertex_m, v);
    const off_m = Math.abs(Math.hypot(...there.map((x, i) => x - at[i])) - 2 * kTip_m);
    const normal = vector(surface.normal, v);
    if (off_m >= best_m || up[0] * normal[0] + up[1] * normal[1] + up[2] * normal[2] < 0.5) continue;
    [best, best_m] = [v, off_m];
  }
  return best;
}

/** Folded triangles, and by how far the deepest vertex went. */
function pressed(surface: Surface, deformer: Deformer, contacts: Contact[]): { folded: number; most_m: number } {
  const out_m = surface.vertex_m.slice();
  const result = { moved: 0, most_m: 0 };
  deformer.apply(contacts, null, out_m, result);
  const guard = new FoldGuard(surface.vertex_m, surface.triangle);
  let folded = 0;
  for (let t = 0; t < surface.triangle.length / 3; ++t) if (guard.is_folded(t, out_m)) ++folded;
  return { folded, most_m: result.most_m };
}

for (const [name, surface, step] of [
  ["the liver", organ("liver_3116"), 13],
  ["a hill of fine surface", hill(), 7],
] as const) {
  test(`Pressed deeply, ${name} has no triangle that turned over`, () => {
    const deformer = new Deformer(surface.vertex_m, surface.normal, 32, kPitch_m, surface.triangle);
    for (let v = 0; v < surface.vertex_m.length / 3; v += step) {
      const one = pressed(surface, deformer, [contact(surface, v, kDeep_m)]);
      assert.equal(one.folded, 0, `vertex ${v}`);
      assert.ok(one.most_m > 0.85 * kDeep_m, `vertex ${v} keeps its depth: ${one.most_m}`);
      const jaws = [contact(surface, v, 0.6 * kDeep_m), contact(surface, other_jaw(surface, v), 0.6 * kDeep_m)];
      assert.equal(pressed(surface, deformer, jaws).folded, 0, `two jaws at vertex ${v}`);
    }
  });
}

test("An indentation that folds nothing stays as the law says, to the last bit", () => {
  const surface = organ("liver_3116");
  const out_m = surface.vertex_m.slice();
  for (let i = 2; i < out_m.length; i += 3) out_m[i] *= 0.98;
  const before_m = out_m.slice();
  assert.equal(new FoldGuard(surface.vertex_m, surface.triangle).hold(out_m), 0);
  assert.deepEqual(out_m, before_m);
});
