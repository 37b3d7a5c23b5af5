// SPDX-License-Identifier: Apache-2.0
// heat.c - the contract of ThermalLimit::allowed in contracts.h, whatever the heat is.
#define TACT_SQUARES
#define TACT_PEAK heat_0_d
static double heat_0_d;
#include "tests/proof/arithmetic.h"
#include MADE
#include LAYOUT

int main(void) {
  forget();
  ASSUME(PEAK >= 1e-150 && PEAK <= 1e3 && CONTINUOUS_SQUARED >= 0 && CONTINUOUS_SQUARED <= 1e6 &&
         STEEPNESS >= 0);
  double allowed = warm();
  CHECK(allowed >= 0, "magnitude: what heat allows is a number, zero or more");
  CHECK(allowed <= PEAK, "magnitude: what heat allows is no more than the peak");
#ifdef TACT_WITNESS
  CHECK(allowed == PEAK, "witness: heat can allow less than the peak");
#endif
}
