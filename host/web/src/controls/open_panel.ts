// SPDX-License-Identifier: Apache-2.0
// open_panel.ts - two panels that share one place: what opens and closes them, and where the focus goes.

import { by_id } from "../document/dom";

/** Opens it, or closes it; null closes both. */
export function toggle_panel(id: "keys" | "picker" | null): void {
  for (const [panel, button] of [
    ["keys", "help"],
    ["picker", "pick"],
  ]) {
    const open = panel === id && by_id(panel).hidden;
    by_id(panel).hidden = !open;
    by_id(button).classList.toggle("on", open);
    by_id(button).setAttribute("aria-expanded", String(open));
    if (!open) continue;
    by_id(panel).focus({ preventScroll: true }); // the next tab goes into it
    by_id(panel).scrollIntoView({ block: "start" });
  }
}

/** The focus goes back to the button of the one that was open. */
export function close_panel(): void {
  const button = document.querySelector<HTMLElement>("[aria-expanded=true]");
  toggle_panel(null);
  button?.focus();
}
