// What gate.h promises, over random sequences: every sequence has a temper, and each is there to
// break one promise. Seeds are fixed; TACT_LONG=1 runs a hundred times as many long ones.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <random>

#include "tests/gate_rules.h"
#include "tests/no_alloc.h"

namespace tact::tests {
namespace {

constexpr double kStep_m = kRulesLimits.speed_mps * kRulesPeriod_s;
constexpr double kTurn_rad = kRulesLimits.turn_radps * kRulesPeriod_s;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMost = std::numeric_limits<double>::max();
constexpr double kLeast = std::numeric_limits<double>::min();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr std::array kOdd{0.0,
                          -0.0,
                          kDenormal,
                          -kDenormal,
                          kLeast,
                          -kLeast,
                          1e-3,
                          -1e-3,
                          7.9999,
                          8.0,
                          -8.0,
                          1e6,
                          1e300,
                          -1e300,
                          kMost,
                          -kMost,
                          kInfinity,
                          -kInfinity,
                          std::numeric_limits<double>::quiet_NaN()};

/// What a sequence of inputs is after.
enum class Temper {
  kAny,     // anything, odd values included
  kFollow,  // the tool flees with the force, as fast as permitted, samples missing: energy
  kRattle,  // to and fro as fast as permitted, pushed at every return: energy, against the guess
  kPush,    // the largest force, held: heat
  kThrow,   // the tool's velocity jumps: power
  kJump,    // steps longer than permitted, positions again and reversed: overdraws
  kLose,    // samples are missing, one by one or in a row, periods are skipped
};
constexpr int kTempers = 7;

class Sequence {
 public:
  Sequence(std::uint64_t seed, Temper temper)
      : random_(seed), temper_(temper), is_lossy_(seed % 2 == 1) {}

  RuleTick next(const model::Wrench& written) {
    ++tick_;
    if (chance(0.002)) armed_ = !armed_;
    if (chance(0.01)) wanted_ = {ball(chance(0.5) ? 100.0 : 6.0), ball(chance(0.5) ? 1.0 : 0.1)};
    move(written);
    RuleTick out{.gate = {.wanted = wanted_, .tool = {}, .fresh = true, .armed = armed_},
                 .angle_rad = angle_rad_};
    out.gate.tool.position_m = position_m_;
    out.gate.tool.velocity_mps = velocity_mps_;
    out.gate.tool.angular_velocity_radps = turning_radps_;
    if (temper_ == Temper::kFollow && is_lossy_) out.gate.fresh = !chance(0.5);
    if (temper_ == Temper::kLose || temper_ == Temper::kAny) {
      out.gate.fresh = !chance(0.3);
      if (chance(0.02)) out.gate.skipped_periods = static_cast<std::uint32_t>(random_() % 40);
    }
    if (temper_ == Temper::kLose && is_lossy_) fall_silent(out.gate);
    if (temper_ == Temper::kAny && chance(0.05)) spoil(out);
    return out;
  }

 private:
  bool chance(double p) { return unit_(random_) < p; }
  double within(double most) { return most * (2.0 * unit_(random_) - 1.0); }
  Vec3 ball(double most) { return {within(most), within(most), within(most)}; }

  void move(const model::Wrench& written) {
    Vec3 step_m = ball(0.5 * kStep_m);
    double turn_rad = within(kTurn_rad);
    if (temper_ == Temper::kFollow) {
      step_m = kStep_m * 0.999999 * normalized(written.force_N);
      turn_rad = written.torque_Nm.x > 0.0 ? 0.999999 * kTurn_rad : -0.999999 * kTurn_rad;
    } else if (temper_ == Temper::kRattle) {
      const double sign = tick_ / 2 % 2 == 0 ? 1.0 : -1.0;
      step_m = {sign * kStep_m * 0.999999, 0, 0};
      wanted_.force_N = {tick_ % 2 == 0 ? 50.0 * sign : -50.0 * sign, within(1.0), 0};
    } else if (temper_ == Temper::kPush) {
      step_m = {};
      wanted_ = {{50, 0, 0}, {0, 1, 0}};
    } else if (temper_ == Temper::kJump && chance(0.05)) {
      step_m = chance(0.5) ? ball(0.1) : -1.0 * (position_m_ + past_m_);
    }
    past_m_ = position_m_;
    position_m_ += step_m;
    if (!(norm(position_m_) < 0.1) && temper_ != Temper::kFollow) position_m_ = {};
    angle_rad_ += turn_rad;
    velocity_mps_ = (position_m_ - past_m_) / kRulesPeriod_s;
    turning_radps_ = {turn_rad / kRulesPeriod_s, 0, 0};
    if (temper_ == Temper::kThrow && chance(0.1)) velocity_mps_ = ball(chance(0.5) ? 1.0 : 3.0);
    if (temper_ == Temper::kFollow || temper_ == Temper::kRattle) {  // not what this is about
      velocity_mps_ = turning_radps_ = {};
      if (!(norm(position_m_) < 0.14)) armed_ = false, position_m_ = past_m_ = {};
    }
  }

