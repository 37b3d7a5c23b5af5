// SPDX-License-Identifier: Apache-2.0
// snapshot.ts - the picture as a file: what is drawn, and under it what it is of.

const kBackground = "#131920";
const kLine_px = 22;
const kMargin_px = 14;

/** `canvas` was drawn in this turn. */
export function snapshot(canvas: HTMLCanvasElement, lines: readonly string[]): Promise<Blob | null> {
  const page = document.createElement("canvas");
  page.width = canvas.width;
  page.height = canvas.height + lines.length * kLine_px + 2 * kMargin_px;
  const pen = page.getContext("2d")!;
  pen.fillStyle = kBackground;
  pen.fillRect(0, 0, page.width, page.height);
  pen.drawImage(canvas, 0, 0);
  pen.fillStyle = "#e8edf2";
  pen.font = "14px system-ui, sans-serif";
  lines.forEach((line, i) =>
    pen.fillText(line, kMargin_px, canvas.height + kMargin_px + (i + 0.7) * kLine_px, page.width - 2 * kMargin_px),
  );
  return new Promise((done) => page.toBlob(done, "image/png"));
}
