// SPDX-License-Identifier: Apache-2.0
// The page in Chromium on screens of other sizes: does anything cover or cut anything, can a finger
// hit every button, and does axe-core find what a screen reader or a keyboard cannot use?
//
//     node tests/browser/layout_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// Takes long: run only by tools/check --long and --only browser.
// CHROMIUM names another browser. Pictures: BUILD_DIR/layout_NAME.png, the whole page of each screen, live,
// with help, with the choice of scenes, and of a replay. Prints "N passed, M failed"; exit status 0 or 1.
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { build, check, folder, play, root, start, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const axe = readFileSync(createRequire(join(root, "host/web/package.json")).resolve("axe-core/axe.min.js"), "utf8");
const socket = join(folder, "layout.sock");
const recording = join(folder, "layout.tactview");
const scenes = join(folder, "scenes");
const kFinger_px = 44;
/** A browser's zoom of 200 % halves the page's own pixels and doubles those of the screen. */
const kScreens = {
  phone: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true },
  phone_on_its_side: { viewport: { width: 844, height: 390 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true },
  tablet: { viewport: { width: 820, height: 1180 }, hasTouch: true, isMobile: true },
  tablet_on_its_side: { viewport: { width: 1180, height: 820 }, hasTouch: true, isMobile: true },
  desk: { viewport: { width: 1280, height: 800 } },
  zoom_200: { viewport: { width: 640, height: 400 }, deviceScaleFactor: 2 },
};

/** What is wrong with where things are, in words. */
function faults_of_layout(least_px) {
  const out = [];
  const box = (element) => element.getBoundingClientRect();
  const seen = (element) => element.checkVisibility() && box(element).width > 0;
  const name = (element) => element.id || `${element.tagName.toLowerCase()} in ${element.parentElement.id}`;
  const picture = document.getElementById("picture");
  const desk = document.getElementById("desk");
  const overlay = getComputedStyle(picture).position === "absolute"; // the picture lies behind the panels
  const parts = [...desk.querySelectorAll(".panel, .banner, .notice")].filter(seen);
  if (!overlay) parts.push(picture);
  const cover = (a, b) =>
    Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
  const pairs = (all) => all.flatMap((a, i) => all.slice(i + 1).map((b) => [a, b]));
  for (const [a, b] of pairs(parts)) if (cover(box(a), box(b))) out.push(`${name(a)} covers ${name(b)}`);
  const root = document.documentElement;
  if (root.scrollWidth > innerWidth) out.push(`the page is ${root.scrollWidth} px wide`);
  const scrolls = overlay ? innerHeight : root.scrollHeight;
  for (const part of parts) {
    const at = box(part);
    if (at.left < 0 || at.right > innerWidth + 1) out.push(`${name(part)} leaves the screen sideways`);
    if (at.top + scrollY < 0 || at.bottom + scrollY > scrolls + 1) out.push(`${name(part)} leaves the screen`);
    const hides = /hidden|clip/.test(getComputedStyle(part).overflowY);
    if (part !== picture && (part.scrollWidth > part.clientWidth + 1 || (hides && part.scrollHeight > part.clientHeight + 1)))
      out.push(`${name(part)} cuts what is in it`);
    for (const inner of part.querySelectorAll("*")) {
      if (!seen(inner) || inner.closest(".uplot, #stops, .bar")) continue;
      const text = box(inner);
      if (text.left < at.left - 1 || text.right > at.right + 1) out.push(`${name(inner)} leaves ${name(part)}`);
    }
  }
  const hit = [...document.querySelectorAll("button, .button, select, input")].filter(seen);
  const beneath = (a, b) => a.closest("#parameters") && b.closest("#request_end"); // these scroll there
  for (const [a, b] of pairs(hit)) if (!beneath(a, b) && cover(box(a), box(b))) out.push(`${name(a)} covers ${name(b)}`);
  for (const one of hit) {
    const { width, height } = box(one);
    if (width < least_px || height < least_px) out.push(`${name(one)} has ${width.toFixed(0)} x ${height.toFixed(0)} px`);
    if (one.scrollWidth > one.clientWidth + 1) out.push(`${name(one)} cuts its words`);
  }
  return out;
}

async function check_page(page, name, least_px) {
  const faults = await page.evaluate(faults_of_layout, least_px);
  check(`${name}: nothing covers or cuts anything`, faults.length === 0, faults.slice(0, 6).join("; "));
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document));
  check(
    `${name}: axe-core finds nothing`,
    violations.length === 0,
    violations
      .map(
        (v) =>
          `${v.id}: ${v.nodes
            .map((n) => n.target.join(" "))
            .slice(0, 3)
            .join(", ")}`,
      )
      .join("; "),
  );
  await page.screenshot({ path: join(build, `layout_${name}.png`), fullPage: true });
}

