// SPDX-License-Identifier: Apache-2.0
// plot.ts - some lines over time with their units, a legend, and the values where one points; in all
// plots at once. What lies outside the range is marked at its edge.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { outside, type Range } from "./scale";

const kHeight_px = 112;
const kMark_px = 5;

interface Line {
  label: string;
  color: string;
  fill?: string;
  dash?: number[];
}

export interface PlotSettings {
  title: string;
  unit: string;
  digits: number;
  lines: readonly Line[];
  range: (values: readonly (number | null)[]) => Range;
  /** What the caption says of the newest values of all lines. */
  headline: (values: readonly number[]) => number;
}

/** By its size, with its sign. */
export function largest(values: readonly number[]): number {
  return values.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
}

function span(parent: HTMLElement, name: string, text = ""): HTMLElement {
  const out = document.createElement(name);
  out.textContent = text;
  parent.append(out);
  return out;
}

export class Plot {
  private readonly plot: uPlot;
  private readonly value: HTMLElement;
  private readonly clipped: HTMLElement;
  private readonly legend: HTMLElement[];
  private times_s: number[] = [];
  private values: (number | null)[][] = [];
  private range: Range = { low: 0, high: 1 };
  private pointed: number | null = null; // index of a time
  private used: number;

  constructor(
    private readonly parent: HTMLElement,
    private readonly settings: PlotSettings,
  ) {
    const { lines, title, unit } = settings;
    const caption = span(parent, "figcaption");
    span(caption, "span", `${title}, ${unit}`);
    this.legend = lines.map((line) => {
      const entry = span(caption, "span", line.label);
      entry.className = line.dash ? "line dashed" : "line";
      entry.style.setProperty("--color", line.color);
      entry.hidden = lines.length < 2;
      return entry;
    });
    this.clipped = span(caption, "span");
    this.clipped.className = "clipped";
    this.clipped.title = "beyond the range of this plot, and the farthest";
    this.value = span(caption, "b");
    this.used = lines.length;
    this.plot = new uPlot(this.options(), [[], ...lines.map(() => [])] as uPlot.AlignedData, parent);
    new ResizeObserver(() => this.plot.setSize({ width: this.width(), height: kHeight_px })).observe(parent);
  }

  /** The first `count` lines alone. */
  use(count: number): void {
    this.used = count;
    this.legend.forEach((entry, i) => (entry.hidden = i >= count || count < 2));
  }

  draw(times_s: number[], values: (number | null)[][], span_s: number): void {
    this.times_s = times_s;
    this.values = values.map((line, i) => (i < this.used ? line : line.map(() => null)));
    const last_s = times_s[times_s.length - 1] ?? 0;
    const first = times_s.findIndex((time_s) => time_s >= last_s - span_s);
    this.range = this.settings.range(this.values.slice(0, this.used).flatMap((line) => line.slice(first)));
    this.plot.batch(() => {
      this.plot.setData([times_s, ...this.values] as uPlot.AlignedData, false);
      this.plot.setScale("x", { min: last_s - span_s, max: last_s });
    });
    const shown = this.values[0].slice(first);
    const rare = outside(shown, this.range).map((i) => shown[i] ?? 0);
    this.clipped.textContent = rare.length === 0 ? "" : `▼ ${rare.length}, to ${this.words(largest(rare))}`;
    this.write();
  }

  private write(): void {
    const at = this.pointed !== null && this.pointed < this.times_s.length ? this.pointed : null;
    const index = at ?? this.times_s.length - 1;
    const now = this.values.slice(0, this.used).map((line) => line[index] ?? 0);
    const when = at === null ? "" : `at ${this.times_s[at].toFixed(2)} s: `;
    // Of many one says enough, but who points wants them all.
    this.value.textContent =
      when +
      (at === null
        ? this.words(this.settings.headline(now))
        : `${now.map((value) => value.toFixed(this.settings.digits)).join(" · ")} ${this.settings.unit}`);
  }

  private words(value: number): string {
    return `${value.toFixed(this.settings.digits)} ${this.settings.unit}`;
  }

  private width(): number {
    return Math.max(120, this.parent.clientWidth - 20);
  }

  private options(): uPlot.Options {
    const axis = {
      stroke: "#93a1af",
      font: "11px system-ui, sans-serif",
      grid: { stroke: "rgba(160,180,200,0.10)", width: 1 },
      ticks: { show: false },
    };
    return {
      width: this.width(),
      height: kHeight_px,
      pxAlign: false,
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, sync: { key: "tact" }, points: { show: false } },
      padding: [6, 16, 0, 0],
      scales: { x: { time: false }, y: { range: () => [this.range.low, this.range.high] } },
      axes: [
        { ...axis, size: 18, gap: 2, space: 50, values: (_, at_s) => at_s.map((s) => `${s} s`) },
        { ...axis, size: 44, gap: 4, space: 20 },
      ],
      series: [
        {},
        ...this.settings.lines.map((line) => ({
          label: line.label,
          stroke: line.color,
          fill: line.fill,
          dash: line.dash,
          width: 1.6,
          points: { show: false },
        })),
      ],
      hooks: {
        draw: [(plot) => this.mark(plot)],
        setCursor: [
          (plot) => {
            this.pointed = plot.cursor.idx ?? null;
            if (this.times_s.length > 0) this.write();
          },
        ],
      },
    };
  }

  /** A red tip at the edge for each value beyond it. */
  private mark(plot: uPlot): void {
    const { left, top, width, height } = plot.bbox;
    const size = kMark_px * devicePixelRatio;
    plot.ctx.save();
    plot.ctx.beginPath();
    plot.ctx.fillStyle = "#ff6f64";
    for (const line of this.values.slice(0, this.used))
      for (const i of outside(line, this.range)) {
        const x = plot.valToPos(this.times_s[i], "x", true);
        if (x < left || x > left + width) continue;
        const below = (line[i] ?? 0) < this.range.low;
        const tip = below ? top + height : top;
        const back = below ? tip - 2 * size : tip + 2 * size;
        plot.ctx.moveTo(x, tip);
        plot.ctx.lineTo(x - size, back);
        plot.ctx.lineTo(x + size, back);
        plot.ctx.closePath();
      }
    plot.ctx.fill();
    plot.ctx.restore();
  }
}
