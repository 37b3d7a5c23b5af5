// SPDX-License-Identifier: Apache-2.0
// What is shown of limits, of a tool inside the organ and of lost contact.

import assert from "node:assert/strict";
import { test } from "node:test";

import type { Frame, Contact } from "../src/link/protocol";
import { LimitNews } from "../src/panels/limit_news";

function frame(given: Partial<Frame>): Frame {
  return { state: 2, time_ns: 0, fault: 0, limit: 0, contact_losses: 0, contacts: [], ...given } as Frame;
}

const inside = [{ contact: 0, state: 3 } as Contact];

test("a limit of one frame stays readable for 1.5 s", () => {
  const news = new LimitNews();
  news.frame(frame({ limit: 7 }), 1000);
  news.frame(frame({}), 1016);
  assert.equal(news.shown(2400), 7);
  assert.match(news.name(2400), /^slew limited \(7\)$/);
  assert.equal(news.shown(2600), 0);
});

test("a fault stays until a reset", () => {
  const news = new LimitNews();
  news.frame(frame({ state: 3, fault: 103 }), 1000);
  assert.equal(news.shown(60_000), 103);
  news.frame(frame({ state: 1 }), 61_000);
  assert.equal(news.shown(61_000), 0);
});

test("while a sphere is inside the organ it is reported, also while the gate limits", () => {
  const news = new LimitNews();
  for (const limit of [0, 3, 10, 14]) {
    news.frame(frame({ limit, contacts: inside }), 1000);
    assert.equal(news.shown(1000), 14);
    assert.match(news.name(1000), /^Inside the organ: take the tool out/);
  }
});

test("a fault is shown before a tool inside", () => {
  const news = new LimitNews();
  news.frame(frame({ state: 3, fault: 104, contacts: inside }), 1000);
  assert.equal(news.shown(1000), 104);
});

test("contact lost is said for four seconds after the count has grown", () => {
  const news = new LimitNews();
  news.frame(frame({ contact_losses: 2 }), 1000);
  assert.equal(news.shown(1000), 0, "what was lost before the page looked is old");
  news.frame(frame({ contact_losses: 3 }), 2000);
  assert.equal(news.shown(5900), 15);
  assert.match(news.name(5900), /^contact lost \(15\)$/);
  assert.equal(news.shown(6100), 0);
});

test("contact lost and inside are said together", () => {
  const news = new LimitNews();
  news.frame(frame({}), 1000);
  news.frame(frame({ contact_losses: 1, limit: 15, contacts: inside }), 2000);
  assert.match(news.name(2000), /^contact lost · Inside the organ: take the tool out/);
});

test("a count that falls, as in a replay that goes back, is no loss", () => {
  const news = new LimitNews();
  news.frame(frame({ contact_losses: 5 }), 1000);
  news.frame(frame({ contact_losses: 0 }), 2000);
  assert.equal(news.shown(2000), 0);
});

test("a sought recording forgets the limits of another time", () => {
  const shown_after = (seconds: number, sought: boolean): number => {
    const news = new LimitNews();
    news.frame(frame({ time_ns: 5e9, limit: 7, contact_losses: 1 }), 1000, sought);
    news.frame(frame({ time_ns: 5e9 + 1e9 * seconds, contact_losses: 2 }), 1016, sought);
    return news.shown(1016);
  };
  assert.equal(shown_after(0.02, true), 7, "played on");
  for (const seconds of [-3, 3]) assert.equal(shown_after(seconds, true), 0, `sought by ${seconds} s`);
  assert.equal(shown_after(3, false), 7, "a live run with a gap");
});
