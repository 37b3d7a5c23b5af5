// SPDX-License-Identifier: Apache-2.0
// emulated_headset.mjs - a headset of iwer in a page of a test, and what its wearer's eyes see.
import { createRequire } from "node:module";
import { join } from "node:path";

import { build, root } from "./stage.mjs";

const iwer = createRequire(join(root, "host/web/package.json"))
  .resolve("iwer")
  .replace(/lib.index\.js$/, "build/iwer.min.js");

function put_on() {
  window.emulated = new window.IWER.XRDevice(window.IWER.metaQuest3);
  window.emulated.stereoEnabled = true;
  window.emulated.installRuntime({ forceInstall: true });
  // A headset that is not worn asks for no pictures; iwer's goes on.
  const ask = window.XRSession.prototype.requestAnimationFrame;
  let waiting = null;
  window.lay_aside = (aside) => {
    window.XRSession.prototype.requestAnimationFrame = aside
      ? function (callback) {
          return (waiting = [this, callback]).length;
        }
      : ask;
    if (!aside && waiting) ask.call(...waiting);
  };
}

/** From the next address on; in the page it is `emulated`, and `lay_aside(true)` takes it off the head. */
export async function emulate_headset(page) {
  await page.addInitScript({ path: iwer });
  await page.addInitScript(put_on);
}

/** A column-major 4 x 4 matrix on a place. */
export const times = (m, p) => [0, 1, 2, 3].map((row) => m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]);

export const distance_of = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

/** What an eye sees of a place: tangents to the right and up, and the depth before it, m. */
export function seen_by(eye, place_m) {
  const at = times(eye.view, place_m);
  const [x, y, , w] = times(eye.projection, at);
  return {
    right: (x / w + eye.projection[8]) / eye.projection[0],
    up: (y / w + eye.projection[9]) / eye.projection[5],
    depth_m: -at[2],
  };
}

/** Where an eye is: -R' t of its view matrix. */
export function place_of(eye) {
  const v = eye.view;
  return [0, 1, 2].map((i) => -(v[4 * i] * v[12] + v[4 * i + 1] * v[13] + v[4 * i + 2] * v[14]));
}

/** The head looks down at the organ; what each half of the picture has of red tissue and of the panel's ground. */
export async function look_down(page, file) {
  await page.evaluate(() => {
    const half_rad = -0.24;
    window.emulated.quaternion.set(Math.sin(half_rad), 0, 0, Math.cos(half_rad));
  });
  const bare = (on) =>
    page.evaluate((only) => {
      // the emulated lenses lie over the page
      document.getElementById("desk").style.visibility = only ? "hidden" : "";
      document.getElementById("view").style.opacity = only ? 1 : "";
    }, on);
  await bare(true);
  await page.waitForTimeout(700);
  const png = await page.screenshot({ path: join(build, file) });
  await bare(false);
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    pen.drawImage(bitmap, 0, 0);
    const half = Math.floor(bitmap.width / 2);
    return [0, half].map((left) => {
      const { data } = pen.getImageData(left, 0, half, bitmap.height);
      let tissue = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i] > 90 && data[i] > 1.6 * data[i + 2]) ++tissue;
      return tissue / (data.length / 4);
    });
  }, png.toString("base64"));
}
