// SPDX-License-Identifier: Apache-2.0
// plots.ts - depth, force and time left before the deadline over the last ten seconds.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { length_of, type Frame } from "./protocol";

const kSpan_s = 10;
const kRedraw_ms = 80; // plots need fewer pictures than the tissue
const kHeight_px = 92;

interface Line {
  label: string;
  color: string;
  fill?: string;
  dash?: number[];
}

class Plot {
  private readonly plot: uPlot;
  private readonly value: HTMLElement;

  constructor(
    private readonly parent: HTMLElement,
    title: string,
    private readonly lines: readonly Line[],
    least_range: number,
    private readonly words: (latest: readonly number[]) => string,
  ) {
    const caption = document.createElement("figcaption");
    const name = document.createElement("span");
    name.textContent = title;
    this.value = document.createElement("b");
    caption.append(name, this.value);
    parent.append(caption);
    const axis = {
      stroke: "#7d8b99",
      font: "11px system-ui, sans-serif",
      grid: { stroke: "rgba(160,180,200,0.10)", width: 1 },
      ticks: { show: false },
    };
    this.plot = new uPlot(
      {
        width: this.width(),
        height: kHeight_px,
        pxAlign: false,
        legend: { show: false },
        cursor: { show: false },
        padding: [6, 4, 2, 0],
        scales: {
          x: { time: false },
          y: { range: (_, low, high) => Plot.range(low, high, least_range) },
        },
        axes: [
          { ...axis, show: false },
          { ...axis, size: 38, gap: 4, space: 17 },
        ],
        series: [
          {},
          ...lines.map((line) => ({
            label: line.label,
            stroke: line.color,
            fill: line.fill,
            dash: line.dash,
            width: 1.6,
            points: { show: false },
          })),
        ],
      },
      [[], ...lines.map(() => [])] as uPlot.AlignedData,
      parent,
    );
    new ResizeObserver(() => this.plot.setSize({ width: this.width(), height: kHeight_px })).observe(parent);
  }

  draw(times_s: number[], values: (number | null)[][]): void {
    const now_s = times_s[times_s.length - 1] ?? 0;
    this.plot.setData([times_s, ...values] as uPlot.AlignedData, false);
    this.plot.setScale("x", { min: now_s - kSpan_s, max: now_s });
    this.value.textContent = this.words(this.lines.map((_, i) => values[i][values[i].length - 1] ?? 0));
  }

  private width(): number {
    return Math.max(120, this.parent.clientWidth - 20);
  }

  /** Zero stays in sight and noise is not blown up to full height. */
  private static range(low: number | null, high: number | null, least: number): [number, number] {
    const bottom = Math.min(0, low ?? 0);
    const top = Math.max(bottom + least, high ?? 0);
    return [bottom < 0 ? bottom * 1.1 : 0, top * 1.1];
  }
}

export class Plots {
  private times_s: number[] = [];
  private readonly depth_mm: (number | null)[][] = [[], [], [], []];
  private readonly force_N: number[][] = [[], []];
  private readonly margin_us: number[][] = [[]];
  private readonly depth: Plot;
  private readonly force: Plot;
  private readonly margin: Plot;
  private drawn_ms = 0;
  /** Probe spheres in use; the lines of the others stay away. */
  spheres = 0;

  constructor(byId: (id: string) => HTMLElement) {
    const deepest = (values: readonly number[]): string =>
      `${values.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0).toFixed(1)} mm`;
    const sites = ["#7fd1c7", "#e2907f", "#b9a3f0", "#d8c46a"];
    this.depth = new Plot(
      byId("plot_depth"),
      "depth",
      sites.map((color, i) => ({ label: `sphere ${i + 1}`, color })),
      5,
      deepest,
    );
    this.force = new Plot(
      byId("plot_force"),
      "force · asked by the law (dashed)",
      [
        { label: "asked", color: "#8c99a8", dash: [4, 4] },
        { label: "given", color: "#f2b04e", fill: "rgba(242,176,78,0.12)" },
      ],
      0.5,
      (values) => `${values[1].toFixed(2)} N`,
    );
    this.margin = new Plot(
      byId("plot_margin"),
      "time left before the deadline",
      [{ label: "margin", color: "#8fb8ff", fill: "rgba(143,184,255,0.12)" }],
      50,
      (values) => `${values[0].toFixed(0)} µs`,
    );
  }

  add(frame: Frame): void {
    const last_s = this.times_s[this.times_s.length - 1] ?? -Infinity;
    if (frame.time_s < last_s) this.clear(); // another run, or a replay from its start
    this.times_s.push(frame.time_s);
    this.depth_mm.forEach((line, i) => {
      const depth_m = frame.sites.find((site) => site.site === i)?.depth_m ?? 0;
      line.push(i < this.spheres ? depth_m * 1e3 : null);
    });
    this.force_N[0].push(length_of(frame.wanted_N));
    this.force_N[1].push(length_of(frame.force_N));
    this.margin_us[0].push(frame.margin_us ?? 0);
    if (this.times_s[0] < frame.time_s - 1.5 * kSpan_s) this.forget(frame.time_s - kSpan_s);
  }

  draw(now_ms: number): void {
    if (now_ms - this.drawn_ms < kRedraw_ms || this.times_s.length === 0) return;
    this.drawn_ms = now_ms;
    this.depth.draw(this.times_s, this.depth_mm);
    this.force.draw(this.times_s, this.force_N);
    this.margin.draw(this.times_s, this.margin_us);
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
