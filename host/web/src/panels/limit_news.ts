// SPDX-License-Identifier: Apache-2.0
// limit_news.ts - which fault or limit is shown, and for how long: of a recording none of another time.

import { describe, kStopped, latches } from "./faults";
import { is_jump, kContactInside, time_s_of, type Frame } from "../link/protocol";

const kHold_ms = 1500; // a limit that acted for one tick stays readable this long
const kLoss_ms = 4000; // lost contact is over in one tick: it is looked for after it has happened
const kToolInside = 14;
const kContactLost = 15;

export class LimitNews {
  private number = 0;
  private seen_ms = -Infinity;
  private losses: number | null = null; // so far, of the last frame
  private lost_ms = -Infinity;
  private last_s = -Infinity; // time of the last frame

  /** `sought`: of a recording, where a jump leads to another time; a live run goes on. */
  frame(frame: Frame, now_ms: number, sought = false): void {
    if (sought && is_jump(this.last_s, time_s_of(frame))) {
      this.number = 0;
      this.losses = null;
      this.lost_ms = -Infinity;
    }
    this.last_s = time_s_of(frame);
    const over = latches(this.number) && frame.fault === 0 && frame.state !== kStopped;
    if (over) this.number = 0; // reset, or a replay went back
    const inside = frame.contacts.some((contact) => contact.state === kContactInside);
    const acting = frame.fault || (inside ? kToolInside : frame.limit);
    if (acting > 0) {
      this.number = acting;
      this.seen_ms = now_ms;
    }
    if (this.losses !== null && frame.contact_losses > this.losses) this.lost_ms = now_ms;
    this.losses = frame.contact_losses;
  }

  /** Its number in the table of faults; 0: none. */
  shown(now_ms: number): number {
    if (latches(this.number)) return this.number;
    if (now_ms - this.seen_ms >= kHold_ms) this.number = 0;
    return this.number === 0 && this.is_lost(now_ms) ? kContactLost : this.number;
  }

  /** The headline of what is shown. */
  name(now_ms: number): string {
    const number = this.shown(now_ms);
    const name = number === kToolInside ? "Inside the organ: take the tool out" : describe(number).name;
    const lost = number !== kContactLost && this.is_lost(now_ms);
    return `${lost ? `${describe(kContactLost).name} · ` : ""}${name} (${number})`;
  }

  private is_lost(now_ms: number): boolean {
    return now_ms - this.lost_ms < kLoss_ms;
  }
}
