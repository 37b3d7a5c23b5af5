// SPDX-License-Identifier: Apache-2.0
// How long from a marker that moved to the picture of it? A marker body at the left hand steps aside;
// from the instant at which its observation is sent by UDP to the first picture of a Chromium in which
// the drawn wrist has gone half of the step. With its parts:
//
//     sent    to the first message in which the wrist moves: UDP, pose, the wait for the next frame of
//             tactd, WebSocket; heard by a second connection, in a thread that draws nothing
//     filter  from there to the first message with more than half: one-euro filter (host/pose/one_euro.h)
//     drawn   from there to the picture: the wait for it, and drawing. A monitor adds its own.
//
// Node's and the page's times are of the system's one clock, which is checked. A measurement, not a
// test: it says numbers and asserts none, but that every step was seen.
//
//     node tests/browser/operator_latency.mjs BUILD_DIR [STEPS] [--json FILE]
import { writeFileSync } from "node:fs";
import { loadavg } from "node:os";
import { join } from "node:path";

import { MarkerBody, description, free_udp_port } from "./marker_body.mjs";
import { check, folder, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const arguments_ = process.argv.slice(3);
const json_at = arguments_.indexOf("--json");
const out = json_at >= 0 ? arguments_.splice(json_at, 2)[1] : null;
const steps = Number(arguments_[0] ?? 60);
const kHome_m = [0.1, -0.3, 0.05];
const kStep_m = 0.04; // far below what counts as a jump of the tracker
const kRest_ms = 1200; // until the filter has settled
const kRate_Hz = 100;

const now_ms = () => performance.timeOrigin + performance.now();
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
const at_share = (list, share) => [...list].sort((a, b) => a - b)[Math.floor(share * (list.length - 1))];

/** Hears what the page hears, in a thread that draws nothing: when which y of the left wrist came. */
function listen_beside() {
  const sent = [];
  let wrist = -1;
  let frames = 0;
  self.onmessage = ({ data }) => {
    if (data === "send") return self.postMessage(sent);
    const socket = new WebSocket(data);
    socket.onmessage = (message) => {
      const at_ms = performance.timeOrigin + performance.now();
      const { kind, figure, joint_m } = JSON.parse(message.data);
      if (kind === "status" && figure) wrist = figure.joints.indexOf("left wrist");
      if (kind === "frame") socket.send(JSON.stringify({ seen: ++frames }));
      if (kind === "figure") sent.push([at_ms, joint_m[3 * wrist + 1]]);
    };
  };
}

/** In the page: when which y of the left wrist was drawn, and the listener beside it. */
function watch_page(listener) {
  window.drawn = [];
  const look = () => {
    const at = window.tact.drawn_figure_m?.["left wrist"];
    if (at) window.drawn.push([performance.timeOrigin + performance.now(), at[1]]);
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
  window.beside = new Worker(URL.createObjectURL(new Blob([`(${listener})()`])));
  window.beside.postMessage(`ws://${location.host}/live`);
}

/** Both lists, by the page's clock. */
function seen_in_page() {
  return new Promise((done) => {
    window.beside.onmessage = ({ data }) => done({ sent: data, drawn: window.drawn });
    window.beside.postMessage("send");
  });
}

/** Between which two numbers the page's clock is ahead of ours, ms, by what some questions leave. */
async function clock_ahead_ms(page) {
  let [least, most] = [-Infinity, Infinity];
  for (let i = 0; i < 100; ++i) {
    const before_ms = now_ms();
    const page_ms = await page.evaluate(() => performance.timeOrigin + performance.now());
    [least, most] = [Math.max(least, page_ms - now_ms()), Math.min(most, page_ms - before_ms)];
  }
  return [least, most];
}

/** Of one step, ms: sent, filter, drawn and all; null if it was not seen. */
function latency_ms({ sent, drawn }, sent_ms, next_ms) {
  const between = (list, from_ms, to_ms) => list.filter(([at_ms]) => at_ms > from_ms && at_ms <= to_ms);
  const mean = (list) => list.reduce((sum, [, y]) => sum + y, 0) / list.length;
  const [before, after] = [between(sent, sent_ms - 200, sent_ms), between(sent, next_ms - 200, next_ms)];
  if (before.length === 0 || after.length === 0) return null;
  const from_m = mean(before);
  const way_m = mean(after) - from_m;
  if (Math.abs(way_m) < 0.9 * kStep_m) return null;
  const first = (list, share) => between(list, sent_ms, next_ms).find(([, y]) => (y - from_m) / way_m > share)?.[0];
  const [moves, half, picture] = [first(sent, 0.05), first(sent, 0.5), first(drawn, 0.5)];
  return picture && { sent: moves - sent_ms, filter: half - moves, drawn: picture - half, all: picture - sent_ms };
}

await play(async () => {
  const port = await free_udp_port();
  const tracking = join(folder, "hand.tracking.toml");
  writeFileSync(tracking, description("left_hand", port));
  const socket = join(folder, "latency.sock");
  const { viewer, url } = await start_view(["--socket", socket, "--tracking", tracking]);
  const tactd = start_tactd("maintenance", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size, bypassCSP: true }); // for a worker from here
  await page.goto(url);
  const body = new MarkerBody(port, kHome_m, kRate_Hz);
  await waits(page, () => window.tact?.drawn_figure_m && window.tact.tracking_words === "");
  await page.evaluate(`(${watch_page})(${JSON.stringify(listen_beside.toString())})`);
  await sleep(3000);
  const [least_ms, most_ms] = await clock_ahead_ms(page);
  check(
    "page and script have one clock",
    least_ms < 1 && most_ms > -1,
    `${least_ms.toFixed(1)} .. ${most_ms.toFixed(1)} ms ahead`,
  );
  const sent_ms = [];
  for (let i = 0; i < steps; ++i) {
    const [x, y, z] = kHome_m;
    sent_ms.push(body.go([x, i % 2 === 0 ? y - kStep_m : y, z]));
    await sleep(kRest_ms + 50 * Math.random()); // in no step with the frames
  }
  const end_ms = now_ms();
  const seen = await page.evaluate(seen_in_page);
  body.stop();
  await browser.close();
  await stop(tactd);
  await stop(viewer);

  const all = sent_ms.map((at_ms, i) => latency_ms(seen, at_ms, sent_ms[i + 1] ?? end_ms));
  const good = all.filter((one) => one);
  check("every step was seen", good.length === steps, `${good.length} of ${steps}`);
  const during = ([at_ms]) => at_ms > sent_ms[0] && at_ms < end_ms;
  const per_s = (list) => (1000 * list.filter(during).length) / (end_ms - sent_ms[0]);
  const values = {
    steps,
    tracker_Hz: kRate_Hz,
    frames_per_s: per_s(seen.sent),
    pictures_per_s: per_s(seen.drawn),
    load: loadavg()[0],
  };
  for (const part of ["all", "sent", "filter", "drawn"]) {
    const list = good.map((one) => one[part]);
    values[part] = { median_ms: at_share(list, 0.5), p95_ms: at_share(list, 0.95) };
    console.log(`${part.padEnd(6)} median ${values[part].median_ms.toFixed(1)} ms, p95 ${values[part].p95_ms.toFixed(1)} ms`);
  }
  console.log(
    `${values.frames_per_s.toFixed(1)} frames and ${values.pictures_per_s.toFixed(1)} pictures a second; load ${values.load.toFixed(1)}`,
  );
  if (out) writeFileSync(out, JSON.stringify(values));
});
