// SPDX-License-Identifier: Apache-2.0
// hud.ts - the panels: everything that is said in words and numbers.

import { by_id } from "../document/dom";
import { describe, describe_past_state, describe_state, latches } from "./faults";
import { LimitNews } from "./limit_news";
import { Pace } from "../link/pace";
import { kFailing, type Part } from "./troubles";
import { kContactInside, length_of, type FigureFrame, type Frame, type Scene, type Status } from "../link/protocol";

const kRewrite_ms = 100; // numbers that change faster cannot be read

function write(id: string, text: string): void {
  const element = by_id(id);
  if (element.textContent !== text) element.textContent = text;
}

function pill(id: string, text: string, tone: string): void {
  write(id, text);
  by_id(id).dataset.tone = tone;
}

/** What the panels say, for who does not see them. */
export interface Said {
  state: string;
  state_tone: string;
  state_words: string;
  link: string;
  link_tone: string;
  force_N: string;
  force_of: string;
  old: boolean;
  alarm: boolean;
  warnings: { text: string; tone: string }[];
}

export class Hud {
  private readonly limits = new LimitNews();
  private readonly unwritten = new Pace<Frame>(kRewrite_ms);
  private force_limit_N = 0;
  private continuous_force_N = 0;
  private energy_budget_J = 0;
  private status: Status | null = null;
  private why_gone = "";
  private silent = false;
  private has_frame = false; // of this run
  private is_drawn = false; // it was: only what is seen is live
  private failing: Part | null = null;
  private scene_known: Scene | null = null;

  private get is_replay(): boolean {
    return this.status?.link === "replay";
  }

  scene(scene: Scene, boundary_edges: number): void {
    this.scene_known = scene;
    this.force_limit_N = scene.force_limit_N;
    this.continuous_force_N = scene.continuous_force_N;
    this.energy_budget_J = scene.energy_budget_J;
    write("scene", scene.scene_name);
    write("law", scene.law_name);
    write("device", `${scene.device_name} · ${Math.round(scene.rate_Hz)} Hz`);
    by_id("open_organ").hidden = boundary_edges === 0;
    write("boundary_edges", `open organ, ${boundary_edges} boundary edges`);
    document.body.classList.toggle("has_torque", scene.torque_limit_Nm > 0);
    write("limits", scene.limits_checksum);
    write("force_of", `of ${Number(scene.force_limit_N.toPrecision(3))} N`);
    this.report_kind();
  }

  /** What is said of the whole run: it goes on, or it is a recording. */
  private report_kind(): void {
    by_id("now").setAttribute("aria-label", this.is_replay ? "In the recording" : "Now");
    const scene = this.scene_known;
    if (!scene) return;
    document.title = `tact: ${scene.scene_name}${this.is_replay ? " (replay)" : ""}`;
    const notes: string[] = [];
    if (scene.non_rt)
      notes.push(
        this.is_replay
          ? "recorded without hard real time: force capped at 25\u00a0%"
          : "no hard real time on this PC: force capped at 25\u00a0%",
      );
    if (scene.cannot_grip) notes.push("this scene grips; this device cannot: connect device.lines.grip");
    by_id("banner").hidden = notes.length === 0;
    write("banner", notes.join(" · "));
  }

  /** No status: tact-view is gone, or refuses this page, and says why. */
  link(status: Status | null, why = ""): void {
    const { link, scene_number } = this.status ?? {};
    if (link !== status?.link || scene_number !== status?.scene_number) this.has_frame = this.is_drawn = false;
    this.status = status;
    this.why_gone = why;
    this.write_link(status, why);
  }

  /** Once a picture of the last frame is drawn. */
  drawn(): void {
    if (this.is_drawn || !this.has_frame) return;
    this.is_drawn = true;
    this.write_link(this.status, this.why_gone);
  }

  /** The part of the page that fails; null: none. */
  fails(part: Part | null): void {
    this.failing = part;
    this.write_link(this.status, this.why_gone);
  }

  private write_link(status: Status | null, why: string): void {
    this.report_kind();
    const detail = status?.detail ? ` (${status.detail})` : "";
    if (!status && why) {
      pill("link", "not allowed", "bad");
      this.notice(why);
    } else if (!status) {
      pill("link", "viewer gone", "bad");
      this.notice("connection to tact-view lost; trying again …");
    } else if (status.link === "live") {
      if (this.failing) pill("link", kFailing[this.failing], "bad");
      else pill("link", this.is_drawn ? "live" : "no picture yet", this.is_drawn ? "good" : "wait");
      this.notice("");
    } else if (status.link === "replay") {
      pill("link", `replay: ${status.detail}`, "plain");
      this.notice("");
    } else if (status.picker?.asked) {
      pill("link", `starting ${status.picker.asked}`, "wait");
      this.notice(`starting ${status.picker.asked} …`);
    } else if (status.link === "lost") {
      pill("link", "connection lost", "bad");
      this.notice(`connection lost: tactd went away${detail}; waiting for it …`);
    } else {
      pill("link", "waiting for tactd", "wait");
      this.notice(`waiting for tactd${detail} …`);
    }
  }

  frame(frame: Frame, now_ms: number): void {
    this.has_frame = true;
    this.limits.frame(frame, now_ms, this.is_replay);
    this.unwritten.add(frame);
  }

