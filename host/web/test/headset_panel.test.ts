// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { HeadsetPanel, shown_lines } from "../src/operator/headset_panel";
import type { Said } from "../src/panels/hud";

const fits = (line: string): boolean => line.length <= 12;
const words = (count: number): string => Array.from({ length: count }, (_, i) => `word${i}`).join(" ");

/** What a panel says and what its canvas was asked to show, where every letter is half as wide as it is high. */
function show(warnings: string[]): { shown: string[]; painted: string[] } {
  const painted: string[] = [];
  const pen = {
    font: "",
    fillRect() {},
    strokeRect() {},
    fillText: (text: string) => void painted.push(text),
    measureText: (text: string) => ({ width: (text.length * Number(/(\d+)px/.exec(pen.font)![1])) / 2 }),
  };
  Object.assign(globalThis, { document: { createElement: () => ({ getContext: () => pen }) } });
  const panel = new HeadsetPanel(new THREE.Vector3(0.45, 0, 0.35));
  const said: Said = {
    state: "armed",
    state_tone: "good",
    state_words: "",
    link: "live",
    link_tone: "good",
    force_N: "0.50",
    force_of: "of 8 N",
    old: false,
    alarm: false,
    warnings: warnings.map((text) => ({ text, tone: "bad" })),
  };
  panel.show(said);
  return { shown: panel.shown, painted };
}

test("a text goes on in the next row, word by word", () => {
  assert.deepEqual(shown_lines(["one two three four"], 3, fits), [["one two", "three four"]]);
  assert.deepEqual(shown_lines(["a_word_as_wide_as_that b"], 3, fits), [["a_word_as_wide_as_that", "b"]]);
});

test("a text that is cut ends with dots that have room, and so does the last before one that is left out", () => {
  assert.deepEqual(shown_lines(["one two three four"], 1, fits), [["one two …"]]);
  assert.deepEqual(shown_lines(["twelve wide", "b"], 1, fits), [["twelve …"], []]);
  assert.deepEqual(shown_lines(["one two three four", "five"], 2, fits), [["one two", "three four …"], []]);
});

test("what has room has no dots", () => {
  assert.deepEqual(shown_lines(["one two three", "four"], 3, fits), [["one two", "three"], ["four"]]);
  assert.deepEqual(shown_lines([], 3, fits), []);
});

test("the panel reports what is painted on it, and no more", () => {
  for (const warnings of [[], ["short"], [words(60)], [words(20), words(20)], [words(10), words(70), "the last"]]) {
    const { shown, painted } = show(warnings);
    assert.equal(shown.join(" "), painted.join(" "));
  }
});

test("the panel says that it has no room for all", () => {
  const whole = show(["first", words(20)]);
  assert.deepEqual(whole.shown.slice(-2), ["first", words(20)]);
  for (const warnings of [[words(90)], [words(50), "the last"], [words(20), words(60), "the last"]]) {
    const { shown, painted } = show(warnings);
    assert.ok(painted[painted.length - 1].endsWith(" …"));
    assert.ok(shown[shown.length - 1].endsWith(" …"));
    assert.ok(!shown.includes("the last"));
  }
});
