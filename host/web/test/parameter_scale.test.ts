// SPDX-License-Identifier: Apache-2.0
// The slider of a number: its position, its value, and that it never leaves the range.

import assert from "node:assert/strict";
import { test } from "node:test";

import { number_in, range_words, share_of, value_at, why_no_number } from "../src/controls/parameter_scale";
import type { Parameter } from "../src/link/protocol";

const number = (value: number, low: number, high: number, whole = false): Parameter => ({
  key: "law.it_N_per_m",
  live: true,
  unit: "N/m",
  value,
  low,
  high,
  whole,
  meaning: "",
});

test("the shipped value is in the middle of two decades, and comes back from there", () => {
  const stiffness = number(1.604, 0.01, 1e5);
  assert.ok(Math.abs(share_of(stiffness, 1.604) - 0.5) < 1e-9);
  assert.equal(value_at(stiffness, 0.5), 1.604);
  assert.equal(value_at(stiffness, 0), 0.1604);
  assert.equal(value_at(stiffness, 1), 16.04);
});

test("no place of the slider is out of range", () => {
  for (const one of [number(1.3575, 0.05, 1.5), number(0.33335, 0.33333, 1), number(10, 1, 31, true), number(0, 0, 1e5)]) {
    for (let share = 0; share <= 1; share += 0.01) {
      const value = value_at(one, share);
      assert.ok(value >= one.low && value <= one.high, `${value} of ${one.low} .. ${one.high}`);
      assert.ok(!one.whole || Number.isInteger(value));
    }
  }
});

test("what is written beyond the slider, or nothing, is at an end", () => {
  const stiffness = number(1.604, 0.01, 1e5);
  assert.equal(share_of(stiffness, 9e4), 1);
  assert.equal(share_of(stiffness, 0), 0);
  assert.equal(share_of(stiffness, NaN), 0);
});

test("a range reads as in tactd", () => {
  assert.equal(range_words(number(1, 0.01, 1e5)), "0.01 .. 100000 N/m");
  assert.equal(range_words({ ...number(10, 1, 31, true), unit: "" }), "1 .. 31, whole");
  assert.equal(range_words({ ...number(10, 1, 1e13), unit: "Pa" }), "1 .. 1e+13 Pa");
});

test("a text is a number as a whole, or none: a decimal comma is reported, and never another number", () => {
  for (const [text, value] of [
    ["1.5", 1.5],
    [" 1.5 ", 1.5],
    ["-2e3", -2000],
    ["0", 0],
  ] as const)
    assert.equal(number_in(text), value);
  for (const text of ["1,5", "1,000.5", "", " ", "1.5 m", "soft", "1e999", "Infinity"])
    assert.ok(Number.isNaN(number_in(text)), text);
  assert.equal(why_no_number("rod_length_m", " 1,5 "), "rod_length_m: 1,5 is no number: write 1.5");
  assert.equal(why_no_number("rod_length_m", "1,000,000"), "rod_length_m: 1,000,000 is no number");
  assert.equal(why_no_number("rod_length_m", "soft"), "rod_length_m: soft is no number");
  assert.equal(why_no_number("rod_length_m", ""), "rod_length_m has no number");
});
