// SPDX-License-Identifier: Apache-2.0
// For any force, sample and command the gate keeps every rule of gate.h
// in every setting of gate_settings.h.
//
// A tick takes a byte that says what changes: 1 the armed level turns, 2 no fresh sample, 4 periods
// are skipped, 8 the tool flees with the force as fast as it may; the upper four bits choose a
// number that the next eight bytes replace.
#include <array>
#include <cstring>

#include "tests/fuzz/fuzz.h"
#include "tests/support/gate_rules.h"

namespace {

using namespace tact;
using fuzz::require;

constexpr int kMaxTicks = 4096;

class Story {
 public:
  explicit Story(const tests::GateSetting& setting)
      : step_m_(0.999 * setting.limits.speed_mps * setting.period_s()),
        turn_rad_(0.999 * setting.limits.turn_radps * setting.period_s()) {}

  tests::RuleTick next(fuzz::Bytes& input, const model::Wrench& written) {
    const std::uint8_t what = fuzz::take(input, 1)[0];
    firmware::gate::GateInput& gate = tick_.gate;
    if ((what & 1) != 0) gate.armed = !gate.armed;
    gate.fresh = (what & 2) == 0;
    gate.skipped_periods = (what & 4) != 0 ? what >> 4 : 0;
    if ((what & 8) != 0) flee(written);
    if (what >> 4 != 0) replace(what >> 4, fuzz::take(input, sizeof(double)));
    return tick_;
  }

 private:
  void flee(const model::Wrench& written) {
    tick_.gate.tool.position_m += step_m_ * normalized(written.force_N);
    tick_.angle_rad += written.torque_Nm.x > 0.0 ? turn_rad_ : -turn_rad_;
  }

  void replace(int which, fuzz::Bytes bytes) {
    model::Tool& tool = tick_.gate.tool;
    model::Wrench& wanted = tick_.gate.wanted;
    const std::array<double*, 16> number{nullptr,
                                         &wanted.force_N.x,
                                         &wanted.force_N.y,
                                         &wanted.force_N.z,
                                         &wanted.torque_Nm.x,
                                         &wanted.torque_Nm.y,
                                         &tool.position_m.x,
                                         &tool.position_m.y,
                                         &tool.position_m.z,
                                         &tool.velocity_mps.x,
                                         &tool.velocity_mps.y,
                                         &tool.velocity_mps.z,
                                         &tick_.angle_rad,
                                         &tool.angular_velocity_radps.x,
                                         &tool.angular_velocity_radps.z,
                                         &tool.grip_ratio};
    double value = 0.0;
    std::memcpy(&value, bytes.data(), bytes.size());
    *number[static_cast<std::size_t>(which)] = value;
  }

  double step_m_, turn_rad_;  // of a flight
  tests::RuleTick tick_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const tests::GateSetting& setting : tests::kGateSettings) {
    fuzz::Bytes input(data, size);
    tests::GateRules rules(setting);
    Story story(setting);
    for (int tick = 0; tick < kMaxTicks && !input.empty(); ++tick)
      require(rules.check(story.next(input, rules.limited().wrench)) == nullptr);
  }
  return 0;
}
