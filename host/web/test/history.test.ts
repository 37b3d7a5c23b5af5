// SPDX-License-Identifier: Apache-2.0
// The frames before a sought one.

import assert from "node:assert/strict";
import { test } from "node:test";

import type { Contact, Frame, Vec } from "../src/link/protocol";
import { History, sample_of, samples_of } from "../src/panels/history";

const table = `# tact frames
tick,time_ns,force_x_N,force_y_N,force_z_N,wanted_force_x_N,wanted_force_y_N,wanted_force_z_N,worst_margin_us,contact1_depth_m,contact1_state,contact2_depth_m,contact2_state
100,1000000000,3,4,0,6,8,0,250,0.004,1,0.002,0
`;
const frame = {
  tick: 100,
  time_ns: 1e9,
  force_N: [3, 4, 0] as Vec,
  wanted_force_N: [6, 8, 0] as Vec,
  worst_margin_us: 250,
  contacts: [{ contact: 0, depth_m: 0.004 } as Contact],
} as Frame;

test("a row of the table is what its frame would draw", () => {
  assert.deepEqual(samples_of(table, 2), [sample_of(frame, 2)]);
  assert.deepEqual(samples_of(table, 2)[0], { time_s: 1, depth_mm: [4, 0], force_N: [10, 5], margin_us: 250 });
});

test("what is no table draws nothing", () => assert.deepEqual(samples_of("", 2), []));

test("while an answer is on its way only the newest question waits", async () => {
  const asked: string[] = [];
  const taken: number[] = [];
  const answers: (() => void)[] = [];
  const history = new History(
    async (path) => {
      asked.push(path);
      await new Promise<void>((done) => answers.push(done));
      return new Response(table);
    },
    (of) => taken.push(of.tick),
  );
  for (const tick of [100, 200, 300]) history.before({ ...frame, tick } as Frame, 50);
  for (let i = 0; i < 2; ++i) {
    answers[i]();
    while (taken.length <= i) await new Promise((done) => setImmediate(done));
  }
  assert.deepEqual(taken, [100, 300]);
  assert.deepEqual(asked, ["recording.csv?from_tick=50&to_tick=100", "recording.csv?from_tick=250&to_tick=300"]);
});
