// SPDX-License-Identifier: Apache-2.0
// The tracked operator in Chromium: does the figure hold the tool through the recorded motion, and
// what does a person see when the tracker is gone?
//
//     node tests/browser/maintenance_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// Takes long: run only by tools/check --long and --only browser.
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  check,
  distance,
  folder,
  numbers,
  play,
  sharp,
  size,
  start_browser,
  start_tactd,
  start_view,
  stop,
  waits,
} from "./stage.mjs";
import { most, path_m, watch } from "./drawn_operator.mjs";
import { free_udp_port } from "./marker_body.mjs";
import { description, kLeaning_s, send_looks, write_looks_before, write_wild_looks } from "./recorded_looks.mjs";

const kHold_m = 0.002;
const kMotion_s = 30;
const kSilent_s = 8.9; // of the recording: soon afterwards the waist is hidden for a while
const kEyes_m = 0.2; // from the head's joint to the eyes, and what a smooth camera lags behind
const kMaxBytes = 4096;

/** tact-view with a tracker, tactd, and the page. */
async function start_all(browser, name, tracking) {
  const socket = join(folder, `${name}.sock`);
  const { viewer, url } = await start_view(["--socket", socket, "--tracking", tracking]);
  const tactd = start_tactd("maintenance", socket);
  const page = await browser.newPage({ viewport: size });
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  return { viewer, tactd, page, url, complaints };
}

async function stop_all({ viewer, tactd, page, complaints }) {
  check("has no error on the console", complaints.length === 0, complaints.slice(0, 3).join("; "));
  await page.close();
  check("tactd ends cleanly", (await stop(tactd)) === 0);
  check("tact-view ends cleanly", (await stop(viewer)) === 0);
}

const mm = (length_m) => `${(1e3 * length_m).toFixed(2)} mm`;

/** In every picture there is a figure, and its drawn finger tips are where the drawn tool is held. */
function check_grip(when, samples) {
  check(
    `is drawn ${when}, in every picture`,
    samples.blank === 0 && samples.length > 0,
    `${samples.blank} of ${samples.length + samples.blank} pictures without it`,
  );
  const reported_m = most(samples, (sample) => sample.reported_error_m);
  check("... reported within 2 mm of the tool's grip", reported_m < kHold_m, `worst ${mm(reported_m)}`);
  const drawn_m = most(samples, (sample) => distance(sample.hand_m, sample.grip_m));
  check("... drawn within 2 mm of it, moving or not", drawn_m < kHold_m, `worst ${mm(drawn_m)}`);
}

/** Since the head was tracked; then V chooses the first view, E the eyes again. */
async function check_eyes(page, samples) {
  const seen = samples.filter((sample) => sample.time_s > 2);
  const far_m = most(seen, (sample) => distance(sample.camera_m, sample.head_m));
  check(
    "the camera follows the tracked head by itself",
    path_m(seen, "camera_m") > 0.3 && far_m < kEyes_m,
    `${path_m(seen, "camera_m").toFixed(2)} m, never more than ${mm(far_m)} from it`,
  );
  await page.keyboard.press("v");
  const home = await watch(page, 2);
  const rest = home.filter((sample) => sample.time_s > 0.5);
  check(
    "V chooses the first view, and nothing else moves it",
    path_m(rest, "camera_m") < 1e-3 && rest.every((sample) => distance(sample.camera_m, sample.head_m) > 0.5),
  );
  await page.keyboard.press("e");
  const again = (await watch(page, 1.5)).filter((sample) => sample.time_s > 1);
  check("E looks with the operator's eyes again", most(again, (sample) => distance(sample.camera_m, sample.head_m)) < kEyes_m);
  await page.keyboard.press("e");
}