  // No sample for up to 15 ticks, and every tick takes up to four periods.
  void fall_silent(GateInput& out) {
    if (silent_ticks_ == 0 && chance(0.01)) silent_ticks_ = 1 + static_cast<int>(random_() % 15);
    if (silent_ticks_ == 0) return;
    --silent_ticks_;
    out.fresh = false;
    out.skipped_periods = static_cast<std::uint32_t>(random_() % 4);
  }

  void spoil(RuleTick& out) {
    const std::array fields{&out.gate.wanted.force_N, &out.gate.wanted.torque_Nm,
                            &out.gate.tool.position_m, &out.gate.tool.velocity_mps,
                            &out.gate.tool.angular_velocity_radps};
    Vec3& field = *fields[random_() % fields.size()];
    const std::array numbers{&field.x, &field.y, &field.z, &out.angle_rad};
    *numbers[random_() % numbers.size()] = kOdd[random_() % kOdd.size()];
  }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  Temper temper_;
  bool is_lossy_;
  int tick_ = 0, silent_ticks_ = 0;
  bool armed_ = true;
  model::Wrench wanted_;
  Vec3 position_m_, past_m_, velocity_mps_, turning_radps_;
  double angle_rad_ = 0.0;
};

std::uint64_t times() { return std::getenv("TACT_LONG") != nullptr ? 100 : 1; }

/// Many short sequences of one temper on one gate; the rule that broke, with its seed and tick.
std::string run(Temper temper, GateRules& rules, std::uint64_t sequences, int ticks) {
  for (std::uint64_t seed = 0; seed < sequences; ++seed) {
    Sequence sequence(seed, temper);
    for (int tick = 0; tick < ticks; ++tick)
      if (const char* broken = rules.judge(sequence.next(rules.verdict().wrench)))
        return std::string(broken) + ": seed " + std::to_string(seed) + ", tick " +
               std::to_string(tick);
  }
  return {};
}

std::uint64_t count(const GateRules& rules, firmware::Stage stage) {
  return rules.gate().counters()[static_cast<std::size_t>(stage)];
}

TEST(GateProperties, EveryRuleHoldsForEverySequence) {
  for (int temper = 0; temper < kTempers; ++temper) {
    GateRules rules;
    EXPECT_EQ(run(static_cast<Temper>(temper), rules, 400 * times(), 1000), "")
        << "temper " << temper;
  }
}

// What the one before left behind is where the next one starts: each begins with a jump.
TEST(GateProperties, EveryRuleHoldsForMoreThanAMillionShortSequences) {
  for (int temper = 0; temper < kTempers; ++temper) {
    GateRules rules;
    EXPECT_EQ(run(static_cast<Temper>(temper), rules, 150'000, 8), "") << "temper " << temper;
  }
}

TEST(GateProperties, WhoFleesWithTheForceGetsNoMoreThanTheBudgetAndMostOfIt) {
  GateRules rules;
  EXPECT_EQ(run(Temper::kFollow, rules, 50 * times(), 2000), "");
  EXPECT_GT(rules.most_given_J(), 0.5 * kRulesLimits.energy_J);
  EXPECT_GT(count(rules, firmware::Stage::kPassivity), 1000u);
}

TEST(GateProperties, WhoDefeatsTheGuessStillMeetsTheBrake) {
  GateRules rules;
  EXPECT_EQ(run(Temper::kRattle, rules, 50 * times(), 2000), "");
  EXPECT_GT(rules.most_given_J(), 0.5 * kRulesLimits.energy_J);
}

TEST(GateProperties, WhoPushesForEverComesToTheContinuousForceFromBelow) {
  GateRules rules;
  RuleTick push;
  push.gate.wanted.force_N = {50, 0, 0};
  push.gate.fresh = push.gate.armed = true;
  for (int i = 0; i < 10000; ++i) ASSERT_EQ(rules.judge(push), nullptr);
  EXPECT_GT(rules.most_heat_ratio(), 0.999);
  EXPECT_NEAR(rules.verdict().wrench.force_N.x, kRulesLimits.continuous_force_N, 0.01);
  EXPECT_EQ(rules.verdict().limit, model::Fault::kContinuousLimited);
}

TEST(GateProperties, WhoTwistsForEverComesToTheContinuousTorqueFromBelow) {
  GateRules rules;
  RuleTick twist;
  twist.gate.wanted.torque_Nm = {0, 1, 0};
  twist.gate.fresh = twist.gate.armed = true;
  for (int i = 0; i < 10000; ++i) ASSERT_EQ(rules.judge(twist), nullptr);
  EXPECT_GT(rules.most_torque_heat_ratio(), 0.999);
  EXPECT_NEAR(rules.verdict().wrench.torque_Nm.y, 0.1, 0.001) << "half of its peak, as the force";
  EXPECT_EQ(rules.verdict().limit, model::Fault::kContinuousLimited);
}

// A hand of 150 g leans with 1 N on a wall, on a device of 1 Ns/m at 1 kHz: stable to 2000 N/m.
struct Wall {
  double given_J = 0.0, swing_m = 0.0;  // at most; in the last second
  bool is_latched = false;
};

Wall lean_on_wall(double stiffness_N_per_m, double budget_J) {
  model::Limits limits = kRulesLimits;
  limits.energy_J = budget_J;
  limits.continuous_force_N = limits.force_N;
  limits.power_W = 100.0;
  limits.speed_mps = 10.0 * kRulesLimits.speed_mps;  // only the energy is in question
  limits.slew_N_per_s = 1e4;
  firmware::Gate gate(limits, kRulesPeriod_s, 1.0);
  constexpr double kMass_kg = 0.15, kDamping_Ns_per_m = 1.0, kPush_N = 1.0, kStep_s = 0.25e-3;
  double x_m = 0.001, v_mps = 0.0, low_m = 1.0, high_m = -1.0;
  Wall out;
  for (int tick = 0; tick < 40000; ++tick) {
    firmware::GateInput input;
    input.wanted.force_N.x = x_m < 0.0 ? -stiffness_N_per_m * x_m : 0.0;
    input.tool.position_m.x = x_m;
    input.tool.velocity_mps.x = v_mps;
    input.fresh = input.armed = true;
    const firmware::GateVerdict verdict = gate.judge(input);
    out.is_latched = out.is_latched || latches(verdict.fault);
    for (int i = 0; i < 4; ++i) {
      v_mps +=
          kStep_s / kMass_kg * (verdict.wrench.force_N.x - kPush_N - kDamping_Ns_per_m * v_mps);
      x_m += kStep_s * v_mps;
    }
    out.given_J = std::max(out.given_J, gate.given_energy_J());
    if (tick < 39000) continue;
    low_m = std::min(low_m, x_m);
    high_m = std::max(high_m, x_m);
  }
  out.swing_m = high_m - low_m;
  return out;
}

TEST(GateProperties, AWallTooStiffForItsDeviceShakesWithoutTheEnergyStageAndNotWithIt) {
  for (const double stiffness_N_per_m : {3000.0, 6000.0, 20000.0}) {
    const Wall without = lean_on_wall(stiffness_N_per_m, 1e9);
    const Wall with = lean_on_wall(stiffness_N_per_m, 0.08);
    EXPECT_GT(without.swing_m, 5e-4) << stiffness_N_per_m;
    EXPECT_LT(with.swing_m, 0.25 * without.swing_m) << stiffness_N_per_m;
    EXPECT_LT(with.swing_m, stiffness_N_per_m > 5000.0 ? 1e-4 : 2e-4) << stiffness_N_per_m;
    if (stiffness_N_per_m == 20000.0) {
      EXPECT_NEAR(without.swing_m, 4e-3, 0.5e-3) << "as firmware/README.md says";
    }
    EXPECT_GT(without.given_J, 0.08) << stiffness_N_per_m;
    EXPECT_LT(with.given_J, 0.042) << "the damping begins at half of the budget";
    EXPECT_FALSE(with.is_latched);
  }
  const Wall soft = lean_on_wall(1000.0, 0.08);
  EXPECT_LT(soft.swing_m, 1e-5) << "within the device's stiffness there is nothing to damp";
  EXPECT_LT(soft.given_J, 0.02);
}

TEST(GateProperties, EveryStageHadItsSay) {
  GateRules rules;
  for (int temper = 0; temper < kTempers; ++temper)
    EXPECT_EQ(run(static_cast<Temper>(temper), rules, 20, 1000), "");
  for (std::size_t i = 0; i < firmware::kStageCount; ++i)
    EXPECT_GT(rules.gate().counters()[i], 100u) << firmware::kStageName[i];
}

TEST(GateProperties, JudgingLeavesTheHeapAlone) {
  GateRules rules;
  Sequence sequence(1, Temper::kAny);
  const NoAlloc guard;
  for (int i = 0; i < 10000; ++i) rules.judge(sequence.next({}));
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace
}  // namespace tact::tests
