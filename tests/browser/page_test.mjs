// SPDX-License-Identifier: Apache-2.0
// The page in Chromium against the real controller: does a person see what tactd does?
//
//     node tests/browser/page_test.mjs BUILD_DIR      (tactd, tact-view and page/ are there)
//
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_hand.png with the mouse in use, page_SCENE.png.
// Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { check_black_box } from "./black_box.mjs";
import {
  build,
  check,
  distance,
  first_line,
  folder,
  measure_fps,
  numbers,
  play,
  sharp,
  size,
  start,
  start_browser,
  start_tactd,
  start_view,
  stop,
  waits,
} from "./stage.mjs";

const socket = join(folder, "telemetry.sock");
const kVertices = 3116;
const kMaxFrameBytes = 4096;

/** The page before, while and after the controller runs. */
async function check_view(page, url) {
  await page.goto(url);
  check(
    "waits for tactd in words",
    await waits(page, () => document.getElementById("notice").textContent.includes("waiting for tactd")),
  );
  const tactd = start_tactd("liver", socket);
  check("finds tactd by itself", await waits(page, () => window.tact.link === "live"));
  check(
    "shows the scene's name",
    await waits(page, () => document.getElementById("scene").textContent === "liver" && document.title === "tact: liver"),
  );
  check(
    "shows the checksum of its limits",
    await waits(page, () => /^[0-9a-f]{8}$/.test(document.getElementById("limits").textContent)),
    await page.textContent("#limits"),
  );
  check(
    "shows the liver",
    (await waits(page, () => window.tact.vertex_count > 0)) && (await numbers(page)).vertex_count === kVertices,
    `${(await numbers(page)).vertex_count} vertices`,
  );
  const before = await numbers(page);
  check(
    "deforms it by more than a millimetre within 20 s",
    await waits(page, () => window.tact.most_ever_m > 0.001),
    `${((await numbers(page)).most_ever_m * 1e3).toFixed(2)} mm`,
  );
  check("moves the vertices around the tool", await waits(page, () => window.tact.moved_vertices > 10));
  const { moved_vertices } = await numbers(page);
  check("and no others", moved_vertices < 0.9 * kVertices, moved_vertices);
  check(
    "moves the tool",
    await waits(
      page,
      (from_m) => Math.hypot(...from_m.map((at_m, axis) => window.tact.tool_m[axis] - at_m)) > 0.005,
      before.tool_m,
    ),
  );
  check("shows a force", await waits(page, () => Number(document.getElementById("force").textContent) > 0.05));
  check(
    "says the state in words",
    await waits(page, () => document.getElementById("state").textContent === "armed"),
    await page.textContent("#state"),
  );
  return tactd;
}

async function check_speed(page) {
  const fps = await measure_fps(page, 5);
  // How fast is a question for tools/bench; that it draws at all is one for a test.
  check("draws picture after picture", fps > 1 && fps < 250, `${fps.toFixed(1)} frames/s`);
  const { frames, bytes, largest_frame_bytes } = await numbers(page);
  check(
    `gets frames of at most ${kMaxFrameBytes} bytes`,
    frames > 100 && largest_frame_bytes <= kMaxFrameBytes,
    `largest ${largest_frame_bytes} bytes, mean ${(bytes / frames).toFixed(0)} of ${frames}`,
  );
}

