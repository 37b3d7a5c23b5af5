// SPDX-License-Identifier: Apache-2.0
// parameter_scale.ts - a slider for a number whose range spans many decades: by the logarithm, from a
// tenth of the shipped value to ten times it, within the range. The field beside it takes all of the
// range. A number that is shipped as 0 has its whole range, evenly. And which text is a number.

import type { Parameter } from "../link/protocol";

const kDecade = 10;
const kDigits = 4; // more make no noticeable force

function ends(of: Parameter): { low: number; high: number; even: boolean } {
  if (!(of.value > 0)) return { low: of.low, high: of.high, even: true };
  return { low: Math.max(of.low, of.value / kDecade), high: Math.min(of.high, of.value * kDecade), even: false };
}

/** Its position on the slider, 0 to 1. */
export function share_of(of: Parameter, value: number): number {
  const { low, high, even } = ends(of);
  const share = even ? (value - low) / (high - low) : Math.log(value / low) / Math.log(high / low);
  return Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0));
}

/** The value there, with few digits, within its range. */
export function value_at(of: Parameter, share: number): number {
  const { low, high, even } = ends(of);
  const exact = even ? low + share * (high - low) : low * Math.pow(high / low, share);
  const value = of.whole ? Math.round(exact) : Number(exact.toPrecision(kDigits));
  return Math.min(of.high, Math.max(of.low, value));
}

/** No row of zeros. */
const short = (value: number): string => (value >= 1e6 ? value.toExponential() : String(value));

/** "0.01 .. 100000 N/m" */
export function range_words(of: Parameter): string {
  return `${short(of.low)} .. ${short(of.high)}${of.unit && ` ${of.unit}`}${of.whole ? ", whole" : ""}`;
}

/** NaN: the text is no number, as with a decimal comma. */
export function number_in(text: string): number {
  const value = text.trim() === "" ? NaN : Number(text);
  return Number.isFinite(value) ? value : NaN;
}

/** Of a text that is none: what is wrong with it. */
export function why_no_number(name: string, text: string): string {
  const written = text.trim();
  if (written === "") return `${name} has no number`;
  const with_point = written.replace(",", ".");
  const remedy = Number.isNaN(number_in(with_point)) ? "" : `: write ${with_point}`;
  return `${name}: ${written} is no number${remedy}`;
}
