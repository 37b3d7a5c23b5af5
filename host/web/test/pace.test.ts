// SPDX-License-Identifier: Apache-2.0
// The last frame before a silence has its reason: it must never be dropped.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Pace } from "../src/link/pace";

test("gives the first at once, then the newest, once per period", () => {
  const pace = new Pace<string>(100);
  pace.add("a");
  assert.equal(pace.take(0), "a");
  pace.add("b");
  assert.equal(pace.take(60), null);
  pace.add("c");
  assert.equal(pace.take(100), "c");
});

test("gives the last one too, however soon it came after the one before", () => {
  const pace = new Pace<string>(100);
  pace.add("ramping up");
  assert.equal(pace.take(0), "ramping up");
  pace.add("loop stalled");
  assert.equal(pace.take(16), null);
  assert.equal(pace.take(112), "loop stalled");
});

test("gives nothing twice, and nothing when nothing came", () => {
  const pace = new Pace<string>(100);
  assert.equal(pace.take(0), null);
  pace.add("a");
  assert.equal(pace.take(10), "a");
  assert.equal(pace.take(500), null);
});
