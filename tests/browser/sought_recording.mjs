// SPDX-License-Identifier: Apache-2.0
// A recording that rests where it was sought: keys at the picture, and plots of the seconds before.
import { check, numbers, waits } from "./stage.mjs";

/** The arrows turn the view where the picture has the focus, and steer the timeline elsewhere. */
async function check_focus(page, { rests_at, lands_s }) {
  await page.keyboard.press("Space");
  await waits(page, () => document.getElementById("play_word").textContent === "Play");
  await page.keyboard.press("Home");
  await rests_at(page, 0);
  const camera_m = async () => (await numbers(page)).camera_m.join();
  const before = await camera_m();
  await page.focus("#view");
  await page.keyboard.press("ArrowRight");
  check("at the picture an arrow turns the view", await waits(page, (was) => window.tact.camera_m.join() !== was, before, 5000));
  check("... and the recording rests", await rests_at(page, 0));
  await page.mouse.click(640, 300);
  const turned = await camera_m();
  const goes_to_s = lands_s(1);
  await page.keyboard.press("ArrowRight");
  check("elsewhere, and after the mouse, it goes on by a second", await rests_at(page, goes_to_s));
  check("... and the view stays", (await camera_m()) === turned);
}

/** A recording that rests draws what was before, as its table has it. */
async function check_history(page, { rests_at, lands_s, frame_at_s, force_at_N }) {
  await page.keyboard.press("Home");
  await rests_at(page, 0);
  for (const at_s of [4, 2.5]) {
    await page.evaluate((value) => {
      const seek = document.getElementById("seek");
      seek.value = String(value);
      seek.dispatchEvent(new Event("input"));
      seek.dispatchEvent(new Event("change"));
    }, at_s);
    const there_s = lands_s(at_s);
    await rests_at(page, there_s);
    const before = frame_at_s.filter((one_s) => one_s <= there_s + 1e-6).length;
    check(
      `at ${at_s} s its plots begin with the recording`,
      await waits(page, (count) => window.tact.plotted.time_s.length === count, before, 5000),
      `${(await numbers(page)).plotted.time_s.length} of ${before} frames`,
    );
    const { time_s, force_N } = (await numbers(page)).plotted;
    const wrong = time_s.filter(
      (one_s, i) => Math.abs(one_s - frame_at_s[i]) > 1e-6 || Math.abs(force_N[i] - force_at_N[i]) > 1e-3,
    );
    check("... with the time and force of each frame", wrong.length === 0, `${wrong.length} differ`);
  }
}

/** `recording`: when its frames are, their forces, and how to get to one. */
export async function check_sought(page, recording) {
  await check_focus(page, recording);
  await check_history(page, recording);
}
