// SPDX-License-Identifier: Apache-2.0
// limiter.c - the contract of limit_magnitude in contracts.h, but for the length: gappa/limiter.g.
#include "tests/proof/arithmetic.h"
#include MADE

#define IS_VECTOR(x, y, z) (IS_FINITE(x) && IS_FINITE(y) && IS_FINITE(z))

int main(void) {
  forget();
  double limit = nondet_double(), x = v_0_d, y = v_8_d, z = v_16_d;
  ASSUME(!(limit > 1e150));
  bool cut = shorten(limit);
  CHECK(IS_VECTOR(v_0_d, v_8_d, v_16_d), "magnitude: a limited vector is finite");
  CHECK(cut || (v_0_d == x && v_8_d == y && v_16_d == z),
        "magnitude: what is within is left alone");
  CHECK(limit >= 0 || (cut && v_0_d == 0 && v_8_d == 0 && v_16_d == 0),
        "magnitude: a limit that is none gives zero");
  CHECK(v_0_d == 0 || (v_0_d < 0) == (x < 0), "magnitude: no part changes its sign");
#ifdef TACT_WITNESS
  CHECK(!cut, "witness: a vector can be cut");
#endif
}
