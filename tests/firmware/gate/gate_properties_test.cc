// SPDX-License-Identifier: Apache-2.0
// What gate.h promises, over random sequences (gate_input_strategies.h), for every setting of
// gate_settings.h. Seeds are fixed; extent.h says how many.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/firmware/gate/gate_input_strategies.h"
#include "tests/support/extent.h"
#include "tests/support/no_alloc.h"

namespace tact::tests::gate_properties_test {

/// Many short sequences of one temper on one gate; the rule that broke, with its seed and tick.
std::string run(InputStrategy strategy, const GateSetting& setting, GateRules& rules,
                std::uint64_t sequences, int ticks) {
  for (std::uint64_t seed = 0; seed < sequences; ++seed) {
    Sequence sequence(seed, strategy, setting);
    for (int tick = 0; tick < ticks; ++tick)
      if (const char* broken = rules.check(sequence.next(rules.limited().wrench)))
        return std::string(broken) + ": " + setting.name + ", strategy " +
               std::to_string(static_cast<int>(strategy)) + ", seed " + std::to_string(seed) +
               ", tick " + std::to_string(tick);
  }
  return {};
}

/// The same for every temper on a gate of its own, in every setting.
void run_all(std::uint64_t ordinary, std::uint64_t others, int ticks) {
  for (const GateSetting& setting : kGateSettings) {
    const std::uint64_t sequences = &setting == &kGateSettings.front() ? ordinary : others;
    for (int strategy = 0; strategy < kInputStrategies; ++strategy) {
      GateRules rules(setting);
      EXPECT_EQ(run(static_cast<InputStrategy>(strategy), setting, rules, sequences, ticks), "");
    }
  }
}

std::uint64_t count(const GateRules& rules, firmware::gate::Stage stage) {
  return rules.gate().counters()[static_cast<std::size_t>(stage)];
}

TEST(GateProperties, EveryRuleHoldsForEverySequence) {
  run_all(share_of(400, 40'000), share_of(150, 15'000), 1000);
}

// What the one before left behind is where the next one starts: each begins with a jump.
TEST(GateProperties, EveryRuleHoldsForMoreThanAMillionShortSequences) {
  run_all(share_of(150'000, 150'000), share_of(12'000, 12'000), 8);
}

TEST(GateProperties, RetreatingHandGetsMostOfTheEnergyBudgetAndNotMore) {
  GateRules rules;
  EXPECT_EQ(run(InputStrategy::kFollow, {}, rules, 50, 2000), "");
  EXPECT_GT(rules.max_given_energy_J(), 0.5 * kRulesLimits.energy_J);
  EXPECT_GT(count(rules, firmware::gate::Stage::kPassivity), 1000u);
}

TEST(GateProperties, EnergyBoundHoldsWhenHandReverses) {
  GateRules rules;
  EXPECT_EQ(run(InputStrategy::kRattle, {}, rules, 50, 2000), "");
  EXPECT_GT(rules.max_given_energy_J(), 0.5 * kRulesLimits.energy_J);
}

TEST(GateProperties, EndlessPushEndsAtTheContinuousForce) {
  GateRules rules;
  RuleTick push;
  push.gate.wanted.force_N = {50, 0, 0};
  push.gate.fresh = push.gate.armed = true;
  for (int i = 0; i < 10000; ++i) ASSERT_EQ(rules.check(push), nullptr);
  EXPECT_GT(rules.most_thermal_ratio(), 0.999);
  EXPECT_NEAR(rules.limited().wrench.force_N.x, kRulesLimits.continuous_force_N, 0.01);
  EXPECT_EQ(rules.limited().acting, model::Fault::kContinuousLimited);
}

TEST(GateProperties, EndlessTwistEndsAtTheContinuousTorque) {
  GateRules rules;
  RuleTick twist;
  twist.gate.wanted.torque_Nm = {0, 1, 0};
  twist.gate.fresh = twist.gate.armed = true;
  for (int i = 0; i < 10000; ++i) ASSERT_EQ(rules.check(twist), nullptr);
  EXPECT_GT(rules.most_torque_thermal_ratio(), 0.999);
  EXPECT_NEAR(rules.limited().wrench.torque_Nm.y, 0.1, 0.001) << "half of its peak, as the force";
  EXPECT_EQ(rules.limited().acting, model::Fault::kContinuousLimited);
}

// A hand of 150 g leans with 1 N on a wall, on a device of 1 Ns/m at 1 kHz: stable to 2000 N/m.
struct Wall {
  double given_energy_J = 0.0, swing_m = 0.0;  // at most; in the last second
  bool is_latched = false;
};

Wall lean_on_wall(double stiffness_N_per_m, double budget_J) {
  model::Limits limits = kRulesLimits;
  limits.energy_J = budget_J;
  limits.continuous_force_N = limits.force_N;
  limits.power_W = 100.0;
  limits.speed_mps = 10.0 * kRulesLimits.speed_mps;  // only the energy is in question
  limits.slew_N_per_s = 1e4;
  firmware::gate::Gate gate(limits, 0.001, 1.0);
  constexpr double kMass_kg = 0.15, kDamping_Ns_per_m = 1.0, kPush_N = 1.0, kStep_s = 0.25e-3;
  double x_m = 0.001, v_mps = 0.0, low_m = 1.0, high_m = -1.0, given_energy_J = 0.0;
  Wall out;
  for (int tick = 0; tick < 40000; ++tick) {
    firmware::gate::GateInput input;
    input.wanted.force_N.x = x_m < 0.0 ? -stiffness_N_per_m * x_m : 0.0;
    input.tool.position_m.x = x_m;
    input.tool.velocity_mps.x = v_mps;
    input.fresh = input.armed = true;
    const firmware::gate::LimitedForce limited = gate.limit(input);
    out.is_latched = out.is_latched || latches(limited.fault);
    const double from_m = x_m;
    for (int i = 0; i < 4; ++i) {
      v_mps +=
          kStep_s / kMass_kg * (limited.wrench.force_N.x - kPush_N - kDamping_Ns_per_m * v_mps);
      x_m += kStep_s * v_mps;
    }
    // Summed here, beyond the recovery: a tank that books wrongly would hide what it gives.
    given_energy_J += limited.wrench.force_N.x * (x_m - from_m) - 1e-3 * limits.recovery_W;
    out.given_energy_J = std::max(out.given_energy_J, given_energy_J);
    if (tick < 39000) continue;
    low_m = std::min(low_m, x_m);
    high_m = std::max(high_m, x_m);
  }
  out.swing_m = high_m - low_m;
  return out;
}

TEST(GateProperties, AWallTooStiffShakesOnlyWithoutThePassivityStage) {
  for (const double stiffness_N_per_m : {3000.0, 6000.0, 20000.0}) {
    const Wall without = lean_on_wall(stiffness_N_per_m, 1e9);
    EXPECT_GT(without.swing_m, 5e-4) << stiffness_N_per_m;
    if (stiffness_N_per_m == 20000.0)
      EXPECT_NEAR(without.swing_m, 4e-3, 0.5e-3) << "as the README of the gate says";
    EXPECT_GT(without.given_energy_J, 0.08) << stiffness_N_per_m;
    // Shaking is chaotic: the last bit of the stiffness decides whether it dies down for good.
    constexpr int kStarts = 40;
    int still = 0, early = 0;
    for (int i = 0; i < kStarts; ++i) {
      const Wall with = lean_on_wall(stiffness_N_per_m * (1.0 + 1e-12 * i), 0.08);
      EXPECT_LT(with.swing_m, 0.25 * without.swing_m) << stiffness_N_per_m;
      EXPECT_LT(with.given_energy_J, 0.08) << stiffness_N_per_m;
      EXPECT_FALSE(with.is_latched);
      still += with.swing_m < (stiffness_N_per_m > 5000.0 ? 1e-4 : 2e-4);
      early += with.given_energy_J < 0.042;
    }
    EXPECT_GE(still, 36) << stiffness_N_per_m;
    EXPECT_GE(early, 36) << "the damping begins at half of the budget";
  }
  const Wall soft = lean_on_wall(1000.0, 0.08);
  EXPECT_LT(soft.swing_m, 1e-5) << "within the device's stiffness there is nothing to damp";
  EXPECT_LT(soft.given_energy_J, 0.02);
}

TEST(GateProperties, EveryStageActsInEveryConfiguration) {
  for (const GateSetting& setting : kGateSettings) {
    const model::Limits& limits = setting.limits;
    if (!(limits.force_N > 0.0)) continue;
    GateRules rules(setting);
    for (int strategy = 0; strategy < kInputStrategies; ++strategy)
      EXPECT_EQ(run(static_cast<InputStrategy>(strategy), setting, rules, 20, 1000), "");
    const bool any_step = limits.slew_N_per_s * setting.period_s() > 2.0 * limits.force_N;
    for (std::size_t i = 0; i < firmware::gate::kStageCount; ++i) {
      if (any_step && static_cast<firmware::gate::Stage>(i) == firmware::gate::Stage::kSlew)
        continue;
      const std::uint64_t least = &setting == &kGateSettings.front() ? 100 : 20;
      EXPECT_GT(rules.gate().counters()[i], least)
          << firmware::gate::kStageName[i] << ", " << setting.name;
    }
  }
}

TEST(GateProperties, TheWholeBudgetAndTheContinuousForceAreThereInEverySetting) {
  for (const GateSetting& setting : kGateSettings) {
    if (!(setting.limits.force_N > 0.0)) continue;
    GateRules flee(setting), push(setting);
    const int ticks = setting.rate_Hz > 1000.0 ? 5000 : 2000;  // 25 s and more of heat
    EXPECT_EQ(run(InputStrategy::kFollow, setting, flee, 50, ticks), "");
    EXPECT_EQ(run(InputStrategy::kPush, setting, push, 50, ticks), "");
    EXPECT_GT(flee.max_given_energy_J(), 0.99 * setting.limits.energy_J) << setting.name;
    EXPECT_GT(push.most_thermal_ratio(), 0.99) << setting.name;
    EXPECT_GT(push.most_torque_thermal_ratio(), setting.limits.torque_Nm > 0.0 ? 0.99 : -1.0)
        << setting.name;
  }
}

/// What a scene says for a setting, with the limit at its edge made so much smaller.
std::vector<std::string> scene_text(const GateSetting& setting, double edge_ratio) {
  const model::Limits& l = setting.limits;
  std::vector<std::string> words{fmt::format("rate_Hz={}", setting.rate_Hz)};
  const auto say = [&](const std::string& key, double value) {
    const bool is_edge = setting.edge != nullptr && key == setting.edge;
    words.push_back(fmt::format("limits.{}={}", key, is_edge ? edge_ratio * value : value));
  };
  say("force_N", l.force_N);
  say("torque_Nm", l.torque_Nm);
  say("slew_N_per_s", l.slew_N_per_s);
  say("ramp_s", l.ramp_s);
  say("workspace_radius_m", l.workspace_radius_m);
  say("workspace_half_length_m", l.workspace_half_length_m);
  say("speed_mps", l.speed_mps);
  say("turn_radps", l.turn_radps);
  say("energy_J", l.energy_J);
  say("recovery_W", l.recovery_W);
  say("continuous_force_N", l.continuous_force_N);
  say("thermal_time_s", l.thermal_time_s);
  say("power_W", l.power_W);
  return words;
}

TEST(GateProperties, ASceneMaySayEachSettingAndNothingBeyondItsEdge) {
  const std::string liver = TACT_SOURCE_DIR "/model/scenes/liver.toml";
  for (const GateSetting& setting : kGateSettings) {
    const auto scene = model::scene::load_scene(liver, scene_text(setting, 1.0));
    ASSERT_TRUE(scene) << setting.name << ": " << scene.error().message;
    EXPECT_EQ(scene->limits.thermal_time_s, setting.limits.thermal_time_s) << setting.name;
    if (setting.edge == nullptr) continue;
    const auto beyond = model::scene::load_scene(liver, scene_text(setting, 0.9999));
    ASSERT_FALSE(beyond) << setting.name;
    EXPECT_NE(beyond.error().message.find(setting.edge), std::string::npos)
        << beyond.error().message;
  }
}

TEST(GateProperties, JudgingLeavesTheHeapAlone) {
  GateRules rules;
  Sequence sequence(1, InputStrategy::kAny);
  const NoAlloc guard;
  for (int i = 0; i < 10000; ++i) rules.check(sequence.next({}));
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::tests::gate_properties_test
