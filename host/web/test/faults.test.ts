// SPDX-License-Identifier: Apache-2.0
// The words behind the numbers of a frame.

import assert from "node:assert/strict";
import { test } from "node:test";

import { describe } from "../src/faults";

test("a number of tactd has a name, a cause and a cure", () => {
  const fault = describe(131);
  for (const words of [fault.name, fault.cause, fault.cure]) assert.ok(words.length > 3);
  assert.notEqual(fault.name, "fault 131");
});

test("a number of a newer tactd is shown as a number, with what to do", () => {
  assert.equal(describe(999).name, "fault 999");
  assert.match(describe(999).cure, /of one build/);
});
