// SPDX-License-Identifier: Apache-2.0
// The page in Chromium without a mouse: keys turn the view and move the simulated hand.
//
//     node tests/browser/keys_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { check, distance, folder, numbers, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "keys.sock");

const goes = (page, axis, sign) =>
  page
    .evaluate(() => window.tact.tool_m)
    .then((from_m) =>
      waits(page, ([was_m, k, way]) => way * (window.tact.tool_m[k] - was_m[k]) > 0.005, [from_m, axis, sign], 20000),
    );

/** The view and the hand without a mouse. */
async function check_keys(page) {
  const press = async (key, times) => {
    for (let i = 0; i < times; ++i) await page.keyboard.press(key);
  };
  await page.keyboard.press("v");
  await page.waitForTimeout(300);
  const home = (await numbers(page)).camera_m;
  await press("ArrowRight", 3);
  await page.waitForTimeout(300);
  const turned = (await numbers(page)).camera_m;
  const { organ_m } = await numbers(page);
  const middle = organ_m[0].map((least, i) => 0.5 * (least + organ_m[1][i]));
  const angle = (at) => Math.atan2(at[1] - middle[1], at[0] - middle[0]);
  const by_deg = ((angle(home) - angle(turned)) * 180) / Math.PI;
  check("an arrow turns the view by 5 degrees", Math.abs(by_deg - 15) < 2, `${by_deg.toFixed(1)} of three`);
  await press("PageUp", 3);
  await page.waitForTimeout(300);
  const nearer = (await numbers(page)).camera_m;
  check("PageUp goes nearer", distance(nearer, middle) < 0.8 * distance(turned, middle));
  await page.keyboard.press("v");
  const up = goes(page, 2, 1);
  await press("Shift+ArrowUp", 15);
  check("with Shift an arrow moves the hand", await up);
  await page.keyboard.press("h");
  const help = await page.textContent("#keys");
  check("the help has these keys", /PgUp/.test(help) && /Shift \+ drag, arrows/.test(help));
  await page.focus("#keys");
  const before = (await numbers(page)).camera_m;
  await page.evaluate(() => (document.getElementById("keys").style.maxHeight = "200px"));
  await press("ArrowDown", 5);
  check(
    "in a panel that scrolls an arrow scrolls it",
    (await waits(page, () => document.getElementById("keys").scrollTop > 0, null, 5000)) &&
      distance(before, (await numbers(page)).camera_m) < 1e-6,
  );
  await page.evaluate(() => (document.getElementById("keys").style.maxHeight = ""));
  await page.keyboard.press("Escape");
}

await play(async () => {
  const { viewer, url } = await start_view(["--socket", socket]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  await waits(page, () => window.tact.link === "live" && window.tact.tick > 0);
  await check_keys(page);
  await browser.close();
  await stop(tactd);
  await stop(viewer);
});
