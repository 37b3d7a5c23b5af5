// SPDX-License-Identifier: Apache-2.0
#include "model/contact/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/units.h"
#include "tests/model/contact/contact_bench.h"
#include "tests/support/no_alloc.h"
#include "tests/support/organs.h"

namespace tact::model::contact::contact_test {

using contact_bench::Bench;
using contact_bench::glide;
using contact_bench::kRadius_m;
using contact_bench::plate_bench;
using contact_bench::render_at;

TEST(Contact, IsSilentAboveTheSurface) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  EXPECT_EQ(render_at(contact, {0, 0, kRadius_m + 1_mm}), Wrench{});
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
}

TEST(Contact, PressesBackAlongTheNormalWithTheForceOfTheLaw) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, kRadius_m + 1_mm}, {0, 0, kRadius_m - 3_mm});
  const Wrench w = render_at(contact, {0, 0, kRadius_m - 3_mm});
  EXPECT_NEAR(w.force_N.z, bench.law.respond(3_mm).force_N, 1e-12);
  EXPECT_NEAR(std::hypot(w.force_N.x, w.force_N.y), 0.0, 1e-12);
}

TEST(Contact, LeverArmsOfTheSpheresGiveTheTorque) {
  Bench bench(tests::make_plate(100_mm, 20),
              {{{5_mm, 0, 0}, kRadius_m}, {{5_mm, 8_mm, -1_mm}, kRadius_m}});
  Contact contact = bench.contact();
  const Vec3 deep{0, 0, kRadius_m - 2_mm};
  glide(contact, deep + Vec3{0, 0, 5_mm}, deep);
  const Wrench w = render_at(contact, deep);
  const double f0 = bench.law.respond(2_mm).force_N, f1 = bench.law.respond(3_mm).force_N;
  EXPECT_NEAR(w.force_N.z, f0 + f1, 1e-12);      // forces add up
  EXPECT_NEAR(w.torque_Nm.x, 8_mm * f1, 1e-12);  // r x F about the tool's origin
  EXPECT_NEAR(w.torque_Nm.y, -5_mm * (f0 + f1), 1e-12);
}

TEST(Contact, NeverPullsOnAToolThatDoesNotHold) {
  Bench bench(tests::make_ball(50_mm, 4));
  Contact contact = bench.contact();
  std::mt19937 random(3);
  std::normal_distribution<double> nudge(0.0, 0.3_mm);
  Vec3 p{0, 0, 53_mm};
  int pressing = 0;
  for (int i = 0; i < 20000; ++i) {
    p += Vec3{nudge(random), nudge(random), nudge(random)};
    if (norm(p) < 40_mm || norm(p) > 60_mm) p = 53_mm * normalized(p);
    const Wrench w = render_at(contact, p);
    EXPECT_GE(dot(w.force_N, contact.contacts()[0].normal), -1e-12);
    if (contact.contacts()[0].state == ContactState::kInContact) ++pressing;
  }
  EXPECT_GT(pressing, 1000) << "most of the walk is in the tissue";
}

TEST(Contact, ForceIsTheSlopeOfItsPotential) {
  Bench bench(tests::make_ball(50_mm, 5));
  for (const double grip : {0.0, 1.0}) {
    const Vec3 p{2_mm, 3_mm, 50_mm};
    const double h = 1e-7;
    const auto energy_at = [&](const Vec3& q) {
      Contact contact = bench.contact();
      glide(contact, {2_mm, 3_mm, 56_mm}, p);
      render_at(contact, p, grip);
      render_at(contact, q, grip);
      return contact.contacts()[0].energy_J;
    };
    Contact contact = bench.contact();
    glide(contact, {2_mm, 3_mm, 56_mm}, p);
    const Wrench w = render_at(contact, p, grip);
    const auto slope = [&](const Vec3& e) {
      return -(energy_at(p + h * e) - energy_at(p - h * e)) / (2 * h);
    };
    EXPECT_NEAR(w.force_N.x, slope({1, 0, 0}), 2e-4);
    EXPECT_NEAR(w.force_N.y, slope({0, 1, 0}), 2e-4);
    EXPECT_NEAR(w.force_N.z, slope({0, 0, 1}), 2e-4);
  }
}

TEST(Contact, TakesEnergyFromEveryClosedStrokeThatRubs) {
  Bench bench(tests::make_ball(50_mm, 5));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> size(1_mm, 8_mm);
  bool touched = false;
  for (int loop = 0; loop < 20; ++loop) {
    Contact contact = bench.contact();
    const double across_m = size(random), deep_m = size(random);
    Vec3 before{0, 0, 56_mm};
    Wrench rendered_before = render_at(contact, before);
    double work_on_hand_J = 0.0;
    for (int i = 1; i <= 4000; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / 4000;
      const Vec3 p{across_m * std::sin(2 * phase), across_m * std::sin(phase),
                   56_mm - deep_m * (1 - std::cos(phase)) / 1.5};
      const Wrench rendered = render_at(contact, p);
      work_on_hand_J += 0.5 * dot(rendered.force_N + rendered_before.force_N, p - before);
      before = p;
      rendered_before = rendered;
    }
    EXPECT_LE(work_on_hand_J, 1e-9) << "loop " << loop;
    touched = touched || work_on_hand_J < -1e-6;
  }
  EXPECT_TRUE(touched) << "rubbing costs energy";
}

