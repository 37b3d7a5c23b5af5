// SPDX-License-Identifier: Apache-2.0
// news.ts - how long nothing was heard: what was true in the last frame need not be true now.

const kSilence_ms = 300; // without a frame; longer where frames are rarer
const kLongestNap_ms = 100; // between two pictures: a page that was busy has not listened

export class News {
  private came_ms = 0; // the last frame
  private looked_ms = 0;
  private listened_ms = 0; // since it came
  private any = false;

  frame(now_ms: number): void {
    this.came_ms = this.looked_ms = now_ms;
    this.listened_ms = 0;
    this.any = true;
  }

  /** Once per picture: seconds since the last frame when that is too long ago, else 0. */
  silence_s(now_ms: number, frame_rate_Hz: number): number {
    this.listened_ms += Math.min(now_ms - this.looked_ms, kLongestNap_ms);
    this.looked_ms = now_ms;
    const timeout_ms = Math.max(kSilence_ms, 2500 / frame_rate_Hz);
    return this.any && this.listened_ms > timeout_ms ? (now_ms - this.came_ms) / 1000 : 0;
  }
}
