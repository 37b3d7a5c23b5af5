// SPDX-License-Identifier: Apache-2.0
// tools/run as a person starts it, and its page in Chromium: another scene, another number of its law, and
// what happens to the force; requests that are refused, with a sentence, while the scene goes on.
//
//     node tests/browser/picker_test.mjs BUILD_DIR   (tools/run builds what is missing, there)
//
// Takes long: run only by tools/check --long and --only browser.
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_picker*.png. Prints "N passed, M failed"; exit status 0 or 1.
import { spawn } from "node:child_process";
import { join } from "node:path";

import {
  build,
  check,
  first_line,
  folder,
  numbers,
  play,
  root,
  size,
  start_at,
  start_browser,
  start_tactd,
  start_view,
  stop,
  waits,
} from "./stage.mjs";

const kScenes = ["grasper", "gum", "heart", "liver", "liver_source", "liver_twist", "maintenance", "skin"];
const kSoft = "set_rhombus.normal_stiffness_N_per_m";

const words = (page) => page.textContent("#picker_words");
const says = (page, text) => waits(page, (wanted) => document.getElementById("picker_words").textContent.includes(wanted), text);
const runs = (page, name) =>
  waits(
    page,
    (wanted) =>
      window.tact.link === "live" && window.tact.scene_name === wanted && window.tact.state === 2 && window.tact.tick > 0,
    name,
  );

/** Wholly on the screen, and nothing lies over it. */
const in_sight = (page, id) =>
  page.evaluate((wanted) => {
    const element = document.getElementById(wanted);
    const { left, right, top, bottom } = element.getBoundingClientRect();
    return (
      top >= 0 && bottom <= innerHeight && element.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2))
    );
  }, id);

/** The largest force of this many seconds, N. */
async function peak_N(page, seconds) {
  return page.evaluate(async (duration_ms) => {
    const begin = performance.now();
    let peak = 0;
    while (performance.now() - begin < duration_ms) {
      await new Promise((done) => requestAnimationFrame(done));
      peak = Math.max(peak, Math.hypot(...(window.tact.force_N ?? [0])));
    }
    return peak;
  }, seconds * 1000);
}

/** Types a number into its field, as a person does, and presses Enter. */
async function set(page, id, value) {
  await page.locator(`[id="${id}"]`).fill(value);
  await page.keyboard.press("Enter");
}

async function check_scenes(page) {
  check("the page of tools/run shows the liver", await runs(page, "liver"));
  check("... and offers scenes", await waits(page, () => document.getElementById("pick").checkVisibility()));
  await page.keyboard.press("l");
  const offered = await page.$$eval("#requested_scene option", (all) => all.map((one) => one.value));
  check("... all that are shipped", offered.join() === kScenes.join(), offered.join(" "));
  check("... with the numbers of the law that runs", (await page.locator(".parameter").count()) === 7);
  await page.selectOption("#requested_scene", "heart");
  check("what is chosen and not applied is reported", (await words(page)) === "heart is not applied yet", await words(page));
  await page.keyboard.press("Escape");
  await page.keyboard.press("p");
  await page.keyboard.press("l");
  await page.click("#apply");
  check("another scene is there when it was chosen, armed", await runs(page, "heart"));
  check("... and the page says so", await says(page, "heart runs, as shipped"), await words(page));
  check("... and a pause is over", !(await numbers(page)).paused);
}

async function check_numbers(page) {
  const shipped_N = await peak_N(page, 8);
  const shipped = Number(await page.inputValue(`[id="${kSoft}"]`));
  await set(page, kSoft, String(shipped / 4));
  check("a number of the law is changed from its field", await says(page, "heart runs, 1 changed"), await words(page));
  const soft_N = await peak_N(page, 8);
  check(
    "... and the force is another",
    soft_N > 0.01 && soft_N < 0.7 * shipped_N,
    `${shipped_N.toFixed(2)} N, then ${soft_N.toFixed(2)} N with a quarter of the stiffness`,
  );
  await page.screenshot({ path: join(build, "page_picker.png") });
}

async function check_refusals(page) {
  const scene_before = await page.evaluate(() => window.tact.tick);
  await set(page, kSoft, "1e14");
  check(
    "a number out of its range is refused with its range",
    await says(page, "is out of range; allowed: 0.01 .. "),
    await words(page),
  );
  check("... in sight, with the button", (await in_sight(page, "picker_words")) && (await in_sight(page, "apply")));
  await page.locator(`[id="${kSoft}"]`).fill("2000");
  check("... until a number is edited", (await words(page)) === "1 change not applied yet", await words(page));
  await set(page, kSoft, "1e5");
  check("what tactd refuses is reported in its words", await says(page, "law rhombus is too stiff"), await words(page));
  await page.reload();
  check("... and not to who comes later", await says(page, "heart runs, 1 changed"), await words(page));
  await waits(page, () => document.getElementById("pick").checkVisibility());
  await page.keyboard.press("l");
  await set(page, kSoft, "");
  check("no number is none", await says(page, "has no number"), await words(page));
  await page.locator(`[id="${kSoft}"]`).fill("1,5");
  await page.click("#apply");
  check(
    "... a decimal comma is reported",
    await says(page, "normal_stiffness_N_per_m: 1,5 is no number: write 1.5"),
    await words(page),
  );
  check("... in its place", (await page.evaluate(() => document.activeElement.id)) === kSoft && (await in_sight(page, kSoft)));
  check(
    "... and the scene before has gone on",
    await waits(
      page,
      (before) => window.tact.link === "live" && window.tact.scene_name === "heart" && window.tact.tick > before,
      scene_before,
    ),
  );
}