TEST(Contact, SlidingFrictionStaysInsideItsCone) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 0});
  glide(contact, {0, 0, 0}, {20_mm, 0, 0});
  const Wrench w = render_at(contact, {20_mm, 0, 0});
  EXPECT_NEAR(w.force_N.x, -0.4 * w.force_N.z, 1e-9) << "slides at the Coulomb cap, against motion";
  EXPECT_GT(w.force_N.z, 0.1);
}

TEST(Contact, BeyondTheRimOfAnOpenSurfaceNothingPullsTheToolBack) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {45_mm, 0, 6_mm}, {45_mm, 0, 1_mm});
  glide(contact, {45_mm, 0, 1_mm}, {53_mm, 0, -3_mm});
  glide(contact, {53_mm, 0, -3_mm}, {60_mm, 0, -10_mm});
  EXPECT_EQ(render_at(contact, {60_mm, 0, -10_mm}), Wrench{});
}

TEST(Contact, FoundInsideHasNoForceUntilOutsideOnce) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  EXPECT_EQ(render_at(contact, {0, 0, -8_mm}), Wrench{});
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kInside);
  glide(contact, {0, 0, -8_mm}, {0, 0, 3_mm});
  glide(contact, {0, 0, 3_mm}, {0, 0, -2_mm});
  EXPECT_EQ(render_at(contact, {0, 0, -2.5_mm}), Wrench{}) << "its lower end has never been out";
  glide(contact, {0, 0, -2.5_mm}, {0, 0, 4.1_mm});
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
  glide(contact, {0, 0, 4.1_mm}, {0, 0, 3.5_mm});
  EXPECT_NEAR(render_at(contact, {0, 0, 3.5_mm}).force_N.z, bench.law.respond(0.5_mm).force_N,
              1e-9);
}

TEST(Contact, PausedToolIsFollowedAlongItsWay) {
  Bench bench = plate_bench();
  for (const std::uint32_t periods : {2u, 5u, 20u}) {
    Contact steady = bench.contact(), paused = bench.contact();
    glide(steady, {0, 0, 6_mm}, {0, 0, 2_mm}), glide(paused, {0, 0, 6_mm}, {0, 0, 2_mm});
    const Vec3 from_m{0, 0, 2_mm}, to_m{1.5_mm, 0.5_mm, -1_mm};
    for (std::uint32_t k = 1; k <= periods; ++k)
      render_at(steady, from_m + (static_cast<double>(k) / periods) * (to_m - from_m));
    paused.detect_contact({.position_m = to_m}, periods);
    const ContactResponse rendered = paused.render_force({.position_m = to_m}, true);
    EXPECT_FALSE(rendered.is_lost);
    EXPECT_NEAR(norm(rendered.wrench.force_N - render_at(steady, to_m).force_N), 0.0, 1e-9);
    EXPECT_GT(norm(tangential(rendered.wrench.force_N, {0, 0, 1})), 1e-3) << "friction goes on";
  }
}

TEST(Contact, HeldTissueIsHeldOverAPause) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 2_mm});
  render_at(contact, {0, 0, 2_mm}, 1.0);
  const Tool tool{.position_m = {0, 0, 5_mm}, .grip_ratio = 1.0};
  contact.detect_contact(tool, 10);
  EXPECT_LT(contact.render_force(tool, true).wrench.force_N.z, 0.0) << "it pulls";
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kHeld);
}

TEST(Contact, ToolThatMovedTooFarUnseenIsLostAndFoundAgain) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 2_mm});
  const Tool inside{.position_m = {0, 0, -3_mm}}, outside{.position_m = {0, 0, 9_mm}};
  contact.detect_contact(inside, 1, 4_mm);
  ContactResponse rendered = contact.render_force(inside, true);
  EXPECT_TRUE(rendered.is_lost);
  EXPECT_TRUE(rendered.is_inside);
  EXPECT_EQ(rendered.wrench, Wrench{});
  contact.detect_contact(inside, 1, 4_mm);
  EXPECT_FALSE(contact.render_force(inside, true).is_lost) << "reported once";
  contact.detect_contact(outside, 1, 4_mm);
  EXPECT_TRUE(contact.render_force(outside, true).is_lost);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
}

TEST(Contact, PushedThroughAFlapIsHeldBackWithinTheLawAndThenLetGo) {
  Bench bench(tests::make_flap(
      {.length_m = 100_mm, .width_m = 80_mm, .thickness_m = 4_mm, .edge_m = 5_mm}));
  Contact contact = bench.contact();
  glide(contact, {0, 0, 8_mm}, {0, 0, -5_mm});
  EXPECT_GT(render_at(contact, {0, 0, -5_mm}).force_N.z, 0.1) << "the flap is pushed ahead";
  glide(contact, {0, 0, -5_mm}, {0, 0, -60_mm});
  EXPECT_EQ(render_at(contact, {0, 0, -60_mm}), Wrench{});
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
  glide(contact, {0, 0, -60_mm}, {0, 0, -5_mm});
  EXPECT_LT(render_at(contact, {0, 0, -5_mm}).force_N.z, -1e-3)
      << "from below it is met as from above";
}

TEST(Contact, NaNFromTheDeviceGivesNoForceAndForgetsTheSite) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 2_mm});
  EXPECT_EQ(render_at(contact, {std::nan(""), 0, 2_mm}), Wrench{});
  EXPECT_EQ(render_at(contact, {0, 0, 2_mm}), Wrench{}) << "back inside: depth comes for free";
}

TEST(Contact, LeavesTheHeapAlone) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  const tests::NoAlloc guard;
  glide(contact, {0, 0, 6_mm}, {5_mm, 0, 0});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::contact::contact_test
