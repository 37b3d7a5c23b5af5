// SPDX-License-Identifier: Apache-2.0
// recorder.ts - the record button. tact-view keeps the last minutes anyway; recording marks a part
// of them by its ticks and saves it as a file that tact-view can open. The table is of the same ticks;
// without a recording, of all that is kept.

import { dated_name, save_answer } from "./file_names";
import { by_id } from "../document/dom";
import { time_s_of, type Frame } from "../link/protocol";

export class Recorder {
  private first: Frame | null = null;
  private last: Frame | null = null;
  private ticks = ""; // of the last recording, as a query
  scene = ""; // its name

  constructor(private readonly fetch: (path: string) => Promise<Response>) {}

  get on(): boolean {
    return this.first !== null;
  }

  frame(frame: Frame): void {
    if (this.last && frame.tick < this.last.tick) this.begin_again(); // another run began
    this.last = frame;
    if (!this.first) return;
    by_id("record").firstChild!.textContent = `Stop ${(time_s_of(frame) - time_s_of(this.first)).toFixed(0)} s `;
  }

  start(): void {
    this.ticks = "";
    this.first = this.last;
    if (this.first) by_id("record").classList.add("recording");
  }

  /** Ends the recording and saves it; nothing if none runs. */
  stop(): void {
    if (this.first && this.last) {
      this.ticks = this.range(this.first, this.last);
      void save_answer(this.fetch(`recording.tactview${this.ticks}`), dated_name(this.scene, "tactview"));
    }
    this.first = null;
    const button = by_id("record");
    button.classList.remove("recording");
    button.firstChild!.textContent = "Record ";
  }

  save_table(): void {
    const ticks = this.first && this.last ? this.range(this.first, this.last) : this.ticks;
    void save_answer(this.fetch(`recording.csv${ticks}`), dated_name(this.scene, "csv"));
  }

  private range(first: Frame, last: Frame): string {
    return `?from_tick=${first.tick}&to_tick=${last.tick}`;
  }

  private begin_again(): void {
    this.first = null;
    this.ticks = "";
  }
}
