// SPDX-License-Identifier: Apache-2.0
// thermal.c - the contract of ThermalLimit::allowed in contracts.h, in any thermal state.
#define TACT_SQUARES
#define TACT_PEAK thermal_0_d
static double thermal_0_d;
#include "tests/proof/arithmetic.h"
#include MADE
#include LAYOUT

int main(void) {
  forget();
  ASSUME(PEAK >= 1e-150 && PEAK <= 1e3 && CONTINUOUS_SQUARED >= 0 && CONTINUOUS_SQUARED <= 1e6 &&
         STEEPNESS >= 0);
  double allowed = thermal_allowed();
  CHECK(allowed >= 0, "magnitude: what the thermal limit allows is a number, zero or more");
  CHECK(allowed <= PEAK, "magnitude: what the thermal limit allows is no more than the peak");
#ifdef TACT_WITNESS
  CHECK(allowed == PEAK, "witness: the thermal limit can allow less than the peak");
#endif
}
