// SPDX-License-Identifier: Apache-2.0
// plots.ts - depth, force and time left before the deadline over the last ten seconds.

import { largest, Plot } from "./plot";
import { History, sample_of, samples_of, type Sample } from "./history";
import { is_jump, time_s_of, type Frame } from "../link/protocol";
import { robust_range, whole_range } from "./scale";

const kSpan_s = 10;
const kRedraw_ms = 80; // plots need fewer pictures than the tissue
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
  /** Ticks per second of a recording, whose frames before a sought one are asked for; 0: nothing is replayed. */
  replay_Hz = 0;
  private readonly history: History;

  constructor(byId: (id: string) => HTMLElement, fetch: (path: string) => Promise<Response>) {
    this.history = new History(fetch, (of, table) => this.prepend(of, samples_of(table, kSites.length)));
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
        { label: "wanted (law)", color: "#8c99a8", dash: [4, 4] },
        { label: "written (gate)", color: "#f2b04e", fill: "rgba(242,176,78,0.12)" },
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

  /** For tests: what is drawn, s since zero, and the force written. */
  get drawn(): { time_s: number[]; force_N: number[] } {
    return { time_s: this.times_s.map((time_s) => time_s - this.zero_s), force_N: this.force_N[1].slice() };
  }

  /** Probe spheres in use; the lines of the others stay away. */
  set spheres(count: number) {
    this.depth.use(count);
  }

  add(frame: Frame): void {
    const last_s = this.times_s[this.times_s.length - 1];
    if (time_s_of(frame) === last_s) return; // a recording that rests was sought where it is
    if (last_s === undefined || is_jump(last_s, time_s_of(frame))) {
      this.clear();
      if (this.replay_Hz > 0) this.history.before(frame, kSpan_s * this.replay_Hz);
    }
    this.push(sample_of(frame, kSites.length));
    if (this.times_s[0] < time_s_of(frame) - 1.5 * kSpan_s) this.forget(time_s_of(frame) - kSpan_s);
  }

  private push(sample: Sample): void {
    this.times_s.push(sample.time_s);
    this.depth_mm.forEach((line, i) => line.push(sample.depth_mm[i]));
    this.force_N.forEach((line, i) => line.push(sample.force_N[i]));
    this.margin_us[0].push(sample.margin_us);
  }

  /** Before what has come since this frame; nothing if the recording was sought again meanwhile. */
  private prepend(of: Frame, samples: readonly Sample[]): void {
    if (this.times_s[0] !== time_s_of(of)) return;
    const since = this.all().map((line) => line.slice());
    this.clear();
    for (const sample of samples) if (sample.time_s < time_s_of(of)) this.push(sample);
    this.all().forEach((line, i) => line.push(...since[i]));
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
