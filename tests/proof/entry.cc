// SPDX-License-Identifier: Apache-2.0
// entry.cc - the gate as the provers get it: what the compiler makes of this file is translated to
// C. Without TACT_WHOLE the parts that are proved alone stay functions; with it, all is in one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>

#ifndef TACT_WHOLE
namespace tact::model {
struct Vec3;
__attribute__((noinline)) double norm(const Vec3&) noexcept;
}  // namespace tact::model
#endif
#include "model/types.h"

#ifndef TACT_WHOLE
#pragma clang attribute push(__attribute__((noinline)), apply_to = function)
namespace tact::firmware::gate {
bool is_within(const model::Vec3&, double) RT_SAFE;
bool limit_magnitude(model::Vec3&, double) RT_SAFE;
bool approach(model::Vec3&, const model::Vec3&, double, double, double) RT_SAFE;
bool limit_surplus(model::Wrench&, const model::Vec3&, const model::Vec3&, double) RT_SAFE;
}  // namespace tact::firmware::gate
#include "firmware/gate/thermal_limit.h"
#pragma clang attribute pop
#endif

#define private public  // the provers see the members by their places
#ifndef TACT_WHOLE
#include "firmware/gate/limiter.h"
#pragma clang attribute push(__attribute__((noinline)), apply_to = function)
#endif
#include "firmware/gate/energy_tank.cc"
#ifndef TACT_WHOLE
#pragma clang attribute pop
#endif
#include "firmware/gate/gate.cc"
#undef private

using namespace tact::firmware::gate;
using tact::model::Limits;
using tact::model::Tool;
using tact::model::Vec3;

extern "C" {
void limit(Gate* gate, const GateInput* input, LimitedForce* out) { *out = gate->limit(*input); }
void make(Gate* gate, const Limits* limits, double period_s, double share) {
  new (gate) Gate(*limits, period_s, share);
}
#ifdef TACT_WHOLE
bool shorten(Vec3* v, double limit) { return limit_magnitude(*v, limit); }
bool take(Vec3* v, double surplus, const Vec3* d) { return take_along(*v, surplus, *d); }
double thermal_allowed(const ThermalLimit* thermal) { return thermal->allowed(); }
void thermal_add(ThermalLimit* thermal, const Vec3* held, double periods) {
  thermal->add(*held, periods);
}
void observe(EnergyTank* tank, const Tool* tool, bool fresh, double periods,
             const tact::model::Wrench* held) {
  tank->observe(*tool, fresh, periods, *held);
}
double passive(const EnergyTank* tank) { return tank->allowed_N(); }
bool overdrawn(const EnergyTank* tank) { return tank->is_overdrawn(); }
#endif
}
