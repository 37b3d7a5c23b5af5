// SPDX-License-Identifier: Apache-2.0
// pace.ts - what comes faster than it can be read: the newest, once per period, and always the last.

export class Pace<T> {
  private waiting: T | null = null;
  private taken_ms = -Infinity;

  constructor(private readonly period_ms: number) {}

  /** In place of one that still waits. */
  add(item: T): void {
    this.waiting = item;
  }

  /** What is due now, once; null when nothing waits or the last one was taken a moment ago. */
  take(now_ms: number): T | null {
    if (this.waiting === null || now_ms - this.taken_ms < this.period_ms) return null;
    const item = this.waiting;
    this.waiting = null;
    this.taken_ms = now_ms;
    return item;
  }
}
