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

/** `first` takes what a timeline knows; `actions` are by key, and by name where a button has none. */
export function bind_keys(first: (key: string, shift: boolean) => boolean, actions: Record<string, () => unknown>): void {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || takes(event.target, event.key)) return;
    if (event.key === " ") event.preventDefault();
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (first(key, event.shiftKey)) return event.preventDefault(); // held down it goes on
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
