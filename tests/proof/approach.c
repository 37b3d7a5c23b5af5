// SPDX-License-Identifier: Apache-2.0
// approach.c - the contract of approach in contracts.h, from that of limit_magnitude, but for
// the distance: README.md.
#define TACT_APPROACH
#include "tests/proof/contracts.h"
#include MADE

int main(void) {
  forget();
  double step = nondet_double(), shrink = nondet_double(), radius = nondet_double();
  ASSUME(step >= 0 && shrink >= step && !(radius > 1e150) && step <= 1e149);
  ASSUME(IS_VECTOR(before_0_d, before_8_d, before_16_d) &&
         NORM(before_0_d, before_8_d, before_16_d) <= 1e149);
  ASSUME(NORM(before_0_d, before_8_d, before_16_d) >= 0 && NORM(0, 0, 0) == 0);
  double x = v_0_d, y = v_8_d, z = v_16_d;
  bool held = APPROACH(step, shrink, radius);
  double length = NORM(v_0_d, v_8_d, v_16_d);
  CHECK(IS_VECTOR(v_0_d, v_8_d, v_16_d), "slew: an approach is finite");
  CHECK(length <= radius || length <= NORM(before_0_d, before_8_d, before_16_d),
        "slew: an approach is no longer than its radius, or than the force before");
  CHECK(held || (v_0_d == x && v_8_d == y && v_16_d == z), "slew: what is in reach is left alone");
#ifdef TACT_WITNESS
  CHECK(!held, "witness: a force can be held");
#endif
}
