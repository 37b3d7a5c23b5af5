// SPDX-License-Identifier: Apache-2.0
// tank.c - the energy that may still be given, for any measurements.
#include "tests/proof/arithmetic.h"
#include MADE
#include LAYOUT

int main(void) {
  forget();
  ASSUME(BUDGET > 0 && BUDGET <= 10 && IS_PLACED <= 1 && PERIODS >= 0 && !(ENERGY > 2 * BUDGET));
  double periods = nondet_double(), energy = ENERGY;
  ASSUME(periods >= 1 && periods <= 1e10);
  bool fresh = nondet_uint8_t() & 1, was_placed = IS_PLACED;
  observe(fresh, periods);
  CHECK(!(ENERGY > 2 * BUDGET), "passivity: the tank holds two budgets at the most");
  CHECK(fresh || ENERGY == energy || IS_NAN(energy), "passivity: without a sample the tank stays");
  CHECK(!fresh || (UNSEEN == 0 && PERIODS == 0 && IS_PLACED == 1),
        "passivity: a sample settles what was unseen");
  CHECK(!IS_NAN(ENERGY) || overdrawn(), "passivity: a tank that is no number is overdrawn");
  CHECK(!(ENERGY < -2e-9) || overdrawn(), "passivity: a tank below zero is overdrawn");
  double allowed = passive();
  CHECK(IS_PLACED || allowed == 0, "passivity: no force before the first sample");
  CHECK(ENERGY > 0 || ENERGY - UNSEEN > 0 || allowed == 0,
        "passivity: an empty tank allows no force");
#ifdef TACT_WITNESS
  CHECK(allowed == 0, "witness: a tank can allow a force");
#endif
}
