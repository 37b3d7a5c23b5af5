// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { split_link } from "../src/link/link";

test("the token leaves the fragment, the rest stays", () => {
  assert.deepEqual(split_link("#token=0f9a"), { token: "0f9a", rest: "" });
  assert.deepEqual(split_link("#token=0f9a&sharp"), { token: "0f9a", rest: "#sharp" });
  assert.deepEqual(split_link("#sharp&token=0f9a"), { token: "0f9a", rest: "#sharp" });
});

test("a fragment without a token has none", () => {
  assert.deepEqual(split_link(""), { token: null, rest: "" });
  assert.deepEqual(split_link("#sharp"), { token: null, rest: "#sharp" });
  assert.deepEqual(split_link("#nottoken=1"), { token: null, rest: "#nottoken=1" });
});
