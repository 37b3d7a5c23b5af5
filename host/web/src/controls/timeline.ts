// SPDX-License-Identifier: Apache-2.0
// timeline.ts - where a recording is, how long it is, how fast it plays, where the force was stopped.
// It asks; the tact-view that replays moves, and all pages with it.

import { describe } from "../panels/faults";
import { by_id } from "../document/dom";
import type { Replay, ReplayRequest } from "../link/protocol";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const kBack_s = 1;
const kNear_s = 0.02; // a stop that is shown is not the next one
const kArrived_s = 0.5; // a frame so near to where it shall go comes from there
const kTimeout_ms = 1000; // then frames count again, wherever they are from

/** The next speed of the list; at its end the same again. */
export function next_speed(ratio: number, faster: boolean): number {
  const others = kSpeeds.filter((speed) => (faster ? speed > ratio : speed < ratio));
  return (faster ? others[0] : others[others.length - 1]) ?? ratio;
}

/** The next stop after this time, from the first one again; null: there is none. */
export function next_stop(replay: Replay, at_s: number): number | null {
  const stop = replay.stops.find((one) => one.at_s > at_s + kNear_s) ?? replay.stops[0];
  return stop ? stop.at_s : null;
}

export class Timeline {
  private replay: Replay | null = null;
  private at_s = 0;
  private wanted_s: number | null = null; // not asked for yet: once per picture is enough
  private gone_to: { at_s: number; until_ms: number } | null = null; // frames on their way are from before
  private readonly seek = by_id<HTMLInputElement>("seek");
  private readonly speed = by_id<HTMLSelectElement>("speed");
  private held = false; // by a finger: frames do not move it

  constructor(private readonly ask: (request: ReplayRequest) => void) {
    for (const ratio of kSpeeds) this.speed.add(new Option(`${ratio} ×`, String(ratio)));
    this.seek.addEventListener("input", () => this.go(Number(this.seek.value)));
    this.seek.addEventListener("pointerdown", () => (this.held = true));
    for (const end of ["pointerup", "pointercancel", "change"]) this.seek.addEventListener(end, () => (this.held = false));
    this.speed.addEventListener("change", () => ask({ speed_ratio: Number(this.speed.value) }));
    by_id("play").addEventListener("click", () => this.toggle());
    by_id("repeat").addEventListener("click", () => this.replay && ask({ repeats: !this.replay.repeats }));
    by_id("next_stop").addEventListener("click", () => this.to_next_stop());
  }

  /** Null: nothing is replayed. */
  status(replay: Replay | null): void {
    const is_new = replay && JSON.stringify(replay.stops) !== JSON.stringify(this.replay?.stops);
    this.replay = replay;
    by_id("timeline").hidden = !replay;
    document.body.classList.toggle("replay", replay !== null);
    if (!replay) return;
    this.seek.max = String(Math.max(replay.length_s, 0.001));
    by_id("play_word").textContent = replay.playing ? "Pause" : "Play";
    by_id("repeat").classList.toggle("on", replay.repeats);
    by_id("repeat").setAttribute("aria-pressed", String(replay.repeats));
    this.choose_speed(replay.speed_ratio);
    if (is_new) this.mark(replay);
    this.write();
  }

  frame(time_s: number): void {
    if (!this.replay) return;
    const at_s = Math.min(Math.max(time_s - this.replay.start_s, 0), this.replay.length_s);
    const gone = this.gone_to;
    if (gone && Math.abs(at_s - gone.at_s) > kArrived_s && performance.now() < gone.until_ms) return;
    this.gone_to = null;
    this.at_s = at_s;
    this.write();
  }

  /** Once per picture. */
  draw(): void {
    if (this.wanted_s === null) return;
    this.ask({ at_s: this.wanted_s });
    this.wanted_s = null;
  }

  /** True if the key means something to a replay. */
  key(key: string, shift: boolean): boolean {
    if (!this.replay) return false;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => (shift ? this.ask({ step_frames: -1 }) : this.go(this.at_s - kBack_s)),
      ArrowRight: () => (shift ? this.ask({ step_frames: 1 }) : this.go(this.at_s + kBack_s)),
      ArrowUp: () => this.change_speed(true),
      ArrowDown: () => this.change_speed(false),
      Home: () => this.go(0),
      End: () => this.go(this.replay?.length_s ?? 0),
      n: () => this.to_next_stop(),
    };
    const act = Object.hasOwn(keys, key) ? keys[key] : null;
    act?.();
    return act !== null;
  }

  toggle(): void {
    if (this.replay) this.ask({ playing: !this.replay.playing });
  }

  private to_next_stop(): void {
    const stop_s = this.replay && next_stop(this.replay, this.at_s);
    if (stop_s !== null) this.ask({ at_s: stop_s, playing: false });
  }

  private go(at_s: number): void {
    if (!this.replay) return;
    this.at_s = this.wanted_s = Math.min(Math.max(at_s, 0), this.replay.length_s);
    this.gone_to = { at_s: this.at_s, until_ms: performance.now() + kTimeout_ms };
    this.write();
  }

  private change_speed(faster: boolean): void {
    if (this.replay) this.ask({ speed_ratio: next_speed(this.replay.speed_ratio, faster) });
  }

  /** Another program may have set one that is not in the list. */
  private choose_speed(ratio: number): void {
    const text = String(ratio);
    if (![...this.speed.options].some((option) => option.value === text)) this.speed.add(new Option(`${ratio} ×`, text));
    this.speed.value = text;
  }

  private mark(replay: Replay): void {
    const marks = replay.stops.map((stop) => {
      const mark = document.createElement("i");
      mark.style.left = `${(100 * stop.at_s) / Math.max(replay.length_s, 0.001)}%`;
      return mark;
    });
    by_id("stops").replaceChildren(...marks);
    const names = replay.stops.map(
      (stop) => `${stop.at_s.toFixed(1)} s: ${stop.fault > 0 ? describe(stop.fault).name : "stopped on request"}`,
    );
    by_id("next_stop").hidden = marks.length === 0;
    by_id("next_stop").title = `The next place where the force was stopped (${names.join("; ")})`;
  }

  private write(): void {
    if (!this.replay) return;
    const words = `${this.at_s.toFixed(1)} of ${this.replay.length_s.toFixed(1)} s`;
    if (!this.held) this.seek.value = String(this.at_s);
    if (by_id("at").textContent === words) return;
    by_id("at").textContent = words;
    this.seek.setAttribute("aria-valuetext", words);
  }
}
