// SPDX-License-Identifier: Apache-2.0
// A tracker at the left hand alone, in Chromium: does the drawn hand follow it, and rest without it?
//
//     node tests/browser/left_hand_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Picture: BUILD_DIR/page_left_hand.png. Prints "N passed, M failed";
// exit status 0 or 1.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { MarkerBody, description, free_udp_port } from "./marker_body.mjs";
import {
  build,
  check,
  distance,
  folder,
  play,
  sharp,
  size,
  start_browser,
  start_tactd,
  start_view,
  stop,
  waits,
} from "./stage.mjs";

const kHome_m = [0.1, -0.3, 0.05];
const kWay_m = [0.08, -0.12, 0.3];
const kNudge_m = 0.0015;
const mm = (length_m) => `${(1e3 * length_m).toFixed(2)} mm`;
const drawn_m = (page) => page.evaluate(() => window.tact.drawn_figure_m);

/** How far the wrist is drawn from where it was 200 ms ago. */
async function moved_m(page) {
  const before = await drawn_m(page);
  await page.waitForTimeout(200);
  return distance((await drawn_m(page))["left wrist"], before["left wrist"]);
}

/** The figure takes a tracker only when it rests: from then on the hand follows a nudge. Ends when the hand rests. */
async function follows(page, body) {
  let was_taken = false;
  for (let i = 0; i < 100; ++i) {
    if (!was_taken) body.at_m = kHome_m.map((m) => m + (i % 2 === 0 ? kNudge_m : 0));
    const way_m = await moved_m(page);
    if (was_taken && way_m < 1e-5) return true;
    if (i % 2 === 1) was_taken ||= way_m > kNudge_m; // along all three axes: sqrt(3) of it
  }
  return false;
}

async function raise(page, body) {
  const before = await drawn_m(page);
  for (let i = 1; i <= 100; ++i) {
    body.at_m = kHome_m.map((m, k) => m + (kWay_m[k] * i) / 100);
    await page.waitForTimeout(10);
  }
  const there = before["left wrist"].map((m, k) => m + kWay_m[k]);
  await waits(page, (goal) => Math.hypot(...goal.map((m, k) => window.tact.drawn_figure_m["left wrist"][k] - m)) < 0.005, there);
  const raised = await drawn_m(page);
  for (const part of ["left wrist", "left fingers"]) {
    const off_m = distance(
      raised[part],
      before[part].map((m, k) => m + kWay_m[k]),
    );
    check(`${part}: goes with the tracker`, off_m < 0.01, `${mm(off_m)} from where it is`);
  }
  check(
    "the elbow hangs below wrist and shoulder",
    raised["left elbow"][2] < Math.min(raised["left wrist"][2], raised["left shoulder"][2]) - 0.02,
  );
  check("the right hand stays at the tool", (await page.evaluate(() => window.tact.grip_error_m)) < 0.002);
  await page.screenshot({ path: join(build, "page_left_hand.png") });
  return before;
}

await play(async () => {
  const port = await free_udp_port();
  const tracking = join(folder, "hand.tracking.toml");
  writeFileSync(tracking, description("left_hand", port));
  const socket = join(folder, "hand.sock");
  const { viewer, url } = await start_view(["--socket", socket, "--tracking", tracking]);
  const tactd = start_tactd("maintenance", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await page.goto(sharp(url));
  const body = new MarkerBody(port, kHome_m);
  check("hears of the left hand", await waits(page, () => window.tact?.drawn_figure_m && window.tact.tracking_words === ""));
  check("is taken by the figure", await follows(page, body));
  const before = await raise(page, body);
  body.stop();
  check(
    "says that it is lost",
    await waits(page, () => document.getElementById("tracking").textContent.includes("left hand lost (silent)")),
  );
  await waits(
    page,
    (home) => Math.hypot(...home.map((m, k) => window.tact.drawn_figure_m["left wrist"][k] - m)) < 0.002,
    before["left wrist"],
  );
  const rest_m = distance((await drawn_m(page))["left wrist"], before["left wrist"]);
  check("then it rests again", rest_m < 0.005, mm(rest_m));
  check("tactd ends cleanly", (await stop(tactd)) === 0);
  check("tact-view ends cleanly", (await stop(viewer)) === 0);
  await browser.close();
});