async function follow_the_recording(browser) {
  const all = await start_all(browser, "recorded", description);
  const { page, url } = all;
  await page.goto(url);
  check(
    "shows the operator of the recording",
    await waits(
      page,
      () => window.tact.link === "live" && window.tact.scene_name === "maintenance" && window.tact.drawn_figure_m !== null,
    ),
  );
  const samples = await watch(page, kMotion_s);
  const fps = samples.length / kMotion_s;
  // How fast is a question for tools/bench; that it draws at all is one for a test.
  check("draws picture after picture", fps > 1, `${fps.toFixed(1)} frames/s`);
  const sixths = new Set(samples.map((sample) => Math.floor((6 * sample.time_s) / kMotion_s)));
  check("... through the whole motion", sixths.size === 6, `in ${sixths.size} sixths of it`);
  check_grip("through the whole motion", samples);
  check("the hand moves with the tool", path_m(samples, "hand_m") > 0.2, `${path_m(samples, "hand_m").toFixed(2)} m`);
  for (const part of ["head_m", "shoulder_m"]) {
    const far_m = most(samples, (sample) => distance(sample[part], samples[0][part]));
    check(
      `the ${part.slice(0, -2)} moves with the operator`,
      path_m(samples, part) > 0.3 && far_m > 0.05,
      `${path_m(samples, part).toFixed(2)} m, ${mm(far_m)} away`,
    );
    const half_m = most(samples, (sample) => {
      const later = samples.find((other) => other.time_s >= sample.time_s + 0.5) ?? sample;
      return later.time_s < sample.time_s + 0.7 ? distance(sample[part], later[part]) : 0;
    });
    check("... and never jumps", half_m < 0.25, `${mm(half_m)} in half a second`);
  }
  check(
    "presses the gasket",
    most(samples, (sample) => sample.force_N) > 0.3,
    `${most(samples, (sample) => sample.force_N).toFixed(2)} N`,
  );
  const words = new Set(samples.map((sample) => sample.words));
  for (const trouble of ["waist lost", "held (frozen)"]) {
    check(
      `reports as text: ${trouble}`,
      [...words].some((word) => word.includes(trouble)),
      [...words].filter((word) => word).join("; "),
    );
  }
  check("says nothing while all is well", samples.filter((sample) => sample.words === "").length > 0.7 * samples.length);
  const { largest_frame_bytes, largest_figure_bytes } = await page.evaluate(() => ({ ...window.tact }));
  check(
    `gets frame and figure in at most ${kMaxBytes} bytes`,
    largest_figure_bytes > 100 && largest_frame_bytes + largest_figure_bytes <= kMaxBytes,
    `${largest_frame_bytes} and ${largest_figure_bytes}`,
  );
  await check_eyes(page, samples);
  await page.keyboard.press("f");
  check("hides the operator", await waits(page, () => !window.tact.figure_on));
  await stop_all(all);
}

/** He leans, and the looks go wrong in ways of which none may be believed. */
async function mislead_the_tracker(page, port, neutral) {
  const path = join(folder, "wild.jsonl");
  write_wild_looks(path);
  const sent = send_looks(path, port);
  const samples = await watch(page, kLeaning_s[1] - kLeaning_s[0] + 5);
  await sent;
  const says = (words) => samples.filter((sample) => sample.shown.includes(words));
  const [jumps, old, well] = [
    says("lost (it jumps)"),
    says("lost (out of order)"),
    samples.filter((sample) => sample.words === ""),
  ];
  const far = (sample) => distance(sample.head_m, neutral.head_m);
  check("leans again before", well.length > 0 && far(well.at(-1)) > 0.04, well.length > 0 ? mm(far(well.at(-1))) : "");
  check(
    "says in words that it is lost because it jumps",
    jumps.length > 0,
    [...new Set(samples.map((sample) => sample.shown))].join("; "),
  );
  check("then that it is lost because it is out of order", old.length > 0 && jumps.length > 0 && old[0].time_s > jumps[0].time_s);
  const wild = samples.filter((sample) => sample.time_s > (well.at(-1)?.time_s ?? 0));
  check(
    "believes none of it",
    most(wild, far) < far(well.at(-1) ?? samples[0]) + 0.03,
    `the head is never more than ${mm(most(wild, far))} from the neutral pose`,
  );
  check(
    "has the neutral pose while it is out of order",
    old.length > 0 && far(old.at(-1)) < 0.03,
    old.length > 0 ? mm(far(old.at(-1))) : "",
  );
  check_grip("with a wild tracker", samples);
}

