// SPDX-License-Identifier: Apache-2.0
// Names of saved files.

import assert from "node:assert/strict";
import { test } from "node:test";

import { dated_name } from "../src/controls/file_names";

const then = new Date(2026, 2, 1, 4, 5, 9);

test("a file's name says of what and when", () => {
  assert.equal(dated_name("liver", "png", then), "tact-liver-2026-03-01-040509.png");
  assert.equal(dated_name("", "csv", then), "tact-2026-03-01-040509.csv");
});

test("no scene's name leaves the folder", () => {
  assert.equal(dated_name("../my liver (2)", "tact", then), "tact-my-liver-2-2026-03-01-040509.tact");
});
