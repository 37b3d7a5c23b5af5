// SPDX-License-Identifier: Apache-2.0
// The page as the READMEs show it, in full quality: host/page.png, host/cut.png and host/maintenance.png. tools/pictures
// runs it.
//
//     node tests/browser/pictures.mjs BUILD_DIR page|cut|maintenance...
import { join } from "node:path";

import { description } from "./recorded_looks.mjs";
import { check, folder, play, root, sharp, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

/** The scene, further options of tact-view, the keys that are pressed, and when the picture is taken. */
const kPictures = {
  page: {
    scene: "liver",
    is_shown: () =>
      window.tact.tick > 9000 && // the plots are full
      window.tact.most_m > 0.006 &&
      parseFloat(document.getElementById("depth").textContent) > 8.5,
  },
  cut: { scene: "gum", is_shown: () => window.tact.cut_triangles >= 8 && window.tact.most_m > 0.0005 },
  maintenance: {
    scene: "maintenance",
    options: ["--tracking", description],
    keys: ["v"], // from outside, with any tracked head
    is_shown: () =>
      window.tact.figure_m !== null &&
      window.tact.tracking_words === "" &&
      window.tact.tick > 10000 &&
      Math.hypot(...(window.tact.force_N ?? [0])) > 0.3,
  },
};

async function take(browser, name, { scene, options = [], keys = [], is_shown }) {
  const socket = join(folder, `${name}.sock`);
  const { viewer, url } = await start_view(["--socket", socket, ...options]);
  const tactd = start_tactd(scene, socket);
  const page = await browser.newPage({ viewport: size });
  await page.goto(sharp(url));
  for (const key of keys) await page.keyboard.press(key);
  check(`host/${name}.png shows what it should`, await waits(page, is_shown, null, 120_000));
  await page.screenshot({ path: join(root, `host/${name}.png`) });
  await page.close();
  await stop(tactd);
  await stop(viewer);
}

await play(async () => {
  const browser = await start_browser();
  for (const name of process.argv.slice(3)) await take(browser, name, kPictures[name]);
  await browser.close();
});
