// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { News } from "../src/link/news";

/** The silence that is reported last, of pictures so many ms apart from one time to another. */
function look(news: News, from_ms: number, to_ms: number, apart_ms: number, frame_rate_Hz = 60): number {
  let reported_s = 0;
  for (let now_ms = from_ms; now_ms <= to_ms; now_ms += apart_ms) reported_s = news.silence_s(now_ms, frame_rate_Hz);
  return reported_s;
}

test("silence is reported after 0.3 s, with how long it lasts", () => {
  const news = new News();
  news.frame(1000);
  assert.equal(look(news, 1010, 1300, 10), 0);
  assert.equal(look(news, 1310, 1310, 10), 0.31);
  assert.equal(look(news, 1320, 5000, 10), 4);
});

test("a frame ends it", () => {
  const news = new News();
  news.frame(1000);
  assert.ok(look(news, 1010, 3000, 10) > 0);
  news.frame(3000);
  assert.equal(look(news, 3010, 3200, 10), 0);
});

test("nothing is missed before the first frame", () => {
  assert.equal(look(new News(), 0, 9000, 10), 0);
});

test("frames that come rarely are waited for", () => {
  const news = new News();
  news.frame(0);
  assert.equal(look(news, 10, 2400, 10, 1), 0);
  assert.ok(look(news, 2410, 2600, 10, 1) > 2.5);
});

test("a page that was busy for a second has not listened, and waits for what has come meanwhile", () => {
  const news = new News();
  news.frame(0);
  assert.equal(news.silence_s(1000, 60), 0);
  assert.equal(news.silence_s(2000, 60), 0);
});
