// SPDX-License-Identifier: Apache-2.0
// The words behind the numbers of a frame.

import assert from "node:assert/strict";
import { test } from "node:test";

import { describe, describe_state } from "../src/faults";

test("a number of tactd has a name, a cause and a cure", () => {
  const fault = describe(131);
  for (const words of [fault.name, fault.cause, fault.cure]) assert.ok(words.length > 3);
  assert.notEqual(fault.name, "fault 131");
});

test("a number of a newer tactd is shown as a number, with what to do", () => {
  assert.equal(describe(999).name, "fault 999");
  assert.match(describe(999).cure, /of one build/);
});

test("each state has tactd's name and words, and another number is shown as a number", () => {
  assert.deepEqual([0, 1, 2, 3].map((n) => describe_state(n).name), ["off", "ready", "armed", "stopped"]);
  for (const n of [0, 1, 2, 3]) assert.match(describe_state(n).words, /force/);
  assert.equal(describe_state(9).name, "state 9");
});
