// SPDX-License-Identifier: Apache-2.0
// keys.ts - which key and which button does what.

import { by_id } from "../document/dom";

/** Buttons of the page, and the key that does the same. */
const kButtons: Record<string, string> = {
  pause: "p",
  hand: "m",
  close_grip: "grip",
  open_grip: "let go",
  record: "r",
  csv: "c",
  snap: "s",
  wire: "w",
  home: "v",
  figure: "f",
  eyes: "e",
  headset: "x",
  pick: "l",
  help: "h",
};

/** Who has the focus may want the key for itself: then it is not ours. */
function takes(target: EventTarget | null, key: string): boolean {
  if (key === "Escape") return false;
  if (target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.type === "text")) return true;
  return key === " " && (target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement);
}

/** Whether arrows and page keys already mean something there: a slider, or a panel or page that scrolls. */
function scrolls(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return true;
  for (let one = target instanceof Element ? target : null; one; one = one.parentElement) {
    const fixed = one !== document.scrollingElement && !/auto|scroll/.test(getComputedStyle(one).overflowY);
    if (!fixed && one.scrollHeight > one.clientHeight + 1) return true;
  }
  return false;
}

type Take = (key: string, shift: boolean) => boolean;

/**
 * `timeline` and `moves` take what they know: at the picture `moves` is asked first, elsewhere the timeline. `actions` are by
 * key, and by name where a button has none.
 */
export function bind_keys(timeline: Take, moves: Take, actions: Record<string, () => unknown>): void {
  const picture = by_id("view");
  // The mouse does not bring the keys to the picture: who clicks there goes on with the timeline.
  picture.addEventListener("mousedown", (event) => {
    event.preventDefault();
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
  });
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || takes(event.target, event.key)) return;
    if (event.key === " ") event.preventDefault();
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const takers = event.target === picture ? [moves, timeline] : scrolls(event.target) ? [timeline] : [timeline, moves];
    if (takers.some((take) => take(key, event.shiftKey))) return event.preventDefault(); // held down it goes on
    if (event.repeat) return;
    actions[key === " " ? "p" : key]?.();
  });
  for (const [id, key] of Object.entries(kButtons))
    by_id(id).addEventListener("click", (event) => {
      event.preventDefault();
      actions[key]();
    });
  // Who clicks with the mouse goes on with keys, and the space bar must not press the button again; who
  // came by the tab key stays there.
  window.addEventListener("click", (event) => {
    const button = event.target instanceof Element ? event.target.closest("button") : null;
    if (event.detail > 0) button?.blur();
  });
}