/** Another page, by touch. */
async function check_phone(browser, url, page) {
  const phone = await browser.newPage({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  await phone.goto(url);
  await waits(phone, () => document.getElementById("pick").checkVisibility());
  await phone.tap("#pick");
  check(
    "on a phone the panel opens at its top",
    (await in_sight(phone, "picker_title")) && (await in_sight(phone, "requested_scene")),
  );
  await set(phone, kSoft, "1e14");
  check("... and a refusal is in sight there", (await says(phone, "is out of range")) && (await in_sight(phone, "picker_words")));
  await phone.screenshot({ path: join(build, "page_picker_phone.png") });
  await phone.tap("#as_shipped");
  check("as shipped gives the scene back", await says(phone, "heart runs, as shipped"), await words(phone));
  check("... and another page hears of it", await says(page, "the scene was chosen elsewhere: heart runs"), await words(page));
  await phone.close();
}

/** The slider moves by the keyboard, is read aloud, and moves the field. */
async function check_slider(page) {
  const id = kSoft.replace("set_", "slide_");
  const before = Number(await page.inputValue(`[id="${kSoft}"]`));
  await page.focus(`[id="${id}"]`);
  await page.keyboard.press("ArrowRight");
  const after = Number(await page.inputValue(`[id="${kSoft}"]`));
  check("an arrow key moves a slider and its field", after > before, `${before} N/m, then ${after} N/m`);
  check("... and it is read with its unit", (await page.getAttribute(`[id="${id}"]`, "aria-valuetext")) === `${after} N/m`);
  await page.focus(`[id="${kSoft}"]`);
  await page.keyboard.press("End");
  await page.keyboard.type("e1");
  check("letters in a field are no keys of the page", !(await numbers(page)).eyes_on && (await page.isVisible("#picker")));
  await page.keyboard.press("Escape");
  check(
    "Escape closes the panel, and the focus is where it was opened",
    !(await page.isVisible("#picker")) && (await page.evaluate(() => document.activeElement.id)) === "pick",
  );
}

/** Where no launcher could start another scene, none is offered. */
async function check_nothing_offered(browser) {
  const socket = join(folder, "alone.sock");
  const { viewer, url } = await start_view(["--socket", socket]);
  const tactd = start_tactd("liver", socket);
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  check("without a launcher nothing is offered", (await runs(page, "liver")) && !(await page.isVisible("#pick")));
  await page.keyboard.press("l");
  check("... by the key neither", !(await page.isVisible("#picker")));
  await page.close();
  await stop(tactd);
  await stop(viewer);
}

/** Of a tactd that has only just begun: a shell lets it ignore SIGINT until it says otherwise. */
async function check_early_end(environment) {
  const launcher = start_at(join(root, "tools/run"), ["--port", "8397"], environment);
  launcher.stdout.resume();
  // The one with a scene and nothing else; builtins alone, as it has only some milliseconds.
  const when_it_begins = `while read -ra all </proc/$0/task/$0/children; [[ -d /proc/$0 ]]; do
    for one in "\${all[@]}"; do
      mapfile -d "" words 2>/dev/null </proc/$one/cmdline
      [[ \${words[0]-} == */tactd && \${#words[@]} -eq 2 ]] && { kill -INT $0; exit; }
    done
  done`;
  spawn("bash", ["-c", when_it_begins, String(launcher.pid)]);
  const status = await Promise.race([launcher.ended, new Promise((done) => setTimeout(done, 20000, "none"))]);
  check("Ctrl-C in the first moments ends tools/run and its programs", [0, 130].includes(status), `status ${status}`);
  if (status === "none") launcher.kill("SIGTERM"); // a second one is heard
  await launcher.ended;
}

async function run() {
  const browser = await start_browser();
  await check_nothing_offered(browser);
  const environment = { ...process.env, XDG_RUNTIME_DIR: folder, XDG_STATE_HOME: folder };
  const launcher = start_at(join(root, "tools/run"), ["--port", "8397"], environment);
  try {
    const url = (await first_line(launcher, "tact-view: ")).replace("tact-view: ", "");
    const page = await browser.newPage({ viewport: size });
    await page.goto(url);
    await check_scenes(page);
    await check_numbers(page);
    await check_refusals(page);
    await check_phone(browser, url, page);
    await check_slider(page);
  } finally {
    launcher.kill("SIGTERM"); // it ends its own programs; SIGKILL would leave them
    check("tools/run ends cleanly", (await launcher.ended) === 0);
  }
  await check_early_end(environment);
  await browser.close();
}

await play(run);
