// SPDX-License-Identifier: Apache-2.0
// When a closed grip holds tissue and when it loses it: rest_grip.cc.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/model/contact/contact_bench.h"

namespace tact::model::contact::contact_grip_test {

using contact_bench::Bench;
using contact_bench::glide;
using contact_bench::kRadius_m;
using contact_bench::plate_bench;
using contact_bench::render_at;

TEST(ContactGrip, HoldingPullsAndHasNoFrictionCap) {
  Bench bench = plate_bench();
  bench.parameters.tear_force_N = 10.0;
  Contact contact = bench.contact();
  const Vec3 grip_m{0, 0, kRadius_m - 1_mm};
  glide(contact, {0, 0, 6_mm}, grip_m);
  render_at(contact, grip_m, 1.0);
  glide(contact, grip_m, {0, 0, kRadius_m + 4_mm}, 1.0);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kHeld);
  const Wrench up = render_at(contact, {0, 0, kRadius_m + 4_mm}, 1.0);
  EXPECT_NEAR(up.force_N.z, bench.law.respond(-4_mm).force_N, 1e-12);
  EXPECT_LT(up.force_N.z, -0.1);
  const Wrench aside = render_at(contact, {6_mm, 0, kRadius_m + 4_mm}, 1.0);
  EXPECT_NEAR(aside.force_N.x, -100.0 * 6_mm, 1e-12) << "no cap while held";
}

TEST(ContactGrip, LetsGoWhenTheGripOpens) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 3_mm});
  render_at(contact, {0, 0, 3_mm}, 1.0);
  glide(contact, {0, 0, 3_mm}, {0, 0, 6_mm}, 1.0);
  EXPECT_LT(render_at(contact, {0, 0, 6_mm}, 1.0).force_N.z, 0.0);
  EXPECT_EQ(render_at(contact, {0, 0, 6_mm}, 0.0), Wrench{});
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
}

TEST(ContactGrip, TearsAboveTheTearForceAndHoldsAgainOnlyAfterOpening) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 3_mm});
  render_at(contact, {0, 0, 3_mm}, 1.0);
  double largest_pull_N = 0.0;
  for (double z = 3_mm; z < 30_mm; z += 0.02_mm)
    largest_pull_N = std::max(largest_pull_N, -render_at(contact, {0, 0, z}, 1.0).force_N.z);
  EXPECT_LE(largest_pull_N, 0.6);
  EXPECT_GT(largest_pull_N, 0.59);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kFree);
  glide(contact, {0, 0, 30_mm}, {0, 0, 3_mm}, 1.0);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kInContact) << "still closed since the tear";
  render_at(contact, {0, 0, 3_mm}, 0.0);
  render_at(contact, {0, 0, 3_mm}, 1.0);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kHeld);
}

TEST(ContactGrip, ATearWhilePressingLeavesThePressWithoutAClick) {
  Bench bench = plate_bench();
  Contact contact = bench.contact();
  glide(contact, {0, 0, 6_mm}, {0, 0, 2_mm});
  render_at(contact, {0, 0, 2_mm}, 1.0);
  const double pressing_N = bench.law.respond(2_mm).force_N;
  for (double x = 0.0; x < 10_mm; x += 0.05_mm)  // torn sideways at 100 N/m * 6 mm = 0.6 N
    EXPECT_NEAR(render_at(contact, {x, 0, 2_mm}, 1.0).force_N.z, pressing_N, 1e-9);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kInContact);
}

TEST(ContactGrip, LettingGoNeverAddsEnergy) {
  // Held at the bottom of a bowl and dragged level, the true depth grows while the held one stays.
  Bench bench(tests::make_bowl(50_mm, 5));
  bench.parameters.tear_force_N = 100.0;
  const Vec3 grip_m{0, 0, -48_mm};
  for (const Vec3& drag : {Vec3{8_mm, 0, 0}, Vec3{6_mm, 6_mm, 0}, Vec3{0, 0, 5_mm}}) {
    Contact contact = bench.contact();
    glide(contact, {0, 0, -40_mm}, grip_m);
    render_at(contact, grip_m, 1.0);
    glide(contact, grip_m, grip_m + drag, 1.0);
    const double held_J = contact.contacts()[0].energy_J;
    const double normal_J = bench.law.respond(contact.contacts()[0].depth_m).energy_J;
    render_at(contact, grip_m + drag, 0.0);
    EXPECT_LE(contact.contacts()[0].energy_J, held_J + 1e-15);
    EXPECT_LE(contact.contacts()[0].energy_J, normal_J + 1e-12);
  }
  // The first drag really ends deeper than it was held: without slack it would push harder.
  Contact fresh = bench.contact();
  glide(fresh, {8_mm, 0, -40_mm}, {8_mm, 0, -48_mm});
  EXPECT_GT(fresh.contacts()[0].depth_m, 2.5_mm);
}

}  // namespace tact::model::contact::contact_grip_test