  /** Once per picture: the last frame before a silence is the one with the reason. */
  draw(now_ms: number, fps: number): void {
    const frame = this.unwritten.take(now_ms);
    if (!frame) return;
    const force_N = length_of(frame.force_N);
    const share = Math.min(1, force_N / (this.force_limit_N || 1));
    const state = (this.is_replay ? describe_past_state : describe_state)(frame.state, frame.fault);
    const tones = ["plain", "wait", "good", frame.fault > 0 ? "bad" : "wait"];
    pill("state", state.name, this.is_replay ? "plain" : (tones[frame.state] ?? "bad"));
    write("state_words", state.words);
    write("force", force_N.toFixed(2));
    const bar = by_id("force_bar");
    bar.style.transform = `scaleX(${share.toFixed(3)})`;
    bar.dataset.tone = share > 0.95 ? "bad" : share > 0.5 ? "wait" : "good";
    const most_mNm = 1e3 * (this.scene_known?.torque_limit_Nm ?? 0);
    write("torque", `${(1e3 * length_of(frame.torque_Nm)).toFixed(1)} of ${most_mNm.toPrecision(3)} mN m`);
    write("depth", Hud.depth(frame));
    write("grip", Hud.grip(frame));
    write("rms", `${(frame.rms_force_N ?? 0).toFixed(2)} of ${this.continuous_force_N.toPrecision(2)} N`);
    write("energy", `${((frame.given_energy_J ?? 0) * 1e3).toFixed(1)} of ${(this.energy_budget_J * 1e3).toPrecision(3)} mJ`);
    write("tick", `${(frame.median_tick_us ?? 0).toFixed(1)} µs`);
    write("margin", `${(frame.worst_margin_us ?? 0).toFixed(0)} µs`);
    write("late", `${frame.late_ticks} · ${frame.skipped_ticks}`);
    write("fps", `${fps.toFixed(0)} /s`);
    this.fault(now_ms);
  }

  /** After `draw`. While nothing is heard, nothing is said of now. 0: there is news. */
  silence(seconds: number): void {
    const silent = seconds > 0;
    if (silent !== this.silent) {
      this.silent = silent;
      for (const id of ["now", "plots"]) by_id(id).classList.toggle("old", silent);
      this.write_link(this.status, this.why_gone);
    }
    if (!silent) return;
    pill("state", `no news for ${seconds.toFixed(1)} s`, "bad");
    write("state_words", "");
    if (this.status?.link !== "live") return; // what has gone is reported already
    pill("link", "silent", "bad");
    this.notice("tactd is silent: what is shown is old, and its force is not known");
  }

  /** After `silence`. `frozen`: a key holds the display. */
  said(frozen: boolean): Said {
    const text = (id: string): string => (by_id(id).hidden ? "" : (by_id(id).textContent ?? ""));
    const tone = (id: string): string => by_id(id).dataset.tone ?? "plain";
    const warnings: Said["warnings"] = [];
    const warn = (words: string, of: string): void => void (words && warnings.push({ text: words, tone: of }));
    if (frozen) warn("the display is frozen: what is shown is old", "wait");
    warn(text("trouble"), "bad");
    warn(text("notice"), tone("link"));
    if (!by_id("fault").hidden) {
      warn(text("fault_name"), tone("fault"));
      warn(`${text("fault_cause")}; ${text("fault_remedy")}`, "plain");
    }
    warn(text("banner"), "wait");
    const held = frozen && !this.silent;
    return {
      state: held ? `old: ${text("state")}` : text("state"),
      state_tone: held ? "wait" : tone("state"),
      state_words: text("state_words"),
      link: text("link"),
      link_tone: tone("link"),
      force_N: text("force"),
      force_of: text("force_of"),
      old: frozen || this.silent,
      alarm: [tone("state"), tone("link")].includes("bad"),
      warnings,
    };
  }

  /** Nothing to say hides the chip. */
  tracking(figure: FigureFrame | null): void {
    const chip = by_id("tracking");
    chip.hidden = !figure || figure.trouble === 0;
    if (figure && !chip.hidden) {
      const subject = (this.is_replay ? "recorded " : "") + (figure.trouble < 3 ? "tracking: " : "");
      pill("tracking", subject + figure.words, figure.trouble === 2 ? "bad" : "wait");
    }
  }

  pressed(id: string, on: boolean): void {
    by_id(id).classList.toggle("on", on);
    by_id(id).setAttribute("aria-pressed", String(on));
  }

  private fault(now_ms: number): void {
    const limit = this.limits.shown(now_ms);
    const box = by_id("fault");
    box.hidden = limit === 0;
    if (limit === 0) return;
    const words = describe(limit);
    box.dataset.tone = latches(limit) ? "bad" : "wait";
    write("fault_name", `${this.is_replay ? "in the recording: " : ""}${this.limits.name(now_ms)}`);
    write("fault_cause", words.cause);
    write("fault_remedy", words.remedy);
  }

  private notice(text: string): void {
    by_id("notice").hidden = text === "";
    write("notice", text);
  }

  private static depth(frame: Frame): string {
    if (frame.contacts.length === 0) return "free";
    if (frame.contacts.some((contact) => contact.state === kContactInside)) return "inside the organ";
    return frame.contacts.map((contact) => (contact.depth_m * 1e3).toFixed(1)).join(" · ") + " mm";
  }

  private static grip(frame: Frame): string {
    const force = Math.abs(frame.grip_force_N ?? 0) >= 0.05 ? `, ${frame.grip_force_N.toFixed(1)}\u00a0N` : "";
    if (frame.contacts.some((contact) => contact.state === 2)) return `holds tissue${force}`;
    const percent = Math.round((frame.grip_ratio ?? 0) * 100);
    return (percent < 2 ? "open" : percent > 98 ? "closed" : `${percent} %`) + force;
  }
}
