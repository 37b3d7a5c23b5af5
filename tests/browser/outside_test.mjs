// SPDX-License-Identifier: Apache-2.0
// The page in Chromium when organ or tool is not in the picture: does an arrow at its edge lead there?
//
//     node tests/browser/outside_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_outside.png, page_outside_phone.png. Prints "N passed, M
// failed"; exit status 0 or 1.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import {
  build,
  check,
  folder,
  numbers,
  play,
  root,
  size,
  start_browser,
  start_tactd,
  start_view,
  stop,
  waits,
} from "./stage.mjs";

const axe = readFileSync(createRequire(join(root, "host/web/package.json")).resolve("axe-core/axe.min.js"), "utf8");
const socket = join(folder, "outside.sock");
const phone = { width: 390, height: 844 };

const times = (m, p) => [0, 1, 2, 3].map((row) => m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]);

/** Where a place is on the screen, px, by the camera's matrices. */
async function screen_px(page, place_m) {
  const { camera } = await numbers(page);
  const [x, y, , w] = times(camera.projection, times(camera.view, place_m).slice(0, 3));
  const box = await page.locator("#view").boundingBox();
  return [box.x + (0.5 + (0.5 * x) / w) * box.width, box.y + (0.5 - (0.5 * y) / w) * box.height];
}

/** The right button shifts the view. */
async function shift(page, [from_x, from_y], [by_x, by_y], often) {
  for (let i = 0; i < often; ++i) {
    await page.mouse.move(from_x, from_y);
    await page.mouse.down({ button: "right" });
    await page.mouse.move(from_x + by_x, from_y + by_y, { steps: 4 });
    await page.mouse.up({ button: "right" });
  }
  await page.waitForTimeout(1500); // the view glides to its rest
}

/** What an arrow covers, and whether it leaves the picture. */
const faults_of = (page, id) =>
  page.evaluate((name) => {
    const box = (one) => one.getBoundingClientRect();
    const at = box(document.getElementById(name));
    const picture = box(document.getElementById("view"));
    const out = [];
    if (at.left < picture.left || at.right > picture.right || at.top < picture.top || at.bottom > picture.bottom)
      out.push("leaves the picture");
    for (const other of document.querySelectorAll(".panel, .banner, .notice, .arrow")) {
      const its = box(other);
      if (
        other.id !== name &&
        Math.min(its.right, at.right) > Math.max(its.left, at.left) + 1 &&
        Math.min(its.bottom, at.bottom) > Math.max(its.top, at.top) + 1
      )
        out.push(`lies on ${other.id}`);
    }
    return out;
  }, id);

/** An arrow that is there says where its thing is, and points to it. */
async function check_arrow(page, word, where, place_m) {
  const arrow = page.getByRole("img", { name: `the ${word} is outside the picture, ${where}` });
  check(
    `an arrow says that the ${word} is outside, ${where}`,
    await arrow.isVisible(),
    (await page.locator(`#to_${word}`).getAttribute("aria-label")) ?? "no name",
  );
  check("... in a word that is seen", (await page.locator(`#to_${word}`).innerText()).includes(word));
  const faults = await faults_of(page, `to_${word}`);
  check("... and covers nothing", faults.length === 0, faults.join(", "));
  const box = await page.locator(`#to_${word}`).boundingBox();
  const [x, y] = await screen_px(page, place_m);
  const off_px = [x - box.x - box.width / 2, y - box.y - box.height / 2];
  const angle = await page.locator(`#to_${word} i`).evaluate((one) => Number(/rotate\((.*)rad\)/.exec(one.style.transform)[1]));
  const along = (Math.cos(angle) * off_px[0] + Math.sin(angle) * off_px[1]) / Math.hypot(...off_px);
  check("... and points there", along > 0.97, `${along.toFixed(3)}, ${off_px.map((px) => px.toFixed(0))} px off`);
}

const hidden = (page) =>
  waits(page, () => document.getElementById("to_organ").hidden && document.getElementById("to_tool").hidden, null, 5000);
const middle_of = ([least, most]) => least.map((at_m, i) => (at_m + most[i]) / 2);

async function check_desk(page) {
  check("in the first view nothing is outside", await hidden(page));
  const { organ_m } = await numbers(page);
  await shift(page, [900, 350], [-350, 0], 3);
  await check_arrow(page, "organ", "to the left", middle_of(organ_m));
  check("the tool is outside, too", await page.isVisible("#to_tool"));
  check("... and the two do not cover each other", (await faults_of(page, "to_tool")).length === 0);
  await page.screenshot({ path: join(build, "page_outside.png") });
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document));
  check("axe-core finds nothing", violations.length === 0, violations.map((one) => one.id).join(" "));
  await page.keyboard.press("v");
  check("the first view has all of it again", await hidden(page));
  await shift(page, [640, 200], [0, 300], 3);
  await check_arrow(page, "organ", "below", middle_of(organ_m));
  await page.keyboard.press("v");
  check("... and again", await hidden(page));
  await page.mouse.move(640, 350);
  for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, -300);
  await page.waitForTimeout(1000);
  check("an organ that fills the picture is in it", await page.isHidden("#to_organ"));
}

async function check_phone(browser, url) {
  const page = await browser.newPage({ viewport: phone });
  await page.goto(url);
  await waits(page, () => window.tact.tick > 0);
  check("on a phone nothing is outside in the first view", await hidden(page));
  const { y, height } = await page.locator("#view").boundingBox();
  await shift(page, [100, y + height / 2], [250, 0], 2);
  await check_arrow(page, "organ", "to the right", middle_of((await numbers(page)).organ_m));
  await page.screenshot({ path: join(build, "page_outside_phone.png") });
  await page.close();
}

/** A scene whose organ lies where the tool is not. */
async function check_misplaced(page) {
  check("the tool of a misplaced scene is pointed at", await waits(page, () => !document.getElementById("to_tool").hidden));
  check("... and its organ is in the picture", await page.isHidden("#to_organ"));
  await check_arrow(page, "tool", "to the left", (await numbers(page)).tool_m);
}

async function run() {
  const { viewer, url } = await start_view(["--socket", socket]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  await waits(page, () => window.tact.link === "live" && window.tact.tick > 0);
  await check_desk(page);
  await check_phone(browser, url);
  await stop(tactd);
  const misplaced = start_tactd("liver", socket, ["--set", "organ.position_m=[0.0, 0.6, -0.03]"]);
  await waits(page, () => window.tact.link === "live" && window.tact.organ_m[0][1] > 0.4);
  await page.keyboard.press("v");
  await check_misplaced(page);
  await stop(misplaced);
  await page.close();
  await browser.close();
  await stop(viewer);
}

await play(run);
