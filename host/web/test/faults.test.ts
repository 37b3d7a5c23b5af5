// SPDX-License-Identifier: Apache-2.0
// The words behind the numbers of a frame.

import assert from "node:assert/strict";
import { test } from "node:test";

import { describe, describe_past_state, describe_state } from "../src/panels/faults";

test("a number of tactd has a name, a cause and a remedy", () => {
  const fault = describe(131);
  for (const words of [fault.name, fault.cause, fault.remedy]) assert.ok(words.length > 3);
  assert.notEqual(fault.name, "fault 131");
});

test("a number of a newer tactd is shown as a number, with what to do", () => {
  assert.equal(describe(999).name, "fault 999");
  assert.match(describe(999).remedy, /of one build/);
});

test("each state has tactd's name and words, and another number is shown as a number", () => {
  assert.deepEqual(
    [0, 1, 2, 3].map((n) => describe_state(n, 131).name),
    ["off", "ready", "armed", "stopped"],
  );
  for (const n of [0, 1, 2, 3]) assert.match(describe_state(n, 131).words, /force/);
  assert.equal(describe_state(9, 0).name, "state 9");
});

test("stopped on request is not stopped by a fault", () => {
  assert.match(describe_state(3, 131).words, /until a person acts/);
  assert.doesNotMatch(describe_state(3, 0).words, /until a person acts/);
  assert.match(describe_state(3, 0).words, /on request/);
});

test("of a recording nothing is said as if it were so now", () => {
  for (const n of [0, 1, 2, 3])
    for (const fault of [0, 131]) {
      const { name, words } = describe_past_state(n, fault);
      assert.match(name, /^was /);
      assert.doesNotMatch(words, /\bis\b/);
      assert.match(words, /\bwas\b/);
    }
});
