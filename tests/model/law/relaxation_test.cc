// SPDX-License-Identifier: Apache-2.0
// Relaxation: the exact fade and passivity for any law, and no pull from tissue that is not held.
#include "model/law/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "model/law/tabulated_law.h"
#include "model/tissue/elastic_field.h"
#include "tests/support/no_alloc.h"

namespace tact::model::law::relaxation_test {

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
    return {.force_N = std::copysign(force_N, d),
            .stiffness_N_per_m = 100.0 * power_ * std::pow(size, power_ - 1.0),
            .energy_J = force_N * size / (power_ + 1.0)};
  }
  LawRange range() const RT_SAFE override { return {-0.02, 0.02}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  double power_;
};

// A spring, and one that hardens: its exponent grows from 1 to 2.5 at 10 mm.
class MixedLaw final : public Law {
 public:
  LawResponse respond(double d) const RT_SAFE override {
    const LawResponse a = spring_.respond(d), b = cubic_.respond(d);
    return {.force_N = a.force_N + 3e4 * b.force_N,
            .stiffness_N_per_m = a.stiffness_N_per_m + 3e4 * b.stiffness_N_per_m,
            .energy_J = a.energy_J + 3e4 * b.energy_J};
  }
  LawRange range() const RT_SAFE override { return spring_.range(); }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  PowerLaw spring_{1.0}, cubic_{3.0};
};

/// A law as rendered, with memory of some terms.
struct Rendered {
  explicit Rendered(const Law& law, bool is_held = false,
                    const Relaxation& relaxation = two_terms())
      : curve(&law),
        field({.curves = {&curve, 1},
               .coordinate = {},
               .pull_coordinate = {},
               .surface = {},
               .relaxation = relaxation}),
        held(is_held) {}
  double force_N(double depth_m) {
    response = field.respond({.indentation_m = depth_m, .held = held}).law;
    field.advance();
    return response.force_N;
  }
  const Law* curve;
  tissue::ElasticField field;
  LawResponse response;
  bool held;
};

// The first tick is a ramp of one tick, not a step: the terms fade by half a tick meanwhile.
void expect_fade(const Law& law, double fast_s, double slow_s, double tolerance) {
  const std::vector<PronyTerm> terms{{0.3, fast_s}, {0.2, slow_s}};
  Rendered rendered(law, false, *make_relaxation(terms, kTick_s));
  const double first_N = rendered.force_N(0.01);
  double t_s = 0.0;
  for (int i = 1; i <= 20'000; ++i) {
    const double now_N = rendered.force_N(0.01);
    t_s += kTick_s;
    const double g = 0.5 + 0.3 * std::exp(-t_s / fast_s) + 0.2 * std::exp(-t_s / slow_s);
    ASSERT_NEAR(now_N / first_N, g, tolerance) << "after " << t_s << " s";
  }
}

TEST(Relaxation, FadesAtHeldDepthExactlyByItsTermsForAnyLaw) {
  for (const double power : {1.0, 1.5, 3.0}) expect_fade(PowerLaw(power), 0.5, 8.0, 6e-4);
  expect_fade(MixedLaw{}, 0.5, 8.0, 6e-4);
  expect_fade(*tabulate(PowerLaw(1.5), kMaxKnots), 0.5, 8.0, 6e-4);
  // 50 ticks to 1/e: the first tick alone takes 0.3 % of the force.
  for (const double power : {1.0, 1.5}) expect_fade(PowerLaw(power), 0.05, 0.5, 4e-3);
}

TEST(Relaxation, HeldTermsFadeToATenthOfAPercentAfterTheFirstTick) {
  const std::vector<PronyTerm> terms{{.share = 1.0, .time_s = 0.05}};
  const MixedLaw law;
  Rendered rendered(law, false, *make_relaxation(terms, kTick_s));
  const double first_N = rendered.force_N(0.01);
  for (int i = 1; i <= 500; ++i)
    ASSERT_NEAR(rendered.force_N(0.01) / first_N, std::exp(-i * kTick_s / 0.05), 1e-3);
}

TEST(Relaxation, ARampAsLongAsItsTimeIsNearTheConvolutionOfLeeAndRadok) {
  // F(t) = integral of G(t - s) dF_0(d(s)), F_0 ~ d^1.5, d = v s: RX-5.
  const std::vector<PronyTerm> terms{{.share = 0.5, .time_s = 1.0}};
  const PowerLaw law(1.5);
  Rendered rendered(law, false, *make_relaxation(terms, kTick_s));
  double force_N = 0.0, convolved = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double s = (i + 0.5) * kTick_s;
    convolved += 1.5 * std::sqrt(s) * std::exp(s - 1.0) * kTick_s;
    force_N = rendered.force_N(0.01 * (i + 1) * kTick_s);
  }
  EXPECT_NEAR(convolved, 0.6929, 1e-4);
  const double right_N = law.respond(0.01).force_N * (0.5 + 0.5 * convolved);
  EXPECT_NEAR(force_N / right_N, 1.0, 0.05);  // 4.1 % below
}

