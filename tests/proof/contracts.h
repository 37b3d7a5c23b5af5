// SPDX-License-Identifier: Apache-2.0
// contracts.h - what the stages may take for granted of the parts that are proved alone. A part
// gives any result that keeps its contract; what it asks of its caller is checked at each call.
//
//     NORM(x, y, z)    the norm as limiter.h computes it, a function that nothing is known of
//     DISTANCE(...)    between two vectors, likewise
#pragma once

#include "tests/proof/arithmetic.h"

double __CPROVER_uninterpreted_norm(double, double, double);
double __CPROVER_uninterpreted_distance(double, double, double, double, double, double);
#define NORM __CPROVER_uninterpreted_norm
#define DISTANCE __CPROVER_uninterpreted_distance
#define IS_VECTOR(x, y, z) (IS_FINITE(x) && IS_FINITE(y) && IS_FINITE(z))

static void any_vector(double* x, double* y, double* z) {
  *x = nondet_double();
  *y = nondet_double();
  *z = nondet_double();
}

static double norm(double* x, double* y, double* z) {
  double length = NORM(*x, *y, *z);
  ASSUME(length >= 0 || !IS_VECTOR(*x, *y, *z));
  return length;
}

// limiter.c proves that what is within is finite.
static bool is_within(double* x, double* y, double* z, double limit) {
  CHECK(!(limit > 1e150), "contract: a limit is no more than 1e150");
  bool within = NORM(*x, *y, *z) <= limit;
  if (within) ASSUME(IS_VECTOR(*x, *y, *z));
  return within;
}

// limiter.c proves that the result is finite, gappa/limiter.g the length.
static bool limit_magnitude(double* x, double* y, double* z, double limit) {
  CHECK(!(limit > 1e150), "contract: a limit is no more than 1e150");
  bool cut = !(NORM(*x, *y, *z) <= limit);
  if (cut) any_vector(x, y, z);
  if (limit >= 0)
    ASSUME(NORM(*x, *y, *z) <= limit);
  else
    cut = true, *x = 0, *y = 0, *z = 0;
  ASSUME(IS_VECTOR(*x, *y, *z));
  return cut;
}

#ifndef TACT_APPROACH
// approach.c proves it, but for the distance: README.md.
static bool approach(double* x, double* y, double* z, double* bx, double* by, double* bz,
                     double step, double shrink, double radius) {
  CHECK(!(radius > 1e150), "contract: a radius is no more than 1e150");
  CHECK(step >= 0 && shrink >= step,
        "contract: the step of all periods is no less than that of one");
  CHECK(IS_VECTOR(*bx, *by, *bz), "contract: the force before is finite");
  bool held = nondet_uint8_t() & 1;
  if (held) any_vector(x, y, z);
  ASSUME(IS_VECTOR(*x, *y, *z));
  ASSUME(NORM(*x, *y, *z) <= radius || NORM(*x, *y, *z) <= NORM(*bx, *by, *bz));
  ASSUME(DISTANCE(*x, *y, *z, *bx, *by, *bz) <= shrink);
  return held;
}

// Nothing is taken for granted of what is taken from a force: what follows bears any.
static bool limit_surplus(double* fx, double* fy, double* fz, double* tx, double* ty, double* tz,
                          double* dx, double* dy, double* dz, double* ax, double* ay, double* az,
                          double most) {
  bool taken = nondet_uint8_t() & 1;
  if (taken) {
    any_vector(fx, fy, fz);
    any_vector(tx, ty, tz);
  }
  return taken;
}
static bool damp(int tank, double* fx, double* fy, double* fz, double* tx, double* ty, double* tz) {
  return limit_surplus(fx, fy, fz, tx, ty, tz, 0, 0, 0, 0, 0, 0, 0);
}

// Tank and thermal limit may be in any state; tank.c and thermal.c prove what follows.
static bool is_tank_overdrawn;
static void observe(int tank, int tool, bool fresh, double periods, int held) {
  is_tank_overdrawn = nondet_uint8_t() & 1;
}
static bool overdrawn(int tank) { return is_tank_overdrawn; }
static void refill(int tank) {}
static double passive(int tank) { return nondet_double(); }
static void thermal_add(int of, double* x, double* y, double* z, double periods) {}
static double peak_of(int thermal);
static double thermal_allowed(int thermal) {
  double allowed = nondet_double();
  ASSUME(allowed >= 0 && allowed <= peak_of(thermal));
  return allowed;
}
#endif
