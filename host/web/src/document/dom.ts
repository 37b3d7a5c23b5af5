// SPDX-License-Identifier: Apache-2.0
// dom.ts - the elements of index.html, by their ids.

export function by_id<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`index.html has no #${id}`);
  return found as T;
}
