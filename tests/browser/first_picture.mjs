// SPDX-License-Identifier: Apache-2.0
// How long until a person sees tissue? From the start of tact-view, with tactd started beside it as
// tools/run does, to the first picture drawn by a Chromium that opens the link as soon as it is printed.
// The browser itself runs already. A measurement, not a test: it says numbers and asserts none.
//
//     node tests/browser/first_picture.mjs BUILD_DIR [RUNS]
import { join } from "node:path";

import { folder, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const runs = Number(process.argv[3] ?? 7);
const round = (list) => list.map((ms) => Math.round(ms)).join(" ");
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

/** ms from the start of tact-view. */
async function one_run(browser, number) {
  const socket = join(folder, `first-${number}.sock`);
  const page = await browser.newPage({ viewport: size });
  const begin_ms = performance.timeOrigin + performance.now();
  const { viewer, url } = await start_view(["--socket", socket]);
  const ready_ms = performance.timeOrigin + performance.now();
  const tactd = start_tactd("liver", socket);
  await page.goto(url, { waitUntil: "commit" });
  await waits(page, () => window.tact?.first_drawn_ms);
  const measured = await page.evaluate(() => ({
    drawn_ms: window.tact.first_drawn_ms,
    opened_ms: performance.timeOrigin,
    steps: performance.getEntriesByType("mark").map((mark) => [mark.name, performance.timeOrigin + mark.startTime]),
    loads: performance
      .getEntriesByType("resource")
      .map((one) => [
        one.name.replace(/.*\//, ""),
        performance.timeOrigin + one.startTime,
        performance.timeOrigin + one.responseEnd,
      ]),
  }));
  await page.close();
  await stop(tactd);
  await stop(viewer);
  if (process.env.STEPS) {
    for (const [name, at, end] of [
      ["link printed", ready_ms],
      ["page opened", measured.opened_ms],
      ...measured.steps,
      ...measured.loads,
    ])
      console.log(`   ${Math.round(at - begin_ms)} ${end ? Math.round(end - begin_ms) : ""} ${name}`);
  }
  return measured.drawn_ms - begin_ms;
}

async function run() {
  const browser = await start_browser();
  const all_ms = [];
  for (let i = 0; i < runs; ++i) all_ms.push(await one_run(browser, i));
  console.log(
    `first picture, ms: ${round(all_ms)}; median ${Math.round(median(all_ms))}, worst ${Math.round(Math.max(...all_ms))}`,
  );
  await browser.close();
}

await play(run);
