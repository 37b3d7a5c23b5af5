// SPDX-License-Identifier: Apache-2.0
// The tasks of a scene in Chromium: does the page say which is due, and does one end when the hand presses?
//
//     node tests/browser/tasks_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { join } from "node:path";

import { check, folder, open_waiting, play, size, start_browser, start_tactd, stop, waits } from "./stage.mjs";

const words = (page) => page.textContent("#task_text");

await play(async () => {
  const browser = await start_browser();
  const socket = join(folder, "tactd.sock");
  const { viewer, page } = await open_waiting(browser, socket);
  // The force ends the first task: with none of that size it stays due.
  const weak = start_tactd("maintenance", socket, ["--set", "task.0.force_min_N=1.9"]);
  check("sees the tip press", await waits(page, () => Math.hypot(...(window.tact.force_N ?? [0])) > 0.3));
  check(
    "... but not hard enough",
    await waits(page, () => window.tact.time_s > 2.5 && document.querySelector("#task_list .done") === null),
  );
  check("says which task is due", /^task 1 of 3: .+/.test(await words(page)), await words(page));
  check("lists all of them", (await page.locator("#task_list li").count()) === 3);
  await stop(weak);
  const tactd = start_tactd("maintenance", socket);
  check("one ends when the hand presses", await waits(page, () => document.querySelectorAll("#task_list .done").length === 1));
  check(
    "... and the next is due",
    await waits(page, () => document.getElementById("task_text").textContent.startsWith("task 2")),
  );
  check("says which is done", (await page.locator("#task_list li.done").count()) === 1);
  check("all end", await waits(page, () => document.getElementById("task_text").textContent === "all tasks are done"));
  await stop(tactd);
  const liver = start_tactd("liver", socket);
  check("a scene without tasks shows none", await waits(page, () => document.getElementById("tasks").hidden));
  await page.close();
  await stop(liver);
  await stop(viewer);
  await browser.close();
});