async function lose_the_tracker(browser) {
  const port = await free_udp_port();
  const tracking = join(folder, "maintenance.tracking.toml");
  writeFileSync(tracking, readFileSync(description, "utf8").replace(/^recording = .*$/m, `udp_port = ${port}`));
  const all = await start_all(browser, "udp", tracking);
  const { page, url } = all;
  await page.goto(url);
  check(
    "is there without a tracker",
    await waits(page, () => window.tact.link === "live" && window.tact.drawn_figure_m !== null),
  );
  const path = join(folder, "leaning.jsonl");
  write_looks_before(path, kSilent_s);
  const sent = send_looks(path, port);
  check("hears the tracker by UDP", await waits(page, () => window.tact.tracking_words === ""));
  const samples = await watch(page, kSilent_s + 7);
  await sent;
  const well = samples.filter((sample) => sample.words === "");
  const [begin, before] = [well.find((sample) => sample.time_s > 1.5) ?? samples[0], well.at(-1) ?? samples[0]];
  check("leans with the operator", distance(before.head_m, begin.head_m) > 0.05, mm(distance(before.head_m, begin.head_m)));
  const after = samples.slice(samples.indexOf(before) + 1);
  const lost = after.find((sample) => sample.words.includes("lost"));
  check(
    "then says in words that the tracker is lost",
    lost !== undefined && lost.time_s < before.time_s + 4 && lost.shown.includes("lost (silent)"),
    lost && `${lost.shown}, ${(lost.time_s - before.time_s).toFixed(2)} s`,
  );
  check(
    "holds the pose until then",
    after
      .slice(0, after.indexOf(lost))
      .every((sample) => sample.words.includes("held") && distance(sample.head_m, before.head_m) < 0.03),
  );
  const end = after.at(-1);
  check(
    "fades to the neutral pose",
    distance(end.head_m, begin.head_m) < 0.03 && distance(end.head_m, before.head_m) > 0.04,
    `${mm(distance(end.head_m, begin.head_m))} from it`,
  );
  const rest = after.filter((sample) => sample.time_s > before.time_s + 5.5);
  check("and stays there", path_m(rest, "head_m") < 0.01, mm(path_m(rest, "head_m")));
  check_grip("without a tracker", samples);
  // A page that has heard nothing for a while says so in the place of the state.
  const states = after.map((sample) => sample.state).filter((state) => !state.startsWith("no news for"));
  check("tactd stays armed", states.length > 0 && states.every((state) => state === "armed"), [...new Set(states)].join("; "));
  check(
    "the forces go on",
    end.tick > before.tick && most(after, (sample) => sample.force_N) > 0.2,
    `${most(after, (sample) => sample.force_N).toFixed(2)} N`,
  );
  await mislead_the_tracker(page, port, end);
  await stop_all(all);
}

async function look_from_outside(browser) {
  const all = await start_all(browser, "picture", description);
  await all.page.goto(sharp(all.url));
  await all.page.keyboard.press("v"); // from outside, with any tracked head
  const presses = await waits(
    all.page,
    () =>
      window.tact.figure_m !== null &&
      window.tact.tracking_words === "" &&
      window.tact.tick > 10000 &&
      Math.hypot(...(window.tact.force_N ?? [0])) > 0.3,
    null,
    60000,
  );
  const { link, tick, tracking_words, fps } = await numbers(all.page);
  check("shows the operator pressing", presses, `${link}, tick ${tick}, "${tracking_words}", ${fps.toFixed(1)} frames/s`);
  await stop_all(all);
}

await play(async () => {
  const browser = await start_browser();
  await follow_the_recording(browser);
  await lose_the_tracker(browser);
  await look_from_outside(browser);
  await browser.close();
});
