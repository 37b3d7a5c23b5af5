// SPDX-License-Identifier: Apache-2.0
// faults.ts - the words behind the numbers of a frame, faults and states: tactd's own, which
// tools/packages.sh asks it for before the page is built (tactd --faults --json faults.json).

import table from "./faults.json";

export interface Fault {
  name: string;
  cause: string;
  remedy: string;
}

const kFaults = new Map<number, Fault>(table.faults.map((fault) => [fault.number, fault]));

/** Words for a number; one that this page does not know says so. */
export function describe(number: number): Fault {
  return (
    kFaults.get(number) ?? {
      name: `fault ${number}`,
      cause: "this page does not know this number",
      remedy: "run tactd --faults, and use tactd and tact-view of one build",
    }
  );
}

export interface State {
  name: string;
  words: string;
}

export const kStopped = 3;

/** A fault, which stays until a reset, not a limit that acts. */
export function latches(number: number): boolean {
  return table.faults.find((fault) => fault.number === number)?.latches ?? true;
}

/** In the state "stopped", no fault means that a person asked for it. */
export function describe_state(number: number, fault: number): State {
  const state = table.states[number] ?? { name: `state ${number}`, words: "unknown" };
  return number === kStopped && fault === 0 ? { ...state, words: "force is off: stopped on request" } : state;
}

/** The same of a recording: nothing of it is true now. */
export function describe_past_state(number: number, fault: number): State {
  const { name, words } = describe_state(number, fault);
  return { name: `was ${name}`, words: words.replace(/\bis\b/g, "was").replace(/^no (tissue )?force/, "there was $&") };
}
