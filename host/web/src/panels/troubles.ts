// SPDX-License-Identifier: Apache-2.0
// troubles.ts - what keeps the page from showing what is: said over the page until it is over, and once in the terminal
// of tact-view.

import { by_id } from "../document/dom";

/** A part of the page, and what is shown in place of "live" while it fails. */
export const kFailing = { picture: "no picture", page: "page error" } as const;
export type Part = keyof typeof kFailing;

const kAdvice: Record<Part, string> = {
  picture: "numbers and plots go on",
  page: "what is shown may be old or wrong: reload the page",
};
const kMaxText = 200; // of a header
const kHarmless = /^ResizeObserver loop/; // of a browser that resizes in the next picture
// eslint-disable-next-line no-control-regex
const kNotAscii = /[^\x20-\x7e]/g; // a header holds no more

export function words_of(error: unknown): string {
  return error instanceof Error ? `${error.name}: ${error.message}` : String(error);
}

/** One line of a header. */
export function header_text(words: string): string {
  return words.replace(kNotAscii, " ").slice(0, kMaxText);
}

export class Troubles {
  private readonly now = new Map<Part, string>();
  private readonly seen = new Set<string>();
  private unsent: string[] = [];

  /** `send`: false, it has not arrived; `changed`: the part that fails, null for none. */
  constructor(
    private readonly send: (text: string) => Promise<boolean>,
    private readonly changed: (failing: Part | null) => void,
  ) {}

  /** `remedy`: what a person can do. */
  report(part: Part, words: string, remedy = ""): void {
    if (this.now.get(part)?.startsWith(words)) return;
    this.now.set(part, [words, remedy, kAdvice[part]].filter((text) => text !== "").join("; "));
    this.show();
    if (this.seen.has(words)) return;
    this.seen.add(words);
    this.unsent.push(header_text(words));
    void this.flush();
  }

  over(part: Part): void {
    if (this.now.delete(part)) this.show();
  }

  /** With what is there to be sent; again when tact-view is heard again. */
  async flush(): Promise<void> {
    const waiting = this.unsent;
    this.unsent = [];
    for (const text of waiting) if (!(await this.send(text).catch(() => false))) this.unsent.push(text);
  }

  /** False when it has thrown: that is a trouble of its part. */
  guard(part: Part, act: () => void): boolean {
    try {
      act();
      return true;
    } catch (error) {
      console.error(error);
      this.report(part, `error in the ${part}: ${words_of(error)}`);
      return false;
    }
  }

  /** What was not caught. */
  listen(): void {
    window.addEventListener("error", ({ message, error, filename }) => {
      const foreign = filename !== "" && !filename.startsWith(location.origin); // of an extension of the browser
      if (!foreign && !kHarmless.test(message)) this.report("page", `error in the page: ${error ? words_of(error) : message}`);
    });
    window.addEventListener("unhandledrejection", ({ reason }) => this.report("page", `error in the page: ${words_of(reason)}`));
  }

  private show(): void {
    const words = [...this.now.values()].join(" · ");
    by_id("trouble").hidden = words === "";
    by_id("trouble").textContent = words;
    const failing = (["page", "picture"] as const).find((part) => this.now.has(part));
    this.changed(failing ?? null);
  }
}
