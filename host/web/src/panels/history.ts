// SPDX-License-Identifier: Apache-2.0
// history.ts - what the plots draw of a frame, and of the frames of a recording before one that was sought.

import { length_of, time_s_of, type Frame, type Vec } from "../link/protocol";

/** One moment of all plots. */
export interface Sample {
  time_s: number;
  depth_mm: number[]; // of each sphere
  force_N: [number, number]; // wanted, written
  margin_us: number;
}

export function sample_of(frame: Frame, spheres: number): Sample {
  const depth_m = (i: number): number => frame.contacts.find((contact) => contact.contact === i)?.depth_m ?? 0;
  return {
    time_s: time_s_of(frame),
    depth_mm: Array.from({ length: spheres }, (_, i) => 1e3 * depth_m(i)),
    force_N: [length_of(frame.wanted_force_N), length_of(frame.force_N)],
    margin_us: frame.worst_margin_us ?? 0,
  };
}

/** Of recording.csv (host/record/recording_csv.h). */
export function samples_of(table: string, spheres: number): Sample[] {
  const [head, ...rows] = table
    .split("\n")
    .filter((line) => line !== "" && !line.startsWith("#"))
    .map((line) => line.split(","));
  const column = new Map((head ?? []).map((name, i) => [name, i]));
  return rows.map((row) => {
    const value = (name: string): number => Number(row[column.get(name) ?? -1] ?? 0) || 0;
    const force_N = (name: string): number => length_of(["x", "y", "z"].map((axis) => value(`${name}_${axis}_N`)) as Vec);
    // A free sphere has no depth.
    const depth_mm = (i: number): number => (value(`contact${i + 1}_state`) === 0 ? 0 : 1e3 * value(`contact${i + 1}_depth_m`));
    return {
      time_s: 1e-9 * value("time_ns"),
      depth_mm: Array.from({ length: spheres }, (_, i) => depth_mm(i)),
      force_N: [force_N("wanted_force"), force_N("force")],
      margin_us: value("worst_margin_us"),
    };
  });
}

/** Asks for the seconds before a frame; while one answer is on its way, only the newest question waits. */
export class History {
  private wanted: Frame | null = null;
  private busy = false;

  constructor(
    private readonly fetch: (path: string) => Promise<Response>,
    private readonly take: (of: Frame, table: string) => void,
  ) {}

  before(frame: Frame, ticks: number): void {
    this.wanted = frame;
    if (!this.busy) void this.ask(ticks);
  }

  private async ask(ticks: number): Promise<void> {
    this.busy = true;
    while (this.wanted) {
      const frame = this.wanted;
      this.wanted = null;
      const from = Math.max(0, frame.tick - Math.ceil(ticks));
      const answer = await this.fetch(`recording.csv?from_tick=${from}&to_tick=${frame.tick}`).catch(() => null);
      const table = answer?.ok ? await answer.text().catch(() => "") : "";
      this.take(frame, table);
    }
    this.busy = false;
  }
}
