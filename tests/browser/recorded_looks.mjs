// SPDX-License-Identifier: Apache-2.0
// recorded_looks.mjs - looks of a tracker from the recording of the scene maintenance, and false ones after them.
import { createSocket } from "node:dgram";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as wait_ms } from "node:timers/promises";

import { root } from "./stage.mjs";

const scenes = join(root, "model/scenes");
export const description = join(scenes, "maintenance.tracking.toml");
const observations = join(scenes, "maintenance.observations.jsonl");
export const kLeaning_s = [6.5, 9]; // of the recording

/** The looks of the recording before a time, s. */
export function write_looks_before(path, end_s) {
  const lines = readFileSync(observations, "utf8").trim().split("\n");
  writeFileSync(path, lines.filter((line) => JSON.parse(line).time_s < end_s).join("\n") + "\n");
}

/** Sends the looks of a file to a port, in their order and with their own timing, as a tracker would. */
export async function send_looks(path, port) {
  const socket = createSocket("udp4");
  let due_ms = performance.now();
  let before_s = Infinity; // a time that goes back comes at once
  for (const line of readFileSync(path, "utf8").trim().split("\n")) {
    const { time_s } = JSON.parse(line);
    due_ms += 1e3 * Math.max(0, time_s - before_s);
    before_s = time_s;
    if (due_ms > performance.now()) await wait_ms(due_ms - performance.now());
    await new Promise((done) => socket.send(line, port, "127.0.0.1", done));
  }
  socket.close();
}

/**
 * Leaning looks of the recording, then every body at two places 2.4 m apart in turn for more than a
 * second, then looks that are older than the last one.
 */
export function write_wild_looks(path) {
  const lines = readFileSync(observations, "utf8").trim().split("\n");
  const leaning = lines.filter((line) => JSON.parse(line).time_s >= kLeaning_s[0] && JSON.parse(line).time_s < kLeaning_s[1]);
  const bodies = [
    ...readFileSync(description, "utf8").matchAll(/^\[\[body\]\]\nname = "(\w+)"[^]*?^markers_m = (\[[^=]*\n\])/gm),
  ].map(([, body, markers]) => ({ body, markers: JSON.parse(markers.replace(/,\s*\]/g, "]")) }));
  let sequence = JSON.parse(leaning.at(-1)).sequence + 10;
  const wild = (time_s) =>
    bodies.map(({ body, markers }) => {
      const x_m = ++sequence % 2 ? 1.2 : -1.2;
      // f = 2000 px, as the description says; at 2.5 m before the camera
      const points = markers.map(([id, x, y, z]) => [id, (2000 * (x_m + x)) / (2.5 + z) + 960, (2000 * y) / (2.5 + z) + 540]);
      return JSON.stringify({ time_s, sequence, camera: "front", body, points });
    });
  const jumping = [];
  const stale = [];
  for (let i = 0; i < 36; ++i) {
    jumping.push(...wild(kLeaning_s[1] + i / 30));
    if (bodies.length % 2 === 0) ++sequence; // so that each body has another place than before
  }
  const end_s = kLeaning_s[1] + 1.2;
  for (let i = 0; i < 36; ++i) stale.push(...wild(end_s - 0.9 + (i % 18) / 22));
  writeFileSync(path, [...leaning, ...jumping, ...stale].join("\n") + "\n");
}
