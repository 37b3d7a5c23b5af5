// SPDX-License-Identifier: Apache-2.0
// file_names.ts - names of saved files: what it is of and when it was saved, by this PC's clock, so that
// a folder of them is in order and none takes the place of another.

/** tact-liver-2026-03-01-140509.png */
export function dated_name(scene: string, ending: string, now = new Date()): string {
  const two = (n: number): string => String(n).padStart(2, "0");
  const day = [now.getFullYear(), two(now.getMonth() + 1), two(now.getDate())].join("-");
  const time = [now.getHours(), now.getMinutes(), now.getSeconds()].map(two).join("");
  const words = ["tact", scene.replace(/[^a-z0-9]+/gi, "-").replace(/^-|-$/g, ""), day, time];
  return `${words.filter((word) => word !== "").join("-")}.${ending}`;
}

export function save(url: string, name: string): void {
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
}

/** What the server answers, as a file. */
export async function save_answer(answer: Promise<Response>, name: string): Promise<void> {
  const url = URL.createObjectURL(await (await answer).blob());
  save(url, name);
  setTimeout(() => URL.revokeObjectURL(url), 60_000); // the browser reads it after the click
}
