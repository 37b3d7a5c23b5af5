// Relaxation: the exact fade, passivity for any law, and no pull from tissue that is not held.
#include "model/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "model/elastic_field.h"
#include "tests/no_alloc.h"

namespace tact::model {
namespace {

constexpr double kTick_s = 1e-3;

// The illustrative set of tissue: F(t) / F(0) = 0.5 + 0.3 exp(-t / 0.5 s) + 0.2 exp(-t / 8 s).
Relaxation two_terms() {
  const std::vector<PronyTerm> terms{{.share = 0.3, .time_s = 0.5}, {.share = 0.2, .time_s = 8.0}};
  return *make_relaxation(terms, kTick_s);
}

// F = c |d|^p sign(d): p = 1 a spring, above it a law that hardens.
class PowerLaw final : public Law {
 public:
  explicit PowerLaw(double power) : power_(power) {}
  LawResponse respond(double d) const RT_SAFE override {
    const double size = std::abs(d);
    const double force_N = 100.0 * std::pow(size, power_);
    return {.force_N = std::copysign(force_N, d), .energy_J = force_N * size / (power_ + 1.0)};
  }
  LawRange range() const RT_SAFE override { return {-0.02, 0.02}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  double power_;
};

struct Felt {
  explicit Felt(double power, bool is_held = false) : law(power), held(is_held) {}
  double force_N(double depth_m) {
    response = field.respond({.depth_m = depth_m, .held = held}).law;
    field.advance();
    return response.force_N;
  }
  PowerLaw law;
  const Law* curve = &law;
  ElasticField field{{.curves = {&curve, 1},
                      .coordinate = {},
                      .pull_coordinate = {},
                      .surface = {},
                      .relaxation = two_terms()}};
  LawResponse response;
  bool held;
};

TEST(Relaxation, FadesAtHeldDepthExactlyAsItsTermsSay) {
  Felt felt(1.0);
  const double first_N = felt.force_N(5e-3);
  double t_s = 0.0;
  for (int i = 1; i <= 20'000; ++i) {
    const double now_N = felt.force_N(5e-3);
    t_s += kTick_s;
    // The first tick is a ramp of one tick, not a step: the terms fade by half a tick meanwhile.
    const double g = 0.5 + 0.3 * std::exp(-t_s / 0.5) + 0.2 * std::exp(-t_s / 8.0);
    ASSERT_NEAR(now_N / first_N, g, 4e-4) << "after " << t_s << " s";
  }
}

TEST(Relaxation, IsExactInTheTickForADepthThatMovesEvenly) {
  // e' = v - e / tau from rest: e = v tau (1 - exp(-t / tau)), whatever the tick.
  const std::vector<PronyTerm> terms{{.share = 1.0, .time_s = 0.1}};
  for (const double tick_s : {1e-3, 1e-2, 0.5}) {
    const Relaxation relaxation = *make_relaxation(terms, tick_s);
    RelaxationState state;
    for (int i = 1; i <= 4; ++i) {
      const double t_s = i * tick_s;
      state = relaxation.after(state, 0.02 * t_s, true);
      EXPECT_NEAR(state.stretch_m[0], 0.02 * 0.1 * (1.0 - std::exp(-t_s / 0.1)), 1e-12);
    }
  }
}

// Work of the hand along a random path, by the trapezoid rule over fine ticks.
void expect_passive(double power, bool held, unsigned seed) {
  Felt felt(power, held);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> target_m(held ? -0.01 : 0.0, 0.01);
  std::uniform_int_distribution<int> length(5, 2000);
  double depth_m = 0.0, force_N = 0.0, work_J = 0.0, most_J = 0.0;
  for (int leg = 0; leg < 60; ++leg) {
    const double to_m = leg == 59 ? 0.0 : target_m(random);
    const int ticks = length(random);
    const double step_m = (to_m - depth_m) / ticks;
    for (int i = 0; i < ticks; ++i) {
      const double now_N = felt.force_N(depth_m + step_m);
      work_J += 0.5 * (force_N + now_N) * step_m;
      depth_m += step_m;
      force_N = now_N;
      most_J = std::max(most_J, work_J);
      ASSERT_GE(work_J, felt.response.energy_J - 1e-4 * most_J) << "more stored than put in";
    }
  }
  EXPECT_GT(work_J, 0.0) << "relaxation costs energy";
}

TEST(Relaxation, NeverReturnsMoreThanItGotWhateverTheLawAndThePath) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const double power : {1.0, 1.5, 3.0}) {
      expect_passive(power, false, seed);
      expect_passive(power, true, seed);
    }
  }
}

