// SPDX-License-Identifier: Apache-2.0
// The page in Chromium when nothing comes any more: a stopped tactd or tact-view must not
// look alive.
//
//     node tests/browser/silence_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Picture: BUILD_DIR/page_silence.png. Prints "N passed, M failed";
// exit status 0 or 1.
import { join } from "node:path";

import { build, check, folder, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "silence.sock");

/** What a person reads, and how grey the numbers are. */
const seen = (page) =>
  page.evaluate(() => ({
    words: document.body.innerText,
    state: document.getElementById("state").textContent,
    grey: getComputedStyle(document.querySelector("#now .big")).filter === "grayscale(1)",
    plots: getComputedStyle(document.querySelector("#plots canvas")).opacity < 0.5,
    silence_s: window.tact.silence_s,
  }));
const is_alive = (page) =>
  waits(
    page,
    () =>
      window.tact.silence_s === 0 &&
      /^(armed|ready|stopped)$/.test(document.getElementById("state").textContent) &&
      getComputedStyle(document.querySelector("#now .big")).filter === "none",
  );

/** `child` is stopped for a while: what does the page say meanwhile, and how soon? */
async function halt(page, child, name, link_words) {
  await page.evaluate(() => {
    const state = document.getElementById("state");
    new MutationObserver(() => {
      // to the ms, under other load
      if (state.textContent.startsWith("no news")) window.reported_s ??= window.tact.silence_s;
    }).observe(state, { childList: true, characterData: true, subtree: true });
    window.reported_s = undefined;
    window.slowest_s = 0; // from picture to picture: a page that was busy has not listened
    let before_ms = performance.now();
    const picture = () => {
      window.slowest_s = Math.max(window.slowest_s, (performance.now() - before_ms) / 1000);
      before_ms = performance.now();
      if (window.reported_s === undefined) requestAnimationFrame(picture);
    };
    requestAnimationFrame(picture);
  });
  child.kill("SIGSTOP");
  check(`${name} that is stopped is reported`, await waits(page, () => window.reported_s !== undefined, null, 5000));
  const { reported_s, slowest_s } = await page.evaluate(() => ({ reported_s: window.reported_s, slowest_s: window.slowest_s }));
  check(
    "... 0.3 s after the last frame",
    reported_s > 0.3 && reported_s < 0.5 + 4 * slowest_s,
    `${reported_s.toFixed(2)} s, the slowest picture took ${slowest_s.toFixed(2)} s`,
  );
  const first = await seen(page);
  check(
    "... and how long it lasts",
    /^no news for \d+\.\d s$/.test(first.state) &&
      (await waits(page, (than_s) => window.tact.silence_s > than_s + 0.5, first.silence_s)),
    first.state,
  );
  check("... with grey numbers and plots", first.grey && first.plots);
  check("... nothing says that it is armed", !/\barmed\b/i.test(first.words), first.words.match(/.*armed.*/i)?.[0]);
  check("... and in words", link_words.test((await seen(page)).words));
}

async function run() {
  const { viewer, url } = await start_view(["--socket", socket]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  check(
    "is armed, and says so",
    await waits(
      page,
      () =>
        document.getElementById("state").textContent === "armed" && Number(document.getElementById("force").textContent) > 0.05,
    ),
  );
  await halt(page, tactd, "a tactd", /tactd is silent: what is shown is old/);
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(build, "page_silence.png") });
  tactd.kill("SIGCONT");
  check("news ends it", await is_alive(page));
  check("... the words too", !/silent/.test((await seen(page)).words));
  await halt(page, viewer, "a tact-view", /tactd is silent/);
  viewer.kill("SIGCONT");
  check("news ends that, too", await is_alive(page));
  check("tactd ends", (await stop(tactd)) !== null);
  check(
    "after its end nothing looks alive either",
    await waits(
      page,
      () => window.tact.link === "lost" && document.getElementById("state").textContent.startsWith("no news for"),
    ),
  );
  await page.close();
  await browser.close();
  await stop(viewer);
}

await play(run);
