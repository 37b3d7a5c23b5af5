// SPDX-License-Identifier: Apache-2.0
// limit.c - one tick of the gate, from every state within its invariant, with every input. The
// words of each property begin with its stage. MADE is what run makes of Gate::limit.
#include "tests/proof/contracts.h"
// The translation calls the contracts.
#include MADE
#include LAYOUT

#define IS_VECTOR_3(v) IS_VECTOR(v##_x, v##_y, v##_z)
#define IS_ZERO(v) (v##_x == 0 && v##_y == 0 && v##_z == 0)
#define NORM_3(v) NORM(v##_x, v##_y, v##_z)
#define IS_WITHIN(v, most) \
  (FABS(v##_x) <= FABS(most##_x) && FABS(v##_y) <= FABS(most##_y) && FABS(v##_z) <= FABS(most##_z))
#define IS_BETWEEN(low, x, high) ((x) >= (low) && (x) <= (high))
#define KEEP(v) double v##_0_x = v##_x, v##_0_y = v##_y, v##_0_z = v##_z
#define ACTED(stage) (COUNT_##stage - count_##stage)

static double peak_of(int thermal) { return thermal == THERMAL_FORCE ? FORCE_LIMIT : TORQUE_LIMIT; }

// Taken for granted of the constructor: what the ranges of a scene leave.
static bool settings(void) {
  return IS_BETWEEN(0, FORCE_LIMIT, 1e3) && IS_BETWEEN(0, TORQUE_LIMIT, 1e3) &&
         IS_BETWEEN(0, FORCE_STEP, 1e9) && IS_BETWEEN(0, TORQUE_STEP, 1e9) &&
         IS_BETWEEN(0, LEVER, 1e9) && POWER_LIMIT >= 0 && IS_BETWEEN(1e-6, PERIOD, 1) &&
         IS_BETWEEN(1e-3, WORKSPACE_FADE, 1) && IS_BETWEEN(1e-3, SPEED_FADE, 1) &&
         HALF_LENGTH <= 1e3 && RADIUS <= 1e3 && SPEED <= 1e3 && TURN_SPEED <= 1e3;
}

static bool invariant(void) {
  return IS_BETWEEN(0, FRESH_LEVEL, 1) && IS_BETWEEN(0, WORKSPACE_LEVEL, 1) &&
         IS_BETWEEN(0, SPEED_LEVEL, 1) && IS_BETWEEN(0, RAMP_LEVEL, 1) && (int64_t)MISSED >= 0 &&
         (int64_t)MISSED < 20 && IS_VECTOR_3(BEFORE_FORCE) && IS_VECTOR_3(BEFORE_TORQUE) &&
         IS_WITHIN(WRITTEN_FORCE, BEFORE_FORCE) && IS_WITHIN(WRITTEN_TORQUE, BEFORE_TORQUE) &&
         NORM_3(BEFORE_FORCE) <= FORCE_LIMIT && NORM_3(BEFORE_TORQUE) <= TORQUE_LIMIT;
}

static bool is_too_fast(void) {
  return !(NORM_3(VELOCITY) <= SPEED) || !(NORM_3(TURN) <= TURN_SPEED);
}

int main(void) {
  forget();
  ASSUME(NORM(0, 0, 0) == 0);
  ASSUME(IS_ARMED <= 1 && IS_FRESH <= 1);
  ASSUME(settings() && invariant());
  bool is_wanted_finite = IS_VECTOR_3(WANTED_FORCE) && IS_VECTOR_3(WANTED_TORQUE);
  bool is_tool_finite = IS_VECTOR_3(POSITION) && IS_VECTOR_3(VELOCITY) && IS_VECTOR_3(TURN) &&
                        IS_VECTOR_3(ORIENTATION) && IS_FINITE(ORIENTATION_W) && IS_FINITE(GRIP);
  int64_t missed = MISSED;
  double workspace = WORKSPACE_LEVEL, speed = SPEED_LEVEL;
  KEEP(BEFORE_FORCE);
  KEEP(BEFORE_TORQUE);
  uint64_t count_finite = COUNT_finite, count_fresh = COUNT_fresh, count_armed = COUNT_armed,
           count_workspace = COUNT_workspace, count_passivity = COUNT_passivity,
           count_magnitude = COUNT_magnitude, count_slew = COUNT_slew, count_power = COUNT_power,
           count_ramp = COUNT_ramp;
  limit();
  bool is_zero = IS_ZERO(FORCE) && IS_ZERO(TORQUE);
  bool latched = FAULT >= 100;
  bool let_through = IS_ARMED && ACTED(armed) == 0;
  CHECK(IS_VECTOR_3(FORCE) && IS_VECTOR_3(TORQUE), "finite: the written force is finite");
  CHECK((is_wanted_finite && is_tool_finite) || (latched && is_zero),
        "finite: what is not finite latches and gives zero");
  CHECK(ACTED(finite) == (!is_wanted_finite) + (!is_tool_finite), "finite: the counter is right");
  CHECK(!latched || is_zero, "finite: zero in the tick of a fault");
  CHECK(!IS_ARMED || IS_FRESH || MISSED == missed + 1 + SKIPPED || latched,
        "fresh: each missed period is counted");
  CHECK(!IS_ARMED || IS_FRESH || missed + 1 + SKIPPED < 20 || (latched && is_zero),
        "fresh: the 20th missed sample latches");
  CHECK(IS_FRESH || !IS_ARMED || ACTED(fresh) == 1, "fresh: a missed sample is reported");
  CHECK(ACTED(fresh) == (MISSED > 0 || FRESH_LEVEL < 1), "fresh: the counter is right");
  CHECK(IS_ARMED || is_zero, "armed: zero unless armed");
  CHECK(ACTED(armed) == (!IS_ARMED || (latched && FAULT != 131)), "armed: the counter is right");
  CHECK(!latched || (RAMP_LEVEL == 0 && IS_ZERO(BEFORE_FORCE) && IS_ZERO(BEFORE_TORQUE) &&
                     IS_ZERO(WRITTEN_FORCE)),
        "armed: after a fault all starts from zero");
  CHECK(!let_through ||
            (FABS(POSITION_x) <= HALF_LENGTH && NORM(0, POSITION_y, POSITION_z) <= RADIUS) ||
            WORKSPACE_LEVEL < workspace || WORKSPACE_LEVEL == 0,
        "workspace: it fades outside");
  CHECK(!let_through || !is_too_fast() || SPEED_LEVEL < speed || SPEED_LEVEL == 0,
        "workspace: it fades when the tool is too fast");
  CHECK(ACTED(workspace) == (let_through ? (WORKSPACE_LEVEL < 1) + (SPEED_LEVEL < 1) : 0),
        "workspace: the counter is right");
  CHECK(!is_tank_overdrawn || !IS_ARMED || (latched && is_zero),
        "passivity: an overdrawn tank latches");
  CHECK(ACTED(passivity) <= (uint64_t)(IS_ARMED != 0), "passivity: the counter is right");
  CHECK(NORM_3(BEFORE_FORCE) <= FORCE_LIMIT && IS_WITHIN(FORCE, BEFORE_FORCE),
        "magnitude: |F| <= force limit");
  CHECK(NORM_3(BEFORE_TORQUE) <= TORQUE_LIMIT && IS_WITHIN(TORQUE, BEFORE_TORQUE),
        "magnitude: |T| <= torque limit");
  CHECK(ACTED(magnitude) <= 2 * (uint64_t)let_through, "magnitude: the counter is right");
  CHECK(latched || !IS_ARMED || SKIPPED != 0 ||
            DISTANCE(BEFORE_FORCE_x, BEFORE_FORCE_y, BEFORE_FORCE_z, BEFORE_FORCE_0_x,
                     BEFORE_FORCE_0_y, BEFORE_FORCE_0_z) <= FORCE_STEP,
        "slew: |dF| before the ramp <= its step");
  CHECK(latched || !IS_ARMED || SKIPPED != 0 ||
            DISTANCE(BEFORE_TORQUE_x, BEFORE_TORQUE_y, BEFORE_TORQUE_z, BEFORE_TORQUE_0_x,
                     BEFORE_TORQUE_0_y, BEFORE_TORQUE_0_z) <= TORQUE_STEP,
        "slew: |dT| before the ramp <= its step");
  CHECK(ACTED(slew) <= (uint64_t)let_through, "slew: the counter is right");
  CHECK(ACTED(power) <= 2 * (uint64_t)let_through && (FAULT != 131 || ACTED(power) > 0),
        "power: the counter is right");
  CHECK(RAMP_LEVEL != 0 || is_zero, "ramp: no force before it opens");
  CHECK(ACTED(ramp) == (let_through && (latched ? ACTED(ramp) : RAMP_LEVEL < 1)),
        "ramp: the counter is right");
  CHECK(latched || invariant(), "ramp: the invariant is kept");
  CHECK(!latched || (IS_BETWEEN(0, FRESH_LEVEL, 1) && NORM_3(BEFORE_FORCE) <= FORCE_LIMIT),
        "armed: the invariant is kept in a fault");
  CHECK((LIMIT == 0 && FAULT == 0) ==
            (COUNT_finite == count_finite && COUNT_fresh == count_fresh &&
             COUNT_armed == count_armed && COUNT_workspace == count_workspace &&
             COUNT_passivity == count_passivity && COUNT_magnitude == count_magnitude &&
             COUNT_slew == count_slew && COUNT_power == count_power && COUNT_ramp == count_ramp),
        "armed: no stage acts untold");
#ifdef TACT_WITNESS
  CHECK(is_zero, "witness: a force can be");
  CHECK(!latched, "witness: a fault can be");
#endif
}
