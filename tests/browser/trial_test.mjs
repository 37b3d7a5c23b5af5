// SPDX-License-Identifier: Apache-2.0
// tact-trial asks at the page in Chromium: digits of its keys answer, and the tick log has their marks.
//
//     node tests/browser/trial_test.mjs BUILD_DIR   (tactd, tactctl, tact-view, tact-trial, page/)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";

import { build, check, folder, play, root, size, start_at, start_browser, stop, waits } from "./stage.mjs";

const env = { ...process.env, XDG_RUNTIME_DIR: folder };
const socket = join(folder, "trial.sock");
const scene = join(folder, "liver.toml");
const protocol = join(folder, "protocol.toml");
const log = join(folder, "run.tactlog");

const run = (program, ...args) => start_at(join(build, program), args, env);
/** Of fields of the CSV of the log. */
const events = (csv) => {
  const [columns, ...rows] = csv.split("\n").filter((line) => line && !line.startsWith("#"));
  const at = columns.split(",").indexOf("event");
  return rows.map((row) => Number(row.split(",")[at])).filter((event) => event > 0);
};

async function tactd_runs() {
  const tactd = run("tactd", scene, "--socket", socket, "--no-black-box", "--record", log);
  tactd.stdout.resume();
  for (let status = 1; status !== 0;) {
    const asked = start_at(join(build, "tactctl"), [scene, "status"], env, "ignore");
    asked.stdout.resume();
    status = await asked.ended;
  }
  return tactd;
}

/** Types at the page what each line of the program asks for; the keys that answered. */
async function answer(trial, page) {
  const keys = ["1", "2", "2", "1"];
  const pressed = [];
  const bound = setTimeout(() => trial.kill(), 200_000); // against a test that hangs
  for await (const line of createInterface({ input: trial.stdout })) {
    if (line.startsWith("tact-view: http")) {
      await page.goto(line.replace("tact-view: ", ""));
      await waits(page, () => window.tact.link === "live");
    }
    if (/^interval [12]/.test(line)) await page.keyboard.press("0");
    if (!line.startsWith("Which")) continue;
    pressed.push(keys[pressed.length]);
    for (const key of ["7", "w", pressed.at(-1)]) await page.keyboard.press(key); // 7 is no answer, w no digit
  }
  clearTimeout(bound);
  check("the protocol ends", (await trial.ended) === 0);
  return pressed;
}

await play(async () => {
  const shipped = join(root, "model/scenes");
  writeFileSync(scene, readFileSync(join(shipped, "liver.toml"), "utf8").replaceAll('"meshes/', `"${shipped}/meshes/`));
  writeFileSync(
    protocol,
    'name = "stiffness"\nscene = "liver.toml"\nseed = 7\nparameter = "elastic.youngs_modulus_Pa"\n' +
      `[[block]]\nname = "a"\nreference = 5000\nmethod = "constant"\nlevels = [0.2]\nrepeats = 4\n`,
  );
  const tactd = await tactd_runs();
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  const trial = run("tact-trial", protocol, "--out", join(folder, "out"), "--answers", "page", "--socket", socket);
  const pressed = await answer(trial, page);
  const table = readFileSync(join(folder, "out/task-stiffness_events.tsv"), "utf8").trim().split("\n");
  const column = table[0].split("\t").indexOf("response");
  const responses = table.slice(1).map((row) => row.split("\t")[column]);
  check("each answer is the key that was pressed", responses.join() === pressed.join(), responses.join());
  await browser.close();
  await stop(tactd);
  const csv = join(folder, "run.csv");
  const replay = run("tactd", scene, "--replay", log, "--csv", csv);
  replay.stdout.resume();
  check("the log replays to the same forces", (await replay.ended) === 0);
  const marks = events(readFileSync(csv, "utf8")).filter((event) => event > 3);
  check("the tick log has a mark for each answer", marks.join() === pressed.map((key) => Number(key) + 3).join(), marks.join());
});
