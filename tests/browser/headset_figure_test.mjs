// SPDX-License-Identifier: Apache-2.0
// The operator's figure in an emulated headset (iwer): does it stay, is the headset its head, and is it whole from afar?
//
//     node tests/browser/headset_figure_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// Takes long: run only by tools/check --long and --only browser.
// Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { emulate_headset, place_of } from "./emulated_headset.mjs";
import { check, distance, folder, numbers, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "headset_figure.sock");

async function run() {
  const { viewer, url } = await start_view(["--socket", socket, "--figure"]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await emulate_headset(page);
  await page.goto(url);
  await waits(page, () => window.tact.figure_m !== null && document.getElementById("headset").checkVisibility());
  await page.click("#headset");
  await waits(page, () => window.tact.headset?.on && window.tact.headset.eyes.length === 2);
  const seen = async (x_m, turn_rad = 0) => {
    await page.evaluate(
      ([x, turn]) => {
        window.emulated.position.set(x, 1.6, 0);
        window.emulated.quaternion.set(0, Math.sin(turn / 2), 0, Math.cos(turn / 2));
      },
      [x_m, turn_rad],
    );
    await page.waitForTimeout(500);
    const { drawn_figure_m, figure_m, headset } = await numbers(page);
    return { drawn_m: drawn_figure_m, own_m: figure_m, eyes_m: headset.figure_eyes_m, eye_m: place_of(headset.eyes[0]) };
  };
  const at = await seen(0);
  check("the figure stays in the headset", at.drawn_m !== null && at.drawn_m["right fingers"] !== undefined);
  const reach_m = ({ drawn_m, eye_m }) => distance(drawn_m.head, eye_m);
  const begun_m = distance(at.eye_m, at.eyes_m); // half the distance of two eyes is 32 mm
  check("the session begins at its eyes", begun_m < 0.05 && reach_m(at) < 0.2, begun_m);
  const moved = await seen(0.15, 0.3);
  const way_m = distance(moved.drawn_m.head, at.drawn_m.head);
  check("its head is where the headset is", way_m > 0.1 && way_m < 0.2 && reach_m(moved) < 0.2, way_m);
  check("... and its hand holds the tool", distance(moved.drawn_m["right fingers"], moved.own_m["right fingers"]) < 0.005);
  const far = await seen(0.9);
  check("who leaves the figure sees it whole", distance(far.drawn_m.head, far.own_m.head) < 0.005);
  await browser.close();
  await stop(tactd);
  await stop(viewer);
}

await play(run);
