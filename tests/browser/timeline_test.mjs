// SPDX-License-Identifier: Apache-2.0
// A recording in Chromium: its timeline by mouse and keys, words that are not of now, saved pictures with
// their date, values of the plots, and a simulated hand that a finger closes and opens.
//
//     node tests/browser/timeline_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// Takes long: run only by tools/check --long and --only browser.
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_replay.png, page_saved.png, page_stall.png. Prints "N
// passed, M failed"; exit status 0 or 1.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";

import { check_sought } from "./sought_recording.mjs";
import { build, check, folder, numbers, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "timeline.sock");
const recording = join(folder, "run.tactview");
const seen_s = (page) => page.evaluate(() => Number(document.getElementById("seek").value));
const text = (page, id) => page.textContent(`#${id}`);

/** When the recording has a frame, s since its start: a slow PC leaves gaps of 0.2 s. */
let frame_at_s = [];
let force_at_N = [];
/** Where a jump to this time leads: to the first frame that is not before it. */
const lands_s = (at_s) => frame_at_s.find((one_s) => one_s >= at_s - 1e-6) ?? frame_at_s.at(-1);

function read_frames() {
  const table = join(folder, "run.csv");
  execFileSync(join(build, "tact-view"), ["--open", recording, "--export", table]);
  const [head, ...rows] = readFileSync(table, "utf8")
    .trim()
    .split("\n")
    .filter((line) => !line.startsWith("#"))
    .map((line) => line.split(","));
  const time_s = rows.map((row) => 1e-9 * Number(row[head.indexOf("time_ns")]));
  frame_at_s = time_s.map((one_s) => one_s - time_s[0]);
  const force = ["x", "y", "z"].map((axis) => head.indexOf(`force_${axis}_N`));
  force_at_N = rows.map((row) => Math.hypot(...force.map((column) => Number(row[column]))));
}

/** At this time, and there it stays. */
async function rests_at(page, at_s, slack_s = 0.06) {
  const came = await waits(
    page,
    ([wanted_s, most_s]) => Math.abs(Number(document.getElementById("seek").value) - wanted_s) < most_s,
    [at_s, slack_s],
    5000,
  );
  await page.waitForTimeout(300);
  return came && Math.abs((await seen_s(page)) - at_s) < slack_s;
}

/** The grip by touch, and a run of some seconds to replay. */
async function check_grip(browser, url) {
  const context = await browser.newContext({ viewport: { width: 820, height: 1180 }, hasTouch: true, isMobile: true });
  const page = await context.newPage();
  await page.goto(url);
  check(
    "a simulated hand is offered",
    await waits(
      page,
      () => window.tact.link === "live" && window.tact.tick > 0 && document.getElementById("close_grip").checkVisibility(),
    ),
  );
  check("has no timeline while it is live", !(await page.isVisible("#timeline")));
  await page.tap("#close_grip");
  check(
    "a finger closes the grip",
    await waits(page, () => ["closed", "holds tissue"].includes(document.getElementById("grip").textContent)),
    await text(page, "grip"),
  );
  await page.tap("#open_grip");
  check("... and lets go", await waits(page, () => document.getElementById("grip").textContent === "open"));
  await page.tap("#hand");
  const before = await numbers(page);
  const touch = await context.newCDPSession(page);
  const fingers = (type, points) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await fingers("touchStart", [{ x: 400, y: 700, id: 0 }]);
  for (let i = 1; i <= 15; ++i) await fingers("touchMove", [{ x: 400, y: 700 - 8 * i, id: 0 }]);
  await fingers("touchEnd", []);
  check("a finger moves the hand", await waits(page, (from_m) => window.tact.tool_m[2] > from_m + 0.005, before.tool_m[2]));
  await context.close();
}

