// SPDX-License-Identifier: Apache-2.0
// pairs.ts - which frame is drawn next: one waits for its figure, as a hand and its tool are drawn together.

import type { Frame } from "../link/protocol";

// Of a frame for its figure, in pictures, or in frames that have none: no clock, as a page that stood still has both in
// its queue.
const kLongestWait = 6;

export class Pairs {
  private newest: Frame | null = null; // not drawn yet
  private waiting: Frame | null = null;
  private pictures_waited = 0;
  private frames_alone = 0; // since the last figure

  frame(frame: Frame, has_operator: boolean): void {
    if (!this.waiting) this.pictures_waited = 0;
    const waits = has_operator && ++this.frames_alone <= kLongestWait;
    this.waiting = waits ? frame : null;
    if (!waits) this.newest = frame;
  }

  figure(tick: number): void {
    this.frames_alone = 0;
    if (this.waiting?.tick === tick) this.release();
  }

  /** Once per picture: what is to be drawn, null: nothing new. */
  take(): Frame | null {
    // Without its figure, then: no tick is kept from a person's eyes.
    if (this.waiting && ++this.pictures_waited > kLongestWait) this.release();
    const due = this.newest;
    this.newest = null;
    return due;
  }

  /** Another scene. */
  clear(): void {
    this.waiting = null;
  }

  private release(): void {
    this.newest = this.waiting;
    this.waiting = null;
  }
}
