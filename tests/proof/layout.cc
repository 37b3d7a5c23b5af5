// SPDX-License-Identifier: Apache-2.0
// layout.cc - prints the name in the translated C of what the properties speak of.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>

#define private public
#include "firmware/gate/gate.h"
#undef private

using tact::firmware::gate::Gate;
using tact::firmware::gate::GateInput;
using tact::firmware::gate::LimitedForce;
namespace gate = tact::firmware::gate;

namespace {

void name(const char* name, const char* object, std::size_t at, const char* kind = "d") {
  std::printf("#define %s %s_%zu_%s\n", name, object, at, kind);
}
void vector(const char* name, const char* object, std::size_t at) {
  for (std::size_t i = 0; i < 3; ++i)
    std::printf("#define %s_%c %s_%zu_d\n", name, "xyz"[i], object, at + 8 * i);
}

void name_state() {
  name("FRESH_LEVEL", "gate", offsetof(Gate, fresh_.level_));
  name("WORKSPACE_LEVEL", "gate", offsetof(Gate, workspace_.level_));
  name("SPEED_LEVEL", "gate", offsetof(Gate, speed_.level_));
  name("RAMP_LEVEL", "gate", offsetof(Gate, ramp_.level_));
  name("FORCE_LIMIT", "gate", offsetof(Gate, force_limit_N_));
  name("TORQUE_LIMIT", "gate", offsetof(Gate, torque_limit_Nm_));
  name("LEVER", "gate", offsetof(Gate, lever_m_));
  name("FORCE_STEP", "gate", offsetof(Gate, force_step_N_));
  name("TORQUE_STEP", "gate", offsetof(Gate, torque_step_Nm_));
  name("POWER_LIMIT", "gate", offsetof(Gate, limits_.power_W));
  name("PERIOD", "gate", offsetof(Gate, period_s_));
  name("WORKSPACE_FADE", "gate", offsetof(Gate, workspace_.ramp_s_));
  name("SPEED_FADE", "gate", offsetof(Gate, speed_.ramp_s_));
  name("RADIUS", "gate", offsetof(Gate, limits_.workspace_radius_m));
  name("SPEED", "gate", offsetof(Gate, limits_.speed_mps));
  name("TURN_SPEED", "gate", offsetof(Gate, limits_.turn_radps));
  name("HALF_LENGTH", "gate", offsetof(Gate, limits_.workspace_half_length_m));
  name("MISSED", "gate", offsetof(Gate, missed_), "q");
  std::printf("#define THERMAL_FORCE %zu\n", offsetof(Gate, thermal_force_));
  vector("BEFORE_FORCE", "gate", offsetof(Gate, before_ramp_.force_N));
  vector("BEFORE_TORQUE", "gate", offsetof(Gate, before_ramp_.torque_Nm));
  vector("WRITTEN_FORCE", "gate", offsetof(Gate, written_.force_N));
  vector("WRITTEN_TORQUE", "gate", offsetof(Gate, written_.torque_Nm));
  for (std::size_t i = 0; i < gate::kStageCount; ++i)
    std::printf("#define COUNT_%s gate_%zu_q\n", gate::kStageName[i],
                offsetof(Gate, counter_) + 8 * i);
}

void name_input() {
  vector("WANTED_FORCE", "input", offsetof(GateInput, wanted.force_N));
  vector("WANTED_TORQUE", "input", offsetof(GateInput, wanted.torque_Nm));
  vector("POSITION", "input", offsetof(GateInput, tool.position_m));
  vector("VELOCITY", "input", offsetof(GateInput, tool.velocity_mps));
  vector("TURN", "input", offsetof(GateInput, tool.angular_velocity_radps));
  name("GRIP", "input", offsetof(GateInput, tool.grip_ratio));
  name("ORIENTATION_W", "input", offsetof(GateInput, tool.orientation.w));
  vector("ORIENTATION", "input", offsetof(GateInput, tool.orientation.x));
  name("IS_FRESH", "input", offsetof(GateInput, fresh), "b");
  name("IS_ARMED", "input", offsetof(GateInput, armed), "b");
  name("SKIPPED", "input", offsetof(GateInput, skipped_periods), "i");
}

void name_output() {
  vector("FORCE", "out", offsetof(LimitedForce, wrench.force_N));
  vector("TORQUE", "out", offsetof(LimitedForce, wrench.torque_Nm));
  name("LIMIT", "out", offsetof(LimitedForce, acting), "s");
  name("FAULT", "out", offsetof(LimitedForce, fault), "s");
}

void name_parts() {
  name("PEAK", "thermal", offsetof(gate::ThermalLimit, peak_));
  name("CONTINUOUS_SQUARED", "thermal", offsetof(gate::ThermalLimit, continuous_squared_));
  name("STEEPNESS", "thermal", offsetof(gate::ThermalLimit, steepness_));
  name("SHARE", "thermal", offsetof(gate::ThermalLimit, share_));
  name("MEAN_SQUARE", "thermal", offsetof(gate::ThermalLimit, mean_square_));
  name("ENERGY", "tank", offsetof(gate::EnergyTank, level_J_));
  name("BUDGET", "tank", offsetof(gate::EnergyTank, settings_.budget_J));
  name("UNSEEN", "tank", offsetof(gate::EnergyTank, unseen_J_));
  name("PERIODS", "tank", offsetof(gate::EnergyTank, periods_));
  name("IS_PLACED", "tank", offsetof(gate::EnergyTank, is_placed_), "b");
}

}  // namespace

int main() {
  name_state();
  name_input();
  name_output();
  name_parts();
}
