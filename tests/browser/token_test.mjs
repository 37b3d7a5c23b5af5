// SPDX-License-Identifier: Apache-2.0
// Who sees the page's tissue in Chromium: who opened the link that tact-view printed, and no other
// of this PC.
//
//     node tests/browser/token_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { check, folder, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "token.sock");
const is_live = (page) => waits(page, () => window.tact.link === "live" && window.tact.vertex_count > 0);

async function check_owner(page, url) {
  const [address, token] = url.split("#token=");
  await page.goto(url);
  check("the printed link shows the tissue", await is_live(page));
  check("the token leaves the address bar", page.url() === address, page.url().replace(token, "TOKEN"));
  check("no cookie keeps it, which other ports of this PC would get", (await page.context().cookies()).length === 0);
  await page.goto(address);
  check("the address alone is enough in this tab", await is_live(page));
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.evaluate(() => document.getElementById("csv").click()),
  ]);
  check("a file is saved with the token", (await download.failure()) === null);
}

async function check_stranger(page, url) {
  const [address, token] = url.split("#token=");
  await page.goto(address);
  check(
    "without the token the page shows nothing",
    await waits(
      page,
      () =>
        document.getElementById("link").textContent === "not allowed" &&
        window.tact.link === "gone" &&
        window.tact.vertex_count === 0,
    ),
  );
  const words = await page.textContent("#notice");
  check("... and says what to do", /open the whole link that tact-view printed/.test(words), words);
  for (const path of ["live", "session", "scene.json", "mesh.bin", "recording.csv", "recording.tactview"]) {
    const { status } = await fetch(address + path);
    check(`... /${path} is refused`, status === 401, status);
  }
  await page.goto(`${address}#token=${token.replace(/./g, "0")}`);
  await page.waitForTimeout(1500);
  check(
    "a wrong token is as good as none",
    await waits(page, () => document.getElementById("link").textContent === "not allowed"),
  );
  await page.goto(url); // in the same page: only its fragment changes
  check("the whole link, opened in that page, is taken", await is_live(page));
  check("... and leaves the address bar", page.url() === address);
}

await play(async () => {
  const { viewer, url } = await start_view(["--socket", socket]);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  for (const part of [check_owner, check_stranger]) {
    const page = await browser.newPage({ viewport: size }); // with cookies of its own
    await part(page, url);
    await page.close();
  }
  await browser.close();
  await stop(tactd);
  await stop(viewer);
});
