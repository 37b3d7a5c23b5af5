// SPDX-License-Identifier: Apache-2.0
// save_picture.ts - the picture as a file, with what it is of.

import { dated_name, save } from "./file_names";
import { describe_past_state, describe_state } from "../panels/faults";
import { length_of, time_s_of, type Frame, type Scene, type Status } from "../link/protocol";
import type { Stage } from "../scene/stage";

const kKept_ms = 60_000; // then the browser has it

/** `zero_s`: what the time of the plots begins with. */
export async function save_picture(
  stage: Stage,
  scene: Scene,
  status: Status | null,
  shown: Frame,
  zero_s: number,
): Promise<void> {
  const { name, words } = (status?.link === "replay" ? describe_past_state : describe_state)(shown.state, shown.fault);
  const from = status?.link === "replay" ? `, ${status.detail}` : "";
  const blob = await stage.picture([
    `${scene.scene_name}${from} · ${scene.law_name} · ${scene.device_name}`,
    `${(time_s_of(shown) - zero_s).toFixed(2)} s · force ${length_of(shown.force_N).toFixed(2)} N · ${name}: ${words}`,
  ]);
  if (!blob) return;
  const url = URL.createObjectURL(blob);
  save(url, dated_name(scene.scene_name, "png"));
  setTimeout(() => URL.revokeObjectURL(url), kKept_ms);
}