async function check_words(page) {
  const { words } = await page.evaluate(() => ({ words: document.body.innerText }));
  check(
    "says nothing as if it were so now",
    /was armed/.test(words) && /force was on/.test(words) && !/force is on|\blive\b|(?<!was )armed/.test(words),
    words.match(/.*(armed|\blive\b).*/)?.[0],
  );
  check("offers no hand", !(await page.isVisible("#hand")) && !(await page.isVisible("#close_grip")));
  check("its title says what it is", /replay/.test(await page.title()));
}

async function check_keys(page) {
  await page.keyboard.press("Space");
  check("Space rests it", await waits(page, () => document.getElementById("play_word").textContent === "Play"));
  await page.keyboard.press("Home");
  check("Home is its start", await rests_at(page, 0));
  for (let i = 0; i < 3; ++i) {
    const goes_to_s = lands_s((await seen_s(page)) + 1);
    await page.keyboard.press("ArrowRight");
    check("an arrow goes on by a second", await rests_at(page, goes_to_s), goes_to_s.toFixed(3));
  }
  const back_s = lands_s((await seen_s(page)) - 1);
  await page.keyboard.press("ArrowLeft");
  check("... and back", await rests_at(page, back_s));
  await page.keyboard.press("Home");
  for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
  const longest_gap_s = Math.max(...frame_at_s.map((one_s, i) => one_s - (frame_at_s[i - 1] ?? 0)));
  check("three at once are three seconds", await rests_at(page, 3 + longest_gap_s, 2 * longest_gap_s + 0.01));
  await page.keyboard.press("Home");
  check("and Home is the start again", await rests_at(page, 0));
  const next_s = lands_s(0.0015);
  await page.keyboard.press("Shift+ArrowRight");
  check("with Shift by one frame", await rests_at(page, next_s, 0.002), `${next_s.toFixed(3)} s`);
  await page.keyboard.press("ArrowDown");
  check("the down arrow halves the speed", await waits(page, () => document.getElementById("speed").value === "0.5"));
  await page.keyboard.press("ArrowUp");
  await waits(page, () => document.getElementById("speed").value === "1");
  await page.keyboard.press("End");
  check("End is its end", await rests_at(page, Number(await page.getAttribute("#seek", "max"))));
  check(
    "a stop on request is not one by a fault",
    (await waits(page, () => document.getElementById("state_words").textContent === "force was off: stopped on request")) &&
      !/fault/.test(await page.evaluate(() => document.body.innerText)),
    await text(page, "state_words"),
  );
  await page.keyboard.press("Home");
  await rests_at(page, 0);
  await page.keyboard.press("n");
  check("N finds where it was stopped", await waits(page, () => /stopped/.test(document.getElementById("state").textContent)));
}

async function check_mouse(page) {
  const at = await page.locator("#seek").boundingBox();
  const length_s = Number(await page.getAttribute("#seek", "max"));
  await page.mouse.click(at.x + at.width / 2, at.y + at.height / 2);
  check("a click on the bar goes there", await rests_at(page, lands_s(length_s / 2), 0.1));
  await page.click("#play");
  await page.selectOption("#speed", "4");
  const begin_s = await seen_s(page);
  const begin_ms = Date.now();
  await page.waitForTimeout(600);
  const ratio = (1000 * ((await seen_s(page)) - begin_s)) / (Date.now() - begin_ms);
  check("plays four times as fast", ratio > 2.5 && ratio < 5.5, ratio.toFixed(1));
  check("shows where it is and how long it is", /^\d+\.\d of \d+\.\d s$/.test(await text(page, "at")), await text(page, "at"));
  await page.screenshot({ path: join(build, "page_replay.png") });
  check("rests at its end", await waits(page, () => document.getElementById("play_word").textContent === "Play"));
  await page.click("#repeat");
  await page.keyboard.press("Space");
  check(
    "or begins again",
    (await waits(page, () => (window.seen_start ||= Number(document.getElementById("seek").value) < 1))) &&
      (await waits(page, () => {
        // to its end, and there it is young again
        const at_s = Number(document.getElementById("seek").value);
        window.far ||= at_s > 3;
        return window.far && at_s < 2 && document.getElementById("play_word").textContent === "Pause";
      })),
  );
  await page.click("#repeat");
  await page.selectOption("#speed", "1");
}

