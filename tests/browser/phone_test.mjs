// SPDX-License-Identifier: Apache-2.0
// The page in Chromium on a phone, 390 x 844: is the tool in the first view of each scene, and in what the eyes of a
// tracked operator see, wherever its script goes?
//
//     node tests/browser/phone_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_phone_SCENE.png. Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { description } from "./recorded_looks.mjs";
import { build, check, folder, play, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const phone = { width: 390, height: 844 };
const kWatched_s = 8; // of the script, from its begin

/** The tool's tip on the screen in each picture for a while: how far inside the edge of the picture it stays, px. */
const least_inside_px = (page, seconds) =>
  page.evaluate(async (watched_s) => {
    const times = (m, p) => [0, 1, 2, 3].map((row) => m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]);
    let least_px = Infinity;
    while (window.tact.time_s < watched_s) {
      await new Promise((done) => requestAnimationFrame(done));
      if (window.tact.tick === 0) continue;
      const { camera, tool_m } = window.tact;
      const [x, y, , w] = times(camera.projection, times(camera.view, tool_m).slice(0, 3));
      const box = document.getElementById("view").getBoundingClientRect();
      const [x_px, y_px] = [(0.5 + (0.5 * x) / w) * box.width, (0.5 - (0.5 * y) / w) * box.height];
      least_px = Math.min(least_px, w > 0 ? Math.min(x_px, box.width - x_px, y_px, box.height - y_px) : -1);
    }
    return least_px;
  }, seconds);

async function check_scene(browser, scene, name = scene, options = [], watched_s = kWatched_s) {
  const socket = join(folder, `${name.replaceAll(" ", "_")}.sock`);
  const { viewer, url } = await start_view(["--socket", socket, ...options]);
  const page = await browser.newPage({ viewport: phone });
  await page.goto(url);
  await waits(page, () => document.getElementById("notice").textContent.includes("waiting for tactd"));
  const tactd = start_tactd(scene, socket);
  const inside_px = await least_inside_px(page, watched_s);
  check(`the tool of ${name} is in the picture of a phone`, inside_px > 20, `${inside_px.toFixed(0)} px inside`);
  check("... and the picture is on the screen", (await page.locator("#view").boundingBox()).y + 240 < phone.height);
  await page.screenshot({ path: join(build, `page_phone_${name.replaceAll(" ", "_")}.png`) });
  await page.close();
  await stop(tactd);
  await stop(viewer);
}

await play(async () => {
  const browser = await start_browser();
  for (const scene of ["gum", "liver", "skin", "maintenance"]) await check_scene(browser, scene);
  await check_scene(browser, "maintenance", "maintenance with its tracker", ["--tracking", description], 12); // he looks away
  await browser.close();
});
