// SPDX-License-Identifier: Apache-2.0
// drawn_operator.mjs - what a page draws of the operator and the tool, picture by picture.
import { distance } from "./stage.mjs";

const kGrip_m = 0.12; // from the tip of press.obj to where it is held

/** What is drawn, picture by picture, for so long; `blank` counts the pictures without a figure. */
export async function watch(page, seconds) {
  const { samples, blank } = await page.evaluate(
    async ([duration_ms, grip_m]) => {
      const samples = [];
      let blank = 0;
      const begin = performance.now();
      for (;;) {
        await new Promise((done) => requestAnimationFrame(done));
        const time_s = (performance.now() - begin) / 1000;
        if (1000 * time_s > duration_ms) return { samples, blank };
        const at = window.tact.drawn_figure_m;
        if (!at) {
          ++blank;
          continue;
        }
        samples.push({
          time_s,
          head_m: at["head"],
          shoulder_m: at["right shoulder"],
          hand_m: at["right fingers"],
          tool_m: window.tact.drawn_tool_m([0, 0, 0]),
          grip_m: window.tact.drawn_tool_m([0, 0, grip_m]),
          reported_error_m: window.tact.grip_error_m,
          camera_m: window.tact.camera_m,
          words: window.tact.tracking_words,
          shown: document.getElementById("tracking").hidden ? "" : document.getElementById("tracking").textContent,
          force_N: Math.hypot(...window.tact.force_N),
          state: document.getElementById("state").textContent,
          tick: window.tact.tick,
        });
      }
    },
    [seconds * 1000, kGrip_m],
  );
  return Object.assign(samples, { blank });
}

/** How far a part of it goes, and the most of a value. */
export const path_m = (samples, part) =>
  samples.reduce((sum, sample, i) => sum + (i === 0 ? 0 : distance(sample[part], samples[i - 1][part])), 0);
export const most = (samples, value) => samples.reduce((worst, sample) => Math.max(worst, value(sample)), 0);
