// SPDX-License-Identifier: Apache-2.0
// The page in Chromium: is the surface drawn as deep as the tip that presses it, in every picture until it lifts off?
//
//     node tests/browser/indentation_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { check, folder, open_waiting, play, start_browser, start_tactd, stop } from "./stage.mjs";

/** Least and largest share of the tip's depth that is drawn. */
const drawn_ratios = (page) =>
  page.evaluate(async () => {
    const seen = [];
    let last = 0;
    let frames = 0;
    for (let n = 0; n < 20000 && (last > 0 || seen.length === 0); ++n) {
      await new Promise((done) => requestAnimationFrame(done));
      const ratios = window.tact.drawn_ratios;
      seen.push(...ratios);
      last = ratios.length;
      frames += last > 0 ? 1 : 0;
    }
    return { frames, lifted: last === 0, least: Math.min(...seen), most: Math.max(...seen) };
  });

await play(async () => {
  const browser = await start_browser();
  const socket = join(folder, "tactd.sock");
  const { viewer, page } = await open_waiting(browser, socket);
  const tactd = start_tactd("skin", socket);
  const { frames, lifted, least, most } = await drawn_ratios(page);
  check("sees the tip press", frames > 5, `${frames} frames`);
  check("sees it lift off", lifted);
  check("draws the surface as deep as it", least >= 0.9 && most < 1.3, `${least.toFixed(3)} .. ${most.toFixed(3)}`);
  await page.close();
  await stop(tactd);
  await stop(viewer);
  await browser.close();
});