/** One button more. */
function offer_headset() {
  const offers = Object.assign(new EventTarget(), { isSessionSupported: async () => true });
  Object.defineProperty(navigator, "xr", { value: offers, configurable: true });
}

/** The scene with the most numbers; it is not asked for. */
async function open_picker(page) {
  await page.keyboard.press("l");
  await page.selectOption("#requested_scene", "gum");
  await page.waitForTimeout(200);
}

async function check_screen(browser, url, name, screen, condition, is_live) {
  const context = await browser.newContext(screen);
  const page = await context.newPage();
  if (is_live) await page.addInitScript(offer_headset);
  await page.goto(url);
  await waits(page, condition);
  if (is_live)
    check(`${name}: a headset is offered`, await waits(page, () => document.getElementById("headset").checkVisibility()));
  await page.waitForTimeout(1500);
  const least_px = screen.hasTouch ? kFinger_px : 20;
  await check_page(page, name, least_px);
  await page.keyboard.press("h");
  await page.waitForTimeout(200);
  await check_page(page, `${name}_help`, least_px);
  if (is_live) {
    await open_picker(page);
    await check_page(page, `${name}_picker`, least_px);
    const ends = await page.evaluate(() =>
      ["picker_title", "request_end"]
        .map((id) => document.getElementById(id).getBoundingClientRect())
        .every(({ top, bottom }) => top >= 0 && bottom <= innerHeight + 1),
    );
    check(`${name}: the choice of scenes opens with its head and its buttons in sight`, ends);
  }
  await context.close();
}

/** All that can be pressed is reached by the tab key alone, and is seen when it is. */
async function check_keyboard(browser, url, is_live) {
  const page = await browser.newPage({ viewport: kScreens.desk.viewport });
  await page.goto(url);
  await waits(page, () => window.tact.tick > 0);
  if (is_live) await open_picker(page);
  const wanted = await page.evaluate(() =>
    [...document.querySelectorAll("button, .button, select, input")].filter((one) => one.checkVisibility()).map((one) => one.id),
  );
  const reached = new Set();
  let unseen = [];
  for (let i = 0; i < wanted.length + 5; ++i) {
    await page.keyboard.press("Tab");
    const { id, outline } = await page.evaluate(() => ({
      id: document.activeElement.id,
      outline: getComputedStyle(document.activeElement).outlineStyle,
    }));
    if (wanted.includes(id) && outline === "none") unseen.push(id);
    reached.add(id);
  }
  check(
    "the tab key reaches all that can be pressed",
    wanted.every((id) => reached.has(id)),
    wanted.filter((id) => !reached.has(id)).join(" "),
  );
  check("... and shows where it is", unseen.length === 0, unseen.join(" "));
  await page.focus("#wire");
  await page.keyboard.press("Enter");
  check(
    "Enter presses what has the focus, and leaves it there",
    await page.evaluate(() => window.tact.wireframe && document.activeElement.id === "wire"),
  );
  await page.close();
}

/** Numbers that are old are grey, and can still be read. */
async function check_silence(browser, url, tactd) {
  const page = await browser.newPage(kScreens.phone);
  await page.goto(url);
  await waits(page, () => window.tact.link === "live" && window.tact.tick > 0);
  tactd.kill("SIGSTOP");
  await waits(page, () => window.tact.silence_s > 0);
  await page.waitForTimeout(500);
  await check_page(page, "phone_silent", kFinger_px);
  tactd.kill("SIGCONT");
  await page.close();
}

async function run() {
  mkdirSync(scenes);
  for (const scene of ["liver", "gum"])
    await start("tactd", [join(root, `model/scenes/${scene}.toml`), "--parameters", "--json", join(scenes, `${scene}.json`)])
      .ended;
  const { viewer, url } = await start_view(["--socket", socket, "--record", recording, "--figure", "--scenes", scenes]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  for (const [name, screen] of Object.entries(kScreens))
    await check_screen(browser, url, name, screen, () => window.tact.link === "live" && window.tact.tick > 0, true);
  await check_keyboard(browser, url, true);
  await check_silence(browser, url, tactd);
  await stop(tactd);
  const page = await browser.newPage(kScreens.phone);
  await page.goto(url);
  await waits(page, () => window.tact.link === "lost");
  await page.waitForTimeout(500);
  await check_page(page, "phone_lost", 20);
  await page.close();
  await stop(viewer);
  const replay = await start_view(["--open", recording]);
  for (const [name, screen] of Object.entries(kScreens))
    await check_screen(browser, replay.url, `replay_${name}`, screen, () => window.tact.link === "replay", false);
  await check_keyboard(browser, replay.url, false);
  await browser.close();
  await stop(replay.viewer);
}

await play(run);
