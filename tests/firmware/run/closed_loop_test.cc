// SPDX-License-Identifier: Apache-2.0
// The whole controller with the simulated Delta and its hand: 60 simulated seconds of the liver
// (approaches, presses, holds, slides, pulls, tears, releases), a few of every other scene.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "firmware/loop/alloc_counter.h"
#include "firmware/run/replay.h"
#include "firmware/telemetry/force_hash.h"
#include "tests/support/scene_loop.h"

namespace tact::firmware::run::closed_loop_test {

struct Summary {
  std::uint64_t hash = model::kFnvStart;
  int ticks = 0, in_contact = 0, held = 0, pulling = 0, sliding = 0, tears = 0, openings = 0;
  double max_force_N = 0.0, max_pull_N = 0.0, max_depth_m = 0.0, max_step_N = 0.0;
  double max_free_force_N = 0.0, max_torque_Nm = 0.0;
  std::map<model::Fault, int> limits;
  double max_given_energy_J = 0.0;
  model::Fault fault = model::Fault::kNone;
  std::uint64_t heap_calls = 0;
};

using tests::any_in;

void add(Summary& s, const loop::TickRecord& r, const loop::TickRecord& before) {
  ++s.ticks;
  s.hash = telemetry::hash_wrench(s.hash, r.output.written);
  const double force_N = norm(r.output.written.force_N);
  s.max_force_N = std::max(s.max_force_N, force_N);
  s.max_torque_Nm = std::max(s.max_torque_Nm, norm(r.output.written.torque_Nm));
  s.max_step_N =
      std::max(s.max_step_N, norm(r.output.written.force_N - before.output.written.force_N));
  const bool held = any_in(r, model::ContactState::kHeld);
  const bool in_contact = any_in(r, model::ContactState::kInContact);
  s.held += held;
  s.in_contact += in_contact;
  if (!held && !in_contact)
    s.max_free_force_N = std::max(s.max_free_force_N, norm(r.output.wanted.force_N));
  if (held && r.output.wanted.force_N.z < 0.0) {
    ++s.pulling;
    s.max_pull_N = std::max(s.max_pull_N, -r.output.written.force_N.z);
  }
  if (in_contact && std::hypot(r.output.wanted.force_N.x, r.output.wanted.force_N.y) > 0.02)
    ++s.sliding;
  if (!held && any_in(before, model::ContactState::kHeld))
    ++(r.input.sample.tool.grip_ratio > 0.7 ? s.tears : s.openings);
  for (const auto& sphere_contact : r.contacts.all())
    s.max_depth_m = std::max(s.max_depth_m, sphere_contact.depth_m);
  ++s.limits[r.output.limit];
  s.max_given_energy_J = std::max(s.max_given_energy_J, r.output.given_energy_J);
  if (r.output.fault != model::Fault::kNone) s.fault = r.output.fault;
}

Summary run(const model::scene::Scene& scene, double seconds) {
  tests::SceneLoop rig(scene, 16);
  Summary summary;
  loop::TickRecord record, before;
  const auto ticks = static_cast<int>(seconds * scene.rate_Hz);
  for (int i = 0; i < ticks; ++i) {
    {
      const loop::HeapCallCounter watch;
      rig.loop.step();
      summary.heap_calls += watch.calls();
    }
    while (rig.ring->pop(record)) {
      add(summary, record, before);
      before = record;
    }
  }
  return summary;
}

TEST(ClosedLoop, SixtySecondsOfLiverStayWithinBoundsOnBothSides) {
  const model::scene::Scene liver = tests::shipped_scene("liver");
  const double tear_N = liver.contact.tear_force_N;
  const Summary s = run(liver, 60.0);
  EXPECT_EQ(s.ticks, 60000);
  EXPECT_EQ(s.fault, model::Fault::kNone);
  // It is really there: touched, held, pulled, slid, torn, let go.
  EXPECT_GT(s.in_contact, 10000);
  EXPECT_GT(s.held, 3000);
  EXPECT_GT(s.pulling, 1000);
  EXPECT_GT(s.sliding, 500);
  EXPECT_GE(s.tears, 2);
  EXPECT_GE(s.openings, 2);
  // A liver of 5 kPa under a fingertip-sized tool: a few tenths of a newton to about two.
  EXPECT_GT(s.max_force_N, 0.4);
  EXPECT_LT(s.max_force_N, 1.3);
  EXPECT_GT(s.max_pull_N, tear_N) << "both jaws pull, so together more than one tears at";
  EXPECT_LE(s.max_pull_N, 2.0 * tear_N) << "each of two jaws tears at tear_N";
  EXPECT_GT(s.max_depth_m, 0.004);
  EXPECT_LT(s.max_depth_m, 0.020);
  EXPECT_GT(s.max_torque_Nm, 1e-5);
  EXPECT_LT(s.max_torque_Nm, 4.0 * tear_N * 0.008) << "two jaws at 8 mm give half of this";
  EXPECT_EQ(s.max_free_force_N, 0.0) << "no contact, no force";
  EXPECT_GT(s.max_step_N, 0.2) << "the tear is a step ...";
  EXPECT_LE(s.max_step_N, 1.0 + 1e-12) << "... that keeps |dF| <= slew dt";
  EXPECT_EQ(s.heap_calls, 0u);
}

TEST(ClosedLoop, ForcepsHeldFarFromTheirJawsRenderATorque) {
  const model::scene::Scene scene = tests::shipped_scene("liver_twist");
  const Summary s = run(scene, 10.0);
  EXPECT_EQ(s.fault, model::Fault::kNone);
  // 0.21 N across a lever of 93 mm; jaws 8 mm apart would give less than 2 mN m.
  EXPECT_GT(s.max_torque_Nm, 0.018);
  EXPECT_LT(s.max_torque_Nm, 0.025);
}

class EveryScene : public testing::TestWithParam<const char*> {};

TEST_P(EveryScene, ContactStaysWithinTheLimitsAndLeavesTheHeapAlone) {
  const model::scene::Scene scene = tests::shipped_scene(GetParam());
  const Summary s = run(scene, 9.0);  // the gum is cut from 6 s on
  EXPECT_EQ(s.fault, model::Fault::kNone);
  EXPECT_GT(s.in_contact, 200);
  EXPECT_GT(s.max_force_N, 0.05);
  for (const model::Fault limit : {model::Fault::kForceLimited, model::Fault::kTorqueLimited,
                                   model::Fault::kTooFast, model::Fault::kEnergyLimited,
                                   model::Fault::kContinuousLimited, model::Fault::kPowerLimited})
    EXPECT_EQ(s.limits.count(limit), 0u)
        << describe(limit).name << ": for trouble, not for a scene";
  EXPECT_LT(s.max_given_energy_J, 0.1 * scene.limits.energy_J) << "tissue takes energy";
  EXPECT_GT(s.max_depth_m, 0.0005);
  EXPECT_LT(s.max_depth_m, 0.020);
  EXPECT_EQ(s.max_free_force_N, 0.0) << "no contact, no force";
  EXPECT_LE(s.max_step_N, scene.limits.slew_N_per_s / scene.rate_Hz + 1e-12);
  EXPECT_EQ(s.heap_calls, 0u);
}

TEST_P(EveryScene, TheSameRunGivesTheSameBits) {
  const model::scene::Scene scene = tests::shipped_scene(GetParam());
  const Summary a = run(scene, 8.0), b = run(scene, 8.0);
  EXPECT_GT(a.in_contact, 100);
  EXPECT_EQ(a.hash, b.hash);
}

INSTANTIATE_TEST_SUITE_P(ClosedLoop, EveryScene,
                         testing::Values("liver", "liver_twist", "liver_source", "grasper", "heart",
                                         "skin", "gum", "maintenance"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace tact::firmware::run::closed_loop_test
