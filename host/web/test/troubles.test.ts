// SPDX-License-Identifier: Apache-2.0
// What keeps the page from showing what is.

import assert from "node:assert/strict";
import { test } from "node:test";

import { header_text, Troubles, type Part } from "../src/panels/troubles";

const box = { hidden: true, textContent: "" };
globalThis.document = { getElementById: () => box } as unknown as Document;

function make(arrives: boolean) {
  const sent: string[] = [];
  const failing: (Part | null)[] = [];
  const state = { arrives };
  const troubles = new Troubles(
    async (text) => {
      if (state.arrives) sent.push(text);
      return state.arrives;
    },
    (part) => failing.push(part),
  );
  return { troubles, sent, failing, state };
}

test("a trouble is shown with its remedy until it is over, and sent once", async () => {
  const { troubles, sent, failing } = make(true);
  for (let i = 0; i < 3; ++i) {
    troubles.report("picture", "no WebGL", "take another browser");
    assert.equal(box.textContent, "no WebGL; take another browser; numbers and plots go on");
    assert.ok(!box.hidden);
    troubles.over("picture");
    assert.ok(box.hidden);
  }
  await troubles.flush();
  assert.deepEqual(sent, ["no WebGL"]);
  assert.deepEqual(failing.slice(0, 2), ["picture", null]);
});

test("what has not arrived is sent again", async () => {
  const { troubles, sent, state } = make(false);
  troubles.report("page", "an error");
  await troubles.flush();
  state.arrives = true;
  await troubles.flush();
  await troubles.flush();
  assert.deepEqual(sent, ["an error"]);
});

test("an error in one part does not end the others", () => {
  const { troubles, failing } = make(true);
  const error = console.error;
  console.error = () => undefined;
  assert.equal(
    troubles.guard("picture", () => {
      throw new TypeError("no mesh");
    }),
    false,
  );
  console.error = error;
  assert.match(box.textContent, /^error in the picture: TypeError: no mesh; numbers and plots go on$/);
  assert.deepEqual(failing, ["picture"]);
});

test("a line for the terminal is ASCII and short", () => {
  assert.equal(header_text("a\r\nb\u001b[2Jü"), "a  b [2J ");
  assert.equal(header_text("x".repeat(1000)).length, 200);
});
