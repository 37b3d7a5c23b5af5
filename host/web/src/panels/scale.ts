// SPDX-License-Identifier: Apache-2.0
// scale.ts - the vertical range of a plot. One value far off the others does not make them a flat line:
// the range follows a percentile, and what lies beyond is marked at the edge.

export interface Range {
  low: number;
  high: number;
}

const kRare = 0.02; // of the values; a stall is one of 600

/** Zero stays in sight, and noise is not blown up to full height. */
export function whole_range(values: readonly (number | null)[], least: number): Range {
  const known = values.filter((value) => value !== null);
  return widen(Math.min(0, ...known), Math.max(0, ...known), least);
}

/** The same without the rarest values at either end, where those are far from the others. */
export function robust_range(values: readonly (number | null)[], least: number): Range {
  const known = values.filter((value) => value !== null).sort((a, b) => a - b);
  if (known.length === 0) return widen(0, 0, least);
  const rare = Math.floor(kRare * known.length);
  const low = Math.min(0, known[rare]);
  const high = Math.max(0, known[known.length - 1 - rare]);
  const room = Math.max(least, high - low); // what is no farther off than this is shown
  const least_value = Math.min(0, known[0]);
  const most = Math.max(0, known[known.length - 1]);
  return widen(low - least_value > room ? low : least_value, most - high > room ? high : most, least);
}

/** Indices of what lies outside. */
export function outside(values: readonly (number | null)[], range: Range): number[] {
  const out: number[] = [];
  values.forEach((value, i) => {
    if (value !== null && (value < range.low || value > range.high)) out.push(i);
  });
  return out;
}

function widen(low: number, high: number, least: number): Range {
  return { low: low < 0 ? low * 1.1 : 0, high: Math.max(low + least, high) * 1.1 };
}