async function check_plots(page) {
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Space");
  await page.waitForTimeout(900);
  const captions = await page.locator("figcaption").allTextContents();
  check(
    "plots say their units",
    ["mm", "N", "µs"].every((unit, i) => captions[i].includes(`, ${unit}`)),
    captions.join(" | "),
  );
  check("... and which line is which", /wanted \(law\)/.test(captions[1]) && /written \(gate\)/.test(captions[1]));
  const over = await page.locator("#plot_force .u-over").boundingBox();
  await page.mouse.move(over.x + over.width - 4, over.y + over.height / 2);
  check(
    "pointing at one shows its values and their time",
    await waits(page, () => /at \d+\.\d\d s: \d\.\d\d · \d\.\d\d N/.test(document.getElementById("plot_force").textContent)),
    await page.textContent("#plot_force b"),
  );
  check("... in all of them", /at \d+\.\d\d s/.test(await page.textContent("#plot_margin b")));
  await page.mouse.move(640, 300);
}

async function check_saving(page) {
  const [picture] = await Promise.all([page.waitForEvent("download", { timeout: 10000 }), page.keyboard.press("s")]);
  check(
    "S saves the picture by its scene and date",
    /^tact-liver-\d{4}-\d\d-\d\d-\d{6}\.png$/.test(picture.suggestedFilename()),
    picture.suggestedFilename(),
  );
  await picture.saveAs(join(build, "page_saved.png"));
  const bytes = readFileSync(join(build, "page_saved.png"));
  check("... as a PNG", bytes.subarray(1, 4).toString() === "PNG" && bytes.length > 5000, `${bytes.length} bytes`);
  const [table] = await Promise.all([page.waitForEvent("download", { timeout: 10000 }), page.keyboard.press("c")]);
  check("a table has its date too", /^tact-liver-\d{4}.*\.csv$/.test(table.suggestedFilename()), table.suggestedFilename());
}

/** A tactd that is held for a moment has one margin far below all others: the others are still to be read. */
async function check_stall(browser) {
  const own_socket = join(folder, "stall.sock");
  const { viewer, url } = await start_view(["--socket", own_socket]);
  const tactd = start_tactd("liver", own_socket);
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  await waits(page, () => window.tact.time_s > 5);
  tactd.kill("SIGSTOP");
  await pause(100);
  tactd.kill("SIGCONT");
  check(
    "one stall is marked at the edge of the plot, with its size",
    await waits(page, () => /▼ \d+, to -\d{5,} µs/.test(document.querySelector("#plot_margin .clipped").textContent)),
    await page.textContent("#plot_margin figcaption"),
  );
  await page.screenshot({ path: join(build, "page_stall.png") });
  await page.close();
  await stop(tactd);
  await stop(viewer);
}

async function run() {
  const { viewer, url } = await start_view(["--socket", socket, "--record", recording]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  await check_grip(browser, url);
  await pause(4000);
  await stop(tactd);
  await pause(500);
  await stop(viewer);
  read_frames();
  const replay = await start_view(["--open", recording]);
  const page = await browser.newPage({ viewport: size });
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(replay.url);
  check(
    "begins with its first viewer",
    (await waits(
      page,
      () => window.tact.link === "replay" && window.tact.tick > 0 && document.getElementById("state").textContent === "was armed",
    )) && (await seen_s(page)) < 3,
  );
  await check_words(page);
  await check_keys(page);
  await check_mouse(page);
  await check_sought(page, { rests_at, lands_s, frame_at_s, force_at_N });
  await check_plots(page);
  await check_saving(page);
  check("has no error on the console", complaints.length === 0, complaints.slice(0, 3).join("; "));
  await check_stall(browser);
  await browser.close();
  await stop(replay.viewer);
}

await play(run);