TEST(Relaxation, FlowsAtABoundedRateForAnyOutputOfTheLaw) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double e : {0.0, 5e-324, 1e-3, -1e-3, 1e300})
    for (const double force_N : {0.0, 5e-324, 1.0, -1.0, inf, nan})
      for (const double k : {0.0, 5e-324, 100.0, -100.0, inf, nan}) {
        const double q = flow_ratio(e, {.force_N = force_N, .stiffness_N_per_m = k});
        EXPECT_TRUE(q >= 0.0 && q <= 4.0) << e << ' ' << force_N << ' ' << k;
      }
  EXPECT_NEAR(flow_ratio(3e-3, PowerLaw(1.5).respond(3e-3)), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(flow_ratio(-3e-3, PowerLaw(1.0).respond(-3e-3)), 1.0, 1e-12);
}

TEST(Relaxation, IsExactInTheTickForADepthThatMovesEvenly) {
  // e' = v - e / tau from rest: e = v tau (1 - exp(-t / tau)), for any tick.
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

// Work of the hand along a random path of 10 mm, by the trapezoid rule over fine ticks.
void expect_passive(const Law& law, bool held, unsigned seed) {
  Rendered rendered(law, held);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> target_m(held ? -0.01 : 0.0, 0.01);
  std::uniform_int_distribution<int> length(5, 2000);
  double depth_m = 0.0, force_N = 0.0, work_J = 0.0, most_J = 0.0;
  for (int leg = 0; leg < 60; ++leg) {
    const double to_m = leg == 59 ? 0.0 : target_m(random);
    const int ticks = length(random);
    const double step_m = (to_m - depth_m) / ticks;
    for (int i = 0; i < ticks; ++i) {
      const double now_N = rendered.force_N(depth_m + step_m);
      work_J += 0.5 * (force_N + now_N) * step_m;
      depth_m += step_m;
      force_N = now_N;
      most_J = std::max(most_J, work_J);
      ASSERT_GE(work_J, rendered.response.energy_J - 1e-4 * most_J) << "more stored than put in";
      if (!held) ASSERT_GE(force_N, -1e-12) << "pressed tissue pulls";
    }
  }
  EXPECT_GT(work_J, 0.0) << "relaxation costs energy";
}

TEST(Relaxation, NeverReturnsMoreThanItGotForAnyLawAndPath) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    for (const bool held : {false, true}) {
      for (const double power : {1.0, 1.5, 3.0}) expect_passive(PowerLaw(power), held, seed);
      expect_passive(MixedLaw{}, held, seed);
    }
}

// F = 100 d^1.5 as far as 5 mm, and flat beyond.
class ShortLaw final : public Law {
 public:
  LawResponse respond(double d) const RT_SAFE override {
    const double inside_m = std::clamp(d, -0.005, 0.005);
    LawResponse r = law_.respond(inside_m);
    if (d == inside_m) return r;
    r.energy_J += r.force_N * (d - inside_m);
    r.stiffness_N_per_m = 0.0;
    r.status = LawStatus::kSaturated;
    return r;
  }
  LawRange range() const RT_SAFE override { return {-0.005, 0.005}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  PowerLaw law_{1.5};
};

TEST(Relaxation, NeverReturnsMoreThanItGotBeyondTheRangeOfALaw) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    for (const bool held : {false, true}) expect_passive(ShortLaw{}, held, seed);
}

TEST(Relaxation, DoesNotPullOnAToolThatDoesNotHold) {
  const PowerLaw law(1.5);
  Rendered touching(law), held(law, true);
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
  const PowerLaw law(1.0);
  Rendered rendered(law);
  const double first_N = rendered.force_N(5e-3);
  for (int i = 0; i < 3000; ++i) rendered.force_N(5e-3);
  rendered.field.leave(0);
  EXPECT_NEAR(rendered.force_N(5e-3), first_N, 1e-12);
}

TEST(Relaxation, AskedTwiceInATickRemembersTheLastAnswerOnly) {
  const PowerLaw law(1.5);
  Rendered once(law), twice(law);
  for (int i = 1; i <= 10; ++i) {
    twice.field.respond({.indentation_m = 9e-3});
    EXPECT_EQ(once.force_N(i * 1e-3), twice.force_N(i * 1e-3));
  }
}

TEST(Relaxation, RefusesTermsWithoutMeaning) {
  const auto error_of = [](std::vector<PronyTerm> terms) {
    const auto made = make_relaxation(terms, kTick_s);
    return made ? std::string() : made.error().message;
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
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_GE(made->share(0), 0.0);
    EXPECT_LT(made->share(0), 1e-12);
  }
  EXPECT_FALSE(make_relaxation(std::vector<PronyTerm>{{0.8, 1.0}, {0.200001, 2.0}}, kTick_s));
}

TEST(Relaxation, LeavesTheHeapAlone) {
  const PowerLaw law(1.5);
  Rendered rendered(law);
  const tests::NoAlloc guard;
  for (int i = 0; i < 100; ++i) rendered.force_N(i * 1e-4);
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::law::relaxation_test
