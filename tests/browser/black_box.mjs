// SPDX-License-Identifier: Apache-2.0
// black_box.mjs - of page_test.mjs: the file that tactd leaves after a fault, as the page shows it.
import { spawn } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";

import { build, check, folder, size, start_tactd, start_view, stop, waits } from "./stage.mjs";

/** What the kernel calls a thread; nothing when it has ended meanwhile, as tactd's checks of the PC do. */
function name_of(task) {
  try {
    return readFileSync(join(task, "comm"), "utf8").trim();
  } catch {
    return "";
  }
}

/** The thread of tactd that has the loop, once it runs. */
async function loop_of(tactd) {
  const tasks = `/proc/${tactd.pid}/task`;
  for (let i = 0; i < 400 && existsSync(tasks); ++i) {
    const loop = readdirSync(tasks).find((id) => name_of(join(tasks, id)) === "tact-loop");
    if (loop) return loop;
    await pause(50);
  }
  throw new Error("tactd has no thread called tact-loop");
}

/** A loop that strace holds in its sleep, as a driver would that hangs; its last seconds stay. */
export async function check_black_box(browser) {
  const boxes = join(folder, "boxes");
  const tactd = start_tactd("liver", join(folder, "stalled.sock"), ["--black-box", boxes]);
  const loop = await loop_of(tactd);
  await pause(3000);
  spawn(
    "timeout",
    ["-s", "INT", "6", "strace", "-qq", "-o", "/dev/null", "-p", loop, "-e", "inject=clock_nanosleep:delay_exit=400000:when=20"],
    { stdio: "ignore" },
  );
  const kept = () => (existsSync(boxes) ? readdirSync(boxes) : []);
  for (let i = 0; i < 100 && kept().length === 0; ++i) await pause(100);
  check("a fault leaves a black box", kept().length === 1, kept().join(" "));
  await pause(500);
  await stop(tactd);
  const { viewer, url } = await start_view(["--open", join(boxes, kept()[0])]);
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  check(
    "shows the black box up to its fault",
    await waits(
      page,
      () => window.tact.link === "replay" && document.getElementById("fault_name").textContent.includes("loop stalled"),
    ),
    await page.textContent("#fault_name"),
  );
  check("names the file it shows", (await page.textContent("#link")).includes(kept()[0]));
  await page.screenshot({ path: join(build, "page_black_box.png") });
  await page.close();
  await stop(viewer);
}
