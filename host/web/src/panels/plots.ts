// SPDX-License-Identifier: Apache-2.0
// plots.ts - depth, force and time left before the deadline over the last ten seconds.

import { largest, Plot } from "./plot";
import { length_of, time_s_of, type Frame } from "../link/protocol";
import { robust_range, whole_range } from "./scale";

const kSpan_s = 10;
const kRedraw_ms = 80; // plots need fewer pictures than the tissue
const kLongestGap_s = 1; // more is a jump of a replay, or another run
const kSites = ["#7fd1c7", "#e2907f", "#b9a3f0", "#d8c46a"];

export class Plots {
  private times_s: number[] = [];
  private readonly depth_mm: (number | null)[][] = [[], [], [], []];
  private readonly force_N: number[][] = [[], []];
  private readonly margin_us: number[][] = [[]];
  private readonly depth: Plot;
  private readonly force: Plot;
  private readonly margin: Plot;
  private drawn_ms = 0;
  /** What the time axis calls zero: where a recording begins. */
  zero_s = 0;

  constructor(byId: (id: string) => HTMLElement) {
    this.depth = new Plot(byId("plot_depth"), {
      title: "depth",
      unit: "mm",
      digits: 1,
      range: (values) => whole_range(values, 5),
      headline: largest,
      lines: kSites.map((color, i) => ({ label: `sphere ${i + 1}`, color })),
    });
    this.force = new Plot(byId("plot_force"), {
      title: "force",
      unit: "N",
      digits: 2,
      range: (values) => whole_range(values, 0.5),
      headline: ([, given_N]) => given_N,
      lines: [
        { label: "asked by the law", color: "#8c99a8", dash: [4, 4] },
        { label: "given", color: "#f2b04e", fill: "rgba(242,176,78,0.12)" },
      ],
    });
    this.margin = new Plot(byId("plot_margin"), {
      title: "time left",
      unit: "µs",
      digits: 0,
      range: (values) => robust_range(values, 50),
      headline: largest,
      lines: [{ label: "least", color: "#8fb8ff", fill: "rgba(143,184,255,0.12)" }],
    });
  }

  /** Probe spheres in use; the lines of the others stay away. */
  set spheres(count: number) {
    this.depth.use(count);
  }

  add(frame: Frame): void {
    const last_s = this.times_s[this.times_s.length - 1] ?? time_s_of(frame);
    if (time_s_of(frame) < last_s || time_s_of(frame) > last_s + kLongestGap_s) this.clear();
    this.times_s.push(time_s_of(frame));
    this.depth_mm.forEach((line, i) => line.push((frame.contacts.find((contact) => contact.contact === i)?.depth_m ?? 0) * 1e3));
    this.force_N[0].push(length_of(frame.wanted_force_N));
    this.force_N[1].push(length_of(frame.force_N));
    this.margin_us[0].push(frame.worst_margin_us ?? 0);
    if (this.times_s[0] < time_s_of(frame) - 1.5 * kSpan_s) this.forget(time_s_of(frame) - kSpan_s);
  }

  draw(now_ms: number): void {
    if (now_ms - this.drawn_ms < kRedraw_ms || this.times_s.length === 0) return;
    this.drawn_ms = now_ms;
    const times_s = this.times_s.map((time_s) => time_s - this.zero_s);
    this.depth.draw(times_s, this.depth_mm, kSpan_s);
    this.force.draw(times_s, this.force_N, kSpan_s);
    this.margin.draw(times_s, this.margin_us, kSpan_s);
  }

  private all(): (number | null)[][] {
    return [this.times_s, ...this.depth_mm, ...this.force_N, ...this.margin_us];
  }

  private clear(): void {
    for (const line of this.all()) line.length = 0;
  }

  private forget(before_s: number): void {
    const count = this.times_s.findIndex((time_s) => time_s >= before_s);
    for (const line of this.all()) line.splice(0, count);
  }
}
