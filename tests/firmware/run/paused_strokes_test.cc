// SPDX-License-Identifier: Apache-2.0
// The whole controller with the simulated Delta, whose hand moves on while the loop is stopped: the
// strokes of the liver are felt as without a pause.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/support/pass_time.h"
#include "tests/support/scene_loop.h"
#include "tools/stability/loop/random.h"

namespace tact::firmware::run::paused_strokes_test {

using model::ContactState;

// Of the way points of the scene; a release after a grip has two.
constexpr std::size_t kHoldThePull = 8, kTear = 13;

/// Periods that the loop skips, from a period of the run on.
struct Pause {
  int at_period = 0;
  int skipped = 0;
};

/// A tick, and the period of the run in which it began.
struct RenderedTick {
  int period = 0;
  bool held = false;
  loop::TickOutput output;
};

/// The strokes once, with these pauses in ascending order.
std::vector<RenderedTick> run(const model::scene::Scene& scene, const std::vector<Pause>& pauses) {
  tests::SceneLoop rig(scene);
  const auto periods = static_cast<int>(scene.hand.path.back().time_s * scene.rate_Hz);
  std::vector<RenderedTick> rendered;
  loop::TickRecord record;
  std::uint32_t skipped_before = 0;
  auto pause = pauses.begin();
  for (int period = 0; period < periods;) {
    // A tick that takes so long: the periods after it are skipped, the hand moves on.
    const bool pauses_now = pause != pauses.end() && period >= pause->at_period;
    const int skipped = pauses_now ? (pause++)->skipped : 0;
    if (pauses_now) tests::pass_ns(rig.clock, (skipped + 1) * rig.period_ns);
    rig.loop.step();
    EXPECT_TRUE(rig.ring->pop(record));
    EXPECT_EQ(record.input.skipped_periods, skipped_before);
    rendered.push_back({.period = period,
                        .held = tests::any_in(record, ContactState::kHeld),
                        .output = record.output});
    skipped_before = static_cast<std::uint32_t>(skipped);
    period += 1 + skipped;
  }
  EXPECT_EQ(pause, pauses.end());
  return rendered;
}

/// One in each part of the run that has the same length, at a random place; none before `first`.
std::vector<Pause> random_pauses(std::uint64_t seed, int count, int first, int periods) {
  tools::stability::Random chance(seed);
  const int part = (periods - first) / count;
  std::vector<Pause> pauses;
  for (int i = 0; i < count; ++i) {
    // Some periods stay between two of them: late ticks in a row latch (overrun_counter.h).
    const int at = first + i * part + static_cast<int>(chance.uniform() * (part - 25));
    pauses.push_back({.at_period = at, .skipped = 2 + static_cast<int>(chance.uniform() * 18.0)});
  }
  return pauses;
}

double largest_force_N(const std::vector<RenderedTick>& rendered, int from, int to) {
  double largest_N = 0.0;
  for (const RenderedTick& tick : rendered)
    if (tick.period >= from && tick.period < to)
      largest_N = std::max(largest_N, norm(tick.output.written.force_N));
  return largest_N;
}

/// The first period from there on in which nothing is held any more; -1: none.
int let_go_in(const std::vector<RenderedTick>& rendered, int from, int to) {
  for (std::size_t i = 1; i < rendered.size(); ++i)
    if (rendered[i - 1].held && !rendered[i].held && rendered[i].period >= from &&
        rendered[i].period < to)
      return rendered[i].period;
  return -1;
}

/// At the ticks that both runs have.
double farthest_apart_N(const std::vector<RenderedTick>& all,
                        const std::vector<RenderedTick>& paused, int from, int to) {
  double most_N = 0.0;
  for (const RenderedTick& tick : paused) {
    if (tick.period < from || tick.period >= to) continue;
    const RenderedTick& same = all[static_cast<std::size_t>(tick.period)];
    most_N = std::max(most_N, norm(tick.output.written.force_N - same.output.written.force_N));
  }
  return most_N;
}

RenderedTick at_period(const std::vector<RenderedTick>& rendered, int period) {
  const auto tick = std::ranges::find(rendered, period, &RenderedTick::period);
  EXPECT_NE(tick, rendered.end()) << "skipped: " << period;
  return tick != rendered.end() ? *tick : RenderedTick{};
}

void expect_undisturbed(const std::vector<RenderedTick>& rendered) {
  EXPECT_EQ(rendered.back().output.contact_losses, 0u);
  EXPECT_EQ(rendered.back().output.state, loop::State::kArmed);
  for (const RenderedTick& tick : rendered) {
    ASSERT_EQ(tick.output.fault, model::Fault::kNone) << tick.period;
    ASSERT_NE(tick.output.limit, model::Fault::kToolInside) << tick.period;
  }
}

class PausedStrokes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    undisturbed_ = new std::vector(run(tests::shipped_scene("liver"), {}));
  }
  static void TearDownTestSuite() { delete undisturbed_; }

  int starts(std::size_t waypoint) const { return period_of(scene_.hand.path[waypoint].time_s); }
  int period_of(double time_s) const { return static_cast<int>(time_s * scene_.rate_Hz); }

  model::scene::Scene scene_ = tests::shipped_scene("liver");
  static inline const std::vector<RenderedTick>* undisturbed_ = nullptr;
};

TEST_F(PausedStrokes, AHundredPausesLeaveTheForceOfEveryStrokeAndTheTear) {
  const auto& path = scene_.hand.path;
  const int torn_in = let_go_in(*undisturbed_, starts(kTear), starts(kTear + 1));
  ASSERT_GE(torn_in, 0) << "else it proves nothing";
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const std::vector<RenderedTick> paused =
        run(scene_, random_pauses(seed, 100, period_of(0.1), starts(path.size() - 1)));
    expect_undisturbed(paused);
    for (std::size_t stroke = 0; stroke + 1 < path.size(); ++stroke) {
      const int from = starts(stroke), to = starts(stroke + 1);
      const double most_N = largest_force_N(*undisturbed_, from, to);
      EXPECT_NEAR(largest_force_N(paused, from, to), most_N, 0.05 * most_N) << stroke;
      EXPECT_LE(farthest_apart_N(*undisturbed_, paused, from, to), 0.05 * most_N) << stroke;
    }
    // By force: the grip opens in the next stroke. The tick that tears may have been skipped.
    EXPECT_NEAR(let_go_in(paused, starts(kTear), starts(kTear + 1)), torn_in, 20) << seed;
  }
}

TEST_F(PausedStrokes, HeldTissueKeepsItsPullAfterAPauseOf19Periods) {
  const int middle = (starts(kHoldThePull) + starts(kHoldThePull + 1)) / 2;
  const std::vector<RenderedTick> paused = run(scene_, {{.at_period = middle, .skipped = 19}});
  expect_undisturbed(paused);
  const auto before = at_period(paused, middle - 1), after = at_period(paused, middle + 20 + 10);
  EXPECT_TRUE(before.held && after.held);
  EXPECT_EQ(let_go_in(paused, starts(kHoldThePull) - 1, starts(kHoldThePull + 1)), -1);
  const double pull_N = norm(before.output.written.force_N);
  EXPECT_LT(before.output.written.force_N.z, -0.3) << "else it proves nothing";
  EXPECT_LE(norm(after.output.written.force_N - before.output.written.force_N), 0.05 * pull_N);
}

}  // namespace tact::firmware::run::paused_strokes_test