async function check_looking(page) {
  const before = await numbers(page);
  await page.mouse.move(640, 620);
  await page.mouse.down();
  await page.mouse.move(760, 600, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(300);
  const turned = await numbers(page);
  check("turns the view by dragging", distance(before.camera_m, turned.camera_m) > 0.01);
  await page.keyboard.press("w");
  check("shows the mesh as wires", (await numbers(page)).wireframe);
  await page.keyboard.press("w");
  await page.keyboard.press("v");
  check("goes back to the first view", await waits(page, () => !window.tact.wireframe));
  check("plots depth, force and margin", (await page.locator(".uplot canvas").count()) >= 3);
}

async function check_pause(page) {
  await page.keyboard.press("p");
  await page.waitForTimeout(200);
  const first = await numbers(page);
  await page.waitForTimeout(700);
  const second = await numbers(page);
  check("freezes the picture on pause", second.paused && first.tick === second.tick);
  check("still hears tactd on pause", second.frames > first.frames);
  await page.click("#pause");
  check(
    "goes on after pause",
    (await waits(page, () => !window.tact.paused && window.tact.tick > 0)) &&
      (await page.waitForFunction((tick) => window.tact.tick > tick, second.tick).then(() => true)),
  );
}

async function check_recording(page) {
  await page.keyboard.press("r");
  await page.waitForTimeout(1200);
  const [file] = await Promise.all([page.waitForEvent("download", { timeout: 10000 }), page.keyboard.press("r")]);
  const path = join(folder, "page.tact");
  await file.saveAs(path);
  const table = join(folder, "page.csv");
  const convert = start("tact-view", ["--open", path, "--export", table, "--json"]);
  const summary = JSON.parse(await first_line(convert));
  check(
    "records what it shows into a sound file",
    summary.damage === "" && summary.length_s > 0.5 && summary.frames > 20,
    `${summary.frames} frames`,
  );
  return path;
}

async function check_hand(page) {
  await page.waitForTimeout(300);
  const before = await numbers(page);
  await page.keyboard.down("Shift");
  await page.mouse.move(640, 300);
  await page.mouse.down();
  for (let i = 1; i <= 25; ++i) {
    await page.mouse.move(640 + 8 * i, 300 - 6 * i);
    await page.waitForTimeout(20);
  }
  await page.screenshot({ path: join(build, "page_hand.png") });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await page.waitForTimeout(1000);
  const after = await numbers(page);
  const up_m = after.tool_m[2] - before.tool_m[2];
  const right_m = after.tool_m[1] - before.tool_m[1];
  check(
    "moves the hand with the mouse, up and to the right",
    up_m > 0.01 && right_m > 0.01,
    `${(right_m * 1e3).toFixed(0)} mm right, ${(up_m * 1e3).toFixed(0)} mm up`,
  );
  const held = await numbers(page);
  await page.waitForTimeout(500);
  check("leaves the hand where the mouse left it", distance(held.tool_m, (await numbers(page)).tool_m) < 0.003);
  await page.keyboard.press("d");
  check("twists the tool with a key", await waits(page, () => window.tact.turn[3] > 0.8 * Math.sin(Math.PI / 72)));
  await page.keyboard.down("Control");
  await page.mouse.move(640, 300);
  await page.mouse.down();
  await page.mouse.move(690, 300, { steps: 3 });
  await page.keyboard.up("Control"); // a drag stays what it began as
  await page.mouse.move(740, 300, { steps: 3 });
  await page.mouse.up();
  check("turns the tool with Ctrl and the mouse", await waits(page, () => Math.hypot(...window.tact.turn.slice(1)) > 0.15));
  await page.keyboard.press("g");
  check(
    "closes the grip",
    await waits(page, () => ["closed", "holds tissue"].includes(document.getElementById("grip").textContent)),
  );
}

async function check_loss(page, tactd) {
  check("tactd ends cleanly", (await stop(tactd)) === 0);
  check(
    "says that the connection is lost",
    await waits(page, () => document.getElementById("notice").textContent.includes("connection lost")),
  );
  const again = start_tactd("liver", socket);
  check("comes back when tactd does", await waits(page, () => window.tact.link === "live"));
  return again;
}

/** Another browser looks at the same run, in full quality. */
async function check_second_browser(browser, url) {
  const page = await browser.newPage({ viewport: size });
  await page.goto(sharp(url));
  check(
    "shows the tissue being pressed to a second browser",
    await waits(
      page,
      () => window.tact.most_m > 0.006 && parseFloat(document.getElementById("depth").textContent) > 8.5,
      null,
      60000,
    ),
  );
  await page.close();
}

/** Another scene from its first touch; the picture is BUILD_DIR/page_NAME.png. */
async function check_scene(browser, name, message, condition) {
  const own_socket = join(folder, `${name}.sock`);
  const { viewer, url } = await start_view(["--socket", own_socket]);
  const tactd = start_tactd(name, own_socket);
  const page = await browser.newPage({ viewport: size });
  await page.goto(sharp(url));
  check(
    message,
    await waits(page, condition, null, 60000),
    JSON.stringify(
      await page.evaluate(() => ({
        moved: window.tact.moved_vertices,
        most_mm: 1e3 * window.tact.most_ever_m,
        cut: window.tact.cut_triangles,
      })),
    ),
  );
  await page.screenshot({ path: join(build, `page_${name}.png`) });
  await page.close();
  await stop(tactd);
  await stop(viewer);
}

async function check_replay(browser, recording) {
  const { viewer, url } = await start_view(["--open", recording]);
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  check(
    "replays the recording",
    (await waits(page, () => window.tact.link === "replay" && window.tact.tick > 0)) &&
      (await page.textContent("#link")).includes("page.tact"),
  );
  await page.close();
  check("tact-view ends cleanly", (await stop(viewer)) === 0);
}

async function run() {
  const { viewer, url } = await start_view(["--socket", socket]);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  let tactd = await check_view(page, url);
  await check_speed(page);
  await check_looking(page);
  await check_pause(page);
  const recording = await check_recording(page);
  await check_hand(page);
  tactd = await check_loss(page, tactd);
  check("has no error on the console", complaints.length === 0, complaints.slice(0, 3).join("; "));
  await page.close();
  await check_second_browser(browser, url);
  await check_replay(browser, recording);
  await check_black_box(browser);
  await check_scene(
    browser,
    "heart",
    "shows the heart dented by a finger",
    () => window.tact.most_m > 0.003 && window.tact.vertex_count === 4002,
  );
  await check_scene(
    browser,
    "liver_twist",
    "shows the torque of forceps that tilt, as a number and as an arc",
    () => window.tact.arc_share > 0.05 && /^[1-9][0-9.]+ of [0-9.]+ mN m$/.test(document.getElementById("torque").textContent),
  );
  await check_scene(browser, "skin", "shows skin dented by an injector", () => window.tact.most_m > 0.003);
  await check_scene(
    browser,
    "gum",
    "shows a cut that opens in the gum",
    () => window.tact.cut_triangles >= 8 && window.tact.most_m > 0.0005,
  );
  await browser.close();
  await stop(tactd);
  await stop(viewer);
}

await play(run);
