// SPDX-License-Identifier: Apache-2.0
// The page in Chromium with an emulated headset (iwer, which the test alone injects): is the organ at life size before
// both eyes, does its wearer learn what happens, does a headset command nothing, is the desk as before when it ends?
//
//     node tests/browser/headset_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// Takes long: run only by tools/check --long and --only browser.
// No real headset: that a picture comes to lenses in time is not tested. CHROMIUM names another browser. Pictures:
// BUILD_DIR/page_headset.png, page_headset_stop.png. Prints "N passed, M failed"; exit status 0 or 1.
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { distance_of, emulate_headset, look_down, place_of, seen_by, times } from "./emulated_headset.mjs";
import {
  check,
  distance,
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

const socket = join(folder, "headset.sock");
const kEyes_m = [0.45, 0, 0.35]; // host/web/README.md
const kNear_m = 1e-4;

/** The liver's least and greatest corner as its file has it, m. */
function true_corners_m() {
  const at_m = [0, 0, -0.03]; // organ.position_m of liver.toml
  const least = [Infinity, Infinity, Infinity];
  const most = [-Infinity, -Infinity, -Infinity];
  for (const line of readFileSync(join(root, "model/scenes/meshes/liver_3116.obj"), "utf8").split("\n")) {
    if (!line.startsWith("v ")) continue;
    line
      .split(/\s+/)
      .slice(1, 4)
      .map(Number)
      .forEach((mm, i) => {
        least[i] = Math.min(least[i], mm * 1e-3 + at_m[i]);
        most[i] = Math.max(most[i], mm * 1e-3 + at_m[i]);
      });
  }
  return [least, most];
}

async function check_size(page) {
  const { headset, organ_m } = await numbers(page);
  const ipd_m = await page.evaluate(() => window.emulated.ipd);
  const [least, most] = true_corners_m();
  const middle_m = least.map((at_m, i) => (at_m + most[i]) / 2);
  check("two eyes look", headset.eyes.length === 2);
  for (const [name, eye, side] of [
    ["left", headset.eyes[0], -0.5],
    ["right", headset.eyes[1], 0.5],
  ]) {
    const true_m = [kEyes_m[0], side * ipd_m, kEyes_m[2]];
    check(
      `the ${name} eye is where a person's is`,
      distance(place_of(eye), true_m) < kNear_m,
      place_of(eye).map((m) => m.toFixed(4)),
    );
    const left = seen_by(eye, [middle_m[0], organ_m[0][1], 0]);
    const right = seen_by(eye, [middle_m[0], organ_m[1][1], 0]);
    const wide_m = (right.right - left.right) * (true_m[0] - middle_m[0]);
    check(
      `... the organ before it has its width`,
      Math.abs(wide_m - (most[1] - least[1])) < kNear_m && most[1] - least[1] > 0.09,
      `${(wide_m * 1e3).toFixed(2)} of ${((most[1] - least[1]) * 1e3).toFixed(2)} mm`,
    );
    const origin = seen_by(eye, [0, 0, 0]);
    check(
      `... at an arm's reach before and below it`,
      Math.abs(origin.depth_m - kEyes_m[0]) < kNear_m &&
        Math.abs(origin.up * origin.depth_m + kEyes_m[2]) < kNear_m &&
        Math.abs(origin.right * origin.depth_m + true_m[1]) < kNear_m,
    );
  }
}

/** Who went aside and turned has the scene before the eyes again. */
async function check_recentring(page) {
  const before = (await numbers(page)).headset.eyes;
  await page.evaluate(() => {
    window.emulated.position.set(0.3, 1.6, -0.2);
    window.emulated.quaternion.set(0, Math.sin(0.4), 0, Math.cos(0.4));
  });
  await page.waitForTimeout(300);
  const moved = (await numbers(page)).headset.eyes;
  check("who moves the head moves the eyes", distance(place_of(moved[0]), place_of(before[0])) > 0.3);
  await page.evaluate(() => window.emulated.recenter());
  await page.waitForTimeout(300);
  const after = (await numbers(page)).headset.eyes;
  check(
    "the headset's recentring brings the scene before the eyes again",
    after.every((eye, i) => distance_of(eye.view, before[i].view) < kNear_m),
  );
}

async function check_picture(page) {
  const tissue = await look_down(page, "page_headset.png");
  check(
    "both eyes see tissue",
    tissue.every((share) => share > 0.003),
    tissue.map((s) => `${(100 * s).toFixed(1)} %`).join(", "),
  );
  const { headset } = await numbers(page);
  const in_view = headset.eyes.every((eye) =>
    headset.panel_m.every((corner_m) => {
      const [x, y, , w] = times(eye.projection, times(eye.view, corner_m));
      return w > 0 && Math.abs(x / w) < 1 && Math.abs(y / w) < 1;
    }),
  );
  check("who looks at the organ has the panel in view, with both eyes", in_view);
  check(
    "the panel says state and force",
    await waits(page, () => {
      const { shown } = window.tact.headset;
      return shown.includes("armed") && shown.includes("live") && shown.some((line) => /^\d+\.\d\d N$/.test(line));
    }),
    headset.shown.join(" | "),
  );
}

/** Trigger, grip, stick and fingers: nothing goes to tact-view but how many frames were seen. */
async function check_hands(page, sent) {
  const state = ({ link, wireframe, paused, figure_on, camera }) =>
    JSON.stringify({ link, wireframe, paused, figure_on, camera });
  const before = await numbers(page);
  const from = sent.length;
  await page.evaluate(async () => {
    const rest = (ms) => new Promise((done) => setTimeout(done, ms));
    const { controllers, hands } = window.emulated;
    for (const hand of [controllers.right, controllers.left]) {
      for (const button of ["trigger", "squeeze"]) {
        hand.updateButtonValue(button, 1);
        hand.position.set(0, 1.25, -0.45); // in the organ
        await rest(60);
        hand.updateButtonValue(button, 0);
        await rest(60);
      }
      hand.updateAxes("thumbstick", 0.8, -0.8);
      await rest(200);
    }
    window.emulated.primaryInputMode = "hand";
    await rest(100);
    hands.right.updatePinchValue(1);
    await rest(300);
    hands.right.updatePinchValue(0);
    window.emulated.primaryInputMode = "controller";
    await rest(300);
  });
  const after = await numbers(page);
  const others = sent.slice(from).filter((text) => !/^\{"seen":\d+\}$/.test(text));
  check("controllers and hands send tact-view nothing", sent.length > from && others.length === 0, others[0]);
  check("... and change nothing on the page", state(before) === state(after) && after.headset.on);
}

async function check_silence(page, tactd) {
  tactd.kill("SIGSTOP");
  check(
    "the panel shows a silence, and marks what is old",
    await waits(page, () => {
      const { shown, alarm } = window.tact.headset;
      return (
        alarm &&
        shown.some((line) => line.startsWith("no news for")) &&
        shown.some((line) => line.startsWith("old: ")) &&
        shown.includes("silent") &&
        !shown.includes("armed")
      );
    }),
    (await numbers(page)).headset.shown.join(" | "),
  );
  tactd.kill("SIGCONT");
  // A controller that stood still for 0.3 s has latched a fault: its wearer learns of that, with nothing old.
  const said = () => {
    const { shown } = window.tact.headset;
    return shown.length > 0 && !shown.some((line) => /^no news for|^old: |^silent$/.test(line)) && !shown.includes("armed");
  };
  check("... and its end, with the fault of the pause", await waits(page, said), (await numbers(page)).headset.shown.join(" | "));
  await page.evaluate(() => window.lay_aside(true));
  await page.waitForTimeout(600);
  tactd.kill("SIGSTOP");
  check(
    "with the headset laid aside the desk shows a silence all the same",
    await waits(page, () => document.getElementById("state").textContent.startsWith("no news for"), null, 5000),
  );
  tactd.kill("SIGCONT");
  await page.evaluate(() => window.lay_aside(false));
  await waits(page, said); // what is frozen then
  await page.keyboard.press("p");
  check(
    "a frozen display is reported as such",
    await waits(
      page,
      () =>
        window.tact.headset.shown.some((line) => /frozen/.test(line)) &&
        window.tact.headset.shown.some((line) => line.startsWith("old: ")),
    ),
  );
  await page.keyboard.press("p");
  await waits(page, said);
}

async function check_end(page, before) {
  check("the desk says where the picture is", /in the headset/.test(await page.textContent("#headset_words")));
  await page.evaluate(() => window.emulated.activeSession.end());
  check("a session that the headset ends is over", await waits(page, () => !window.tact.headset.on));
  await page.waitForTimeout(500);
  const after = await numbers(page);
  const off = ["projection", "view"].map((name) => distance_of(after.camera[name], before.camera[name]));
  check(
    "... and the desk sees what it saw before",
    off.every((much) => much < 1e-9),
    off.join(", "),
  );
  check("... and says so", (await page.textContent("#headset_word")) === "Enter VR" && (await page.isHidden("#headset_words")));
  check("... and the picture goes on", await waits(page, (tick) => window.tact.tick > tick, after.tick));
}

async function check_stop(page, tactd) {
  await page.click("#headset");
  await waits(page, () => window.tact.headset.on);
  check("tactd ends", (await stop(tactd)) !== null);
  check(
    "the panel shows that tactd went away",
    await waits(page, () => {
      const { shown, alarm } = window.tact.headset;
      return (
        alarm &&
        shown.includes("connection lost") &&
        shown.some((line) => /tactd went away/.test(line)) &&
        !shown.includes("armed")
      );
    }),
    (await numbers(page)).headset.shown.join(" | "),
  );
  await look_down(page, "page_headset_stop.png");
  await page.keyboard.press("x");
  check("X leaves it", await waits(page, () => !window.tact.headset.on));
}

async function check_without(browser, url) {
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  await waits(page, () => window.tact.tick > 0);
  await page.waitForTimeout(500);
  check("without a headset nothing is offered", await page.isHidden("#headset"));
  await page.keyboard.press("x");
  check("... by no key either", await page.isHidden("#headset_words"));
  await page.close();
}

async function run() {
  const { viewer, url } = await start_view(["--socket", socket]);
  let tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  await check_without(browser, url);
  const page = await browser.newPage({ viewport: size });
  const complaints = [];
  const sent = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("websocket", (web) => web.on("framesent", ({ payload }) => sent.push(String(payload))));
  await emulate_headset(page);
  await page.goto(url);
  check(
    "a headset is offered by a button with its words",
    await waits(
      page,
      () =>
        document.getElementById("headset").checkVisibility() &&
        document.getElementById("headset").innerText.startsWith("Enter VR"),
    ),
  );
  await page.waitForTimeout(500);
  const before = await numbers(page);
  await page.click("#headset");
  check("the session starts", await waits(page, () => window.tact.headset?.on && window.tact.headset.eyes.length === 2));
  await page.waitForTimeout(500);
  await check_size(page);
  await check_recentring(page);
  await check_picture(page);
  await check_hands(page, sent);
  await check_silence(page, tactd);
  await check_end(page, before);
  await check_stop(page, tactd);
  check("has no error on the console", complaints.length === 0, complaints.slice(0, 3).join("; "));
  await page.close();
  await browser.close();
  await stop(viewer);
}

await play(run);