TEST(Relaxation, DoesNotPullOnAToolThatDoesNotHold) {
  Felt touching(1.5), held(1.5, true);
  for (int i = 0; i < 5000; ++i) touching.force_N(8e-3), held.force_N(8e-3);
  double least_touching_N = 1.0, least_held_N = 1.0;
  for (int i = 8; i >= 1; --i) {  // faster than the tissue follows
    least_touching_N = std::min(least_touching_N, touching.force_N(i * 1e-3));
    least_held_N = std::min(least_held_N, held.force_N(i * 1e-3));
  }
  EXPECT_GE(least_touching_N, 0.0);
  EXPECT_LT(least_held_N, 0.0) << "what is held does pull";
}

TEST(Relaxation, ForgetsWhenTheToolLeaves) {
  Felt felt(1.0);
  const double first_N = felt.force_N(5e-3);
  for (int i = 0; i < 3000; ++i) felt.force_N(5e-3);
  felt.field.leave(0);
  EXPECT_NEAR(felt.force_N(5e-3), first_N, 1e-12);
}

TEST(Relaxation, AskedTwiceInATickRemembersTheLastAnswerOnly) {
  Felt once(1.0), twice(1.0);
  for (int i = 1; i <= 10; ++i) {
    twice.field.respond({.depth_m = 9e-3});
    EXPECT_EQ(once.force_N(i * 1e-3), twice.force_N(i * 1e-3));
  }
}

TEST(Relaxation, RefusesTermsWithoutMeaning) {
  const auto error_of = [](std::vector<PronyTerm> terms) {
    const auto made = make_relaxation(terms, kTick_s);
    return made ? std::string() : made.error().sentence;
  };
  EXPECT_EQ(error_of({}), "");
  EXPECT_NE(error_of({{0.7, 1.0}, {0.7, 2.0}}).find("add up to 1.4"), std::string::npos);
  EXPECT_NE(error_of({{0.1, 0.0}}).find("above 0"), std::string::npos);
  EXPECT_NE(error_of({{-0.1, 1.0}}).find("above 0"), std::string::npos);
  EXPECT_NE(error_of({{0.1, 1.0}, {0.1, 2.0}, {0.1, 3.0}, {0.1, 4.0}}).find("3 at most"),
            std::string::npos);
  EXPECT_FALSE(make_relaxation({}, 0.0));
}

TEST(Relaxation, SharesThatAddUpToOneButForRoundingLeaveNothing) {
  for (const auto& terms : {std::vector<PronyTerm>{{0.8, 1.0}, {0.2, 2.0}},
                            std::vector<PronyTerm>{{0.7, 1.0}, {0.2, 2.0}, {0.1, 3.0}}}) {
    const auto made = make_relaxation(terms, kTick_s);
    ASSERT_TRUE(made) << made.error().sentence;
    EXPECT_GE(made->share(0), 0.0);
    EXPECT_LT(made->share(0), 1e-12);
  }
  EXPECT_FALSE(make_relaxation(std::vector<PronyTerm>{{0.8, 1.0}, {0.200001, 2.0}}, kTick_s));
}

TEST(Relaxation, DoesNotTouchTheHeap) {
  Felt felt(1.5);
  const tests::NoAlloc guard;
  for (int i = 0; i < 100; ++i) felt.force_N(i * 1e-4);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace
}  // namespace tact::model
