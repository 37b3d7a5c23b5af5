// SPDX-License-Identifier: Apache-2.0
// The range of a plot: what is usual fills it, what is rare and far off is marked.

import assert from "node:assert/strict";
import { test } from "node:test";

import { outside, robust_range, whole_range } from "../src/panels/scale";

const usual = Array.from({ length: 600 }, (_, i) => 800 + (i % 50));

test("one stall does not make all other margins a flat line, and is marked", () => {
  const values = [...usual];
  values[300] = -40000;
  const range = robust_range(values, 50);
  assert.ok(range.low > -1000 && range.high > 849, JSON.stringify(range));
  assert.deepEqual(outside(values, range), [300]);
  assert.ok(whole_range(values, 50).low <= -40000);
});

test("what is near the others is shown, however rare", () => {
  const values = [...usual];
  values[300] = -200;
  const range = robust_range(values, 50);
  assert.ok(range.low <= -200);
  assert.deepEqual(outside(values, range), []);
});

test("zero stays in sight, noise stays small, and nothing known is a range too", () => {
  for (const range_of of [whole_range, robust_range]) {
    assert.deepEqual(range_of([], 5), range_of([0, null], 5));
    const range = range_of([0.01, 0.02], 5);
    assert.ok(range.low === 0 && range.high >= 5);
    assert.ok(range_of([-3, -2], 5).high >= 0);
  }
});
