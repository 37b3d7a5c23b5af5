// SPDX-License-Identifier: Apache-2.0
// arithmetic.h - doubles for CBMC. Sums, differences and comparisons are exact, bit by bit, with
// NaN, infinity and denormals. Products, quotients and roots are too dear for that: each gives any
// number that has the properties of the true one which stand here, and is proved of all of them.
// A root is a function: the same of the same number. With TACT_SQUARES so is a square.
//
// TACT_PEAK names a number p in [1e-150, 1e150] of which is used: fl(sqrt(x)) <= p for each x <=
// fl(p^2). The root rounds in order, and fl(sqrt(fl(p^2))) is p (Boldo, "Stupid is as stupid does",
// 2015).
#pragma once

#include <stdbool.h>
#include <stdint.h>

double nondet_double(void);
uint64_t nondet_uint64_t(void);
uint32_t nondet_uint32_t(void);
uint16_t nondet_uint16_t(void);
uint8_t nondet_uint8_t(void);
double __CPROVER_uninterpreted_square(double);
double __CPROVER_uninterpreted_root(double);

#define ANY(type) nondet_##type()
#define ASSUME __CPROVER_assume
#define CHECK(what, words) __CPROVER_assert(what, words)
#define IS_NAN __CPROVER_isnand
#define IS_INFINITE __CPROVER_isinfd
#define IS_FINITE __CPROVER_isfinited
#define FABS __CPROVER_fabs
#define ADD(a, b) ((a) + (b))
#define SUB(a, b) ((a) - (b))

static double BITS(uint64_t bits) {
  union {
    uint64_t bits;
    double number;
  } both;
  both.bits = bits;
  return both.number;
}
static double FMAX(double a, double b) { return IS_NAN(a) ? b : IS_NAN(b) ? a : a > b ? a : b; }
static double FMIN(double a, double b) { return IS_NAN(a) ? b : IS_NAN(b) ? a : a < b ? a : b; }

static bool signs_differ(double a, double b) {
  return (__CPROVER_signd(a) != 0) != (__CPROVER_signd(b) != 0);
}

// |r| >= |a| |b| where the other is 1 or more, and so on: rounding keeps the order.
static bool is_product(double r, double a, double b) {
  if (IS_NAN(a) || IS_NAN(b)) return IS_NAN(r);
  if ((IS_INFINITE(a) && b == 0) || (IS_INFINITE(b) && a == 0)) return IS_NAN(r);
  double p = FABS(a), q = FABS(b), s = FABS(r);
  return !IS_NAN(r) && (__CPROVER_signd(r) != 0) == signs_differ(a, b) &&
         (!(IS_INFINITE(a) || IS_INFINITE(b)) || IS_INFINITE(r)) &&
         (!(a == 0 || b == 0) || r == 0) && (p <= 1 ? s <= q : s >= q) &&
         (q <= 1 ? s <= p : s >= p) && (p != 1 || s == q) && (q != 1 || s == p) &&
         (q != 2 || s == p + p) && (!(p <= 1e150 && q <= 1e150) || s <= 1e300) &&
         (!(p >= 1e-150 && q >= 1e-150) || s > 0);
}

static bool is_quotient(double r, double a, double b) {
  if (IS_NAN(a) || IS_NAN(b) || (IS_INFINITE(a) && IS_INFINITE(b)) || (a == 0 && b == 0))
    return IS_NAN(r);
  double p = FABS(a), q = FABS(b), s = FABS(r);
  return !IS_NAN(r) && (__CPROVER_signd(r) != 0) == signs_differ(a, b) &&
         (!(IS_INFINITE(a) || b == 0) || IS_INFINITE(r)) &&
         (!(a == 0 || IS_INFINITE(b)) || r == 0) && (p <= q ? s <= 1 : s >= 1) &&
         (q >= 1 ? s <= p : s >= p) && (q != 1 || s == p);
}

static bool is_root(double r, double a) {
  if (IS_NAN(a) || a < 0) return IS_NAN(r);
  if (a == 0 || IS_INFINITE(a)) return r == a;
  return IS_FINITE(r) && r > 0 && (a <= 1 ? r >= a && r <= 1 : r <= a && r >= 1);
}

static double MUL(double a, double b) {
  double r = nondet_double();
  ASSUME(is_product(r, a, b));
  return r;
}
static double SQUARE(double a) {
#ifdef TACT_SQUARES
  double r = __CPROVER_uninterpreted_square(a);
#else
  double r = nondet_double();
#endif
  ASSUME(is_product(r, a, a));
  return r;
}
static double DIV(double a, double b) {
  double r = nondet_double();
  ASSUME(is_quotient(r, a, b));
  return r;
}
static double SQRT(double a) {
  double r = __CPROVER_uninterpreted_root(a);
  ASSUME(is_root(r, a));
#ifdef TACT_PEAK
  ASSUME(!(a <= SQUARE(TACT_PEAK)) || r <= TACT_PEAK);
#endif
  return r;
}
