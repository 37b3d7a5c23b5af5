// SPDX-License-Identifier: Apache-2.0
// Closed sheets thinner than their triangles are wide: both sides press alike, air presses nothing.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/organs.h"

namespace tact::model::contact::thin_flap_test {

constexpr double kRadius_m = 4_mm, kStep_m = 0.05_mm;

/// The force at the end of a straight way along z, and the largest on it.
struct Ride {
  double last_N = 0.0, most_N = 0.0;
  ContactState state = ContactState::kFree;
};
Ride ride(Contact& contact, double from_m, double to_m) {
  Ride out;
  const auto steps = static_cast<int>(std::abs(to_m - from_m) / kStep_m + 0.5);
  for (int i = 0; i <= steps; ++i) {
    const Tool tool{.position_m = {0.7_mm, 0.4_mm, from_m + (to_m - from_m) * i / steps}};
    contact.detect_contact(tool);
    out.last_N = contact.render_force(tool, false).wrench.force_N.z;
    out.most_N = std::max(out.most_N, std::abs(out.last_N));
  }
  out.state = contact.contacts()[0].state;
  return out;
}

/// 5 mm into the top at z = 0 and the underside, from afar; then out again.
void expect_both_sides_alike(const mesh::SurfaceMesh& mesh, double top_m, double bottom_m) {
  const tests::ContactSurface surface(mesh);
  tests::SoftBody soft(surface, {{{}, kRadius_m}}, 0.0);
  const double want_N = soft.curve.respond(5_mm).force_N;
  Contact above(soft.contact_scene()), below(soft.contact_scene());
  EXPECT_NEAR(ride(above, top_m + 40_mm, top_m + kRadius_m - 5_mm).last_N, want_N, 0.02 * want_N);
  EXPECT_NEAR(ride(below, bottom_m - 40_mm, bottom_m - kRadius_m + 5_mm).last_N, -want_N,
              0.02 * want_N);
  EXPECT_EQ(ride(above, top_m + kRadius_m - 5_mm, top_m + 40_mm).last_N, 0.0);
  EXPECT_EQ(ride(below, bottom_m - kRadius_m + 5_mm, bottom_m - 40_mm).last_N, 0.0);
  EXPECT_EQ(above.contacts()[0].state, ContactState::kFree);
  EXPECT_EQ(below.contacts()[0].state, ContactState::kFree);
}

class ThinFlap : public ::testing::TestWithParam<double> {
 protected:
  mesh::SurfaceMesh flap_ = tests::make_flap(
      {.length_m = 100_mm, .width_m = 80_mm, .thickness_m = GetParam(), .edge_m = 5_mm});
};

TEST_P(ThinFlap, SameForceFromAboveAndBelow) { expect_both_sides_alike(flap_, 0.0, -GetParam()); }

TEST_P(ThinFlap, NoForceInAirMovingAway) {
  const tests::ContactSurface surface(flap_);
  tests::SoftBody soft(surface, {{{}, kRadius_m}}, 0.0);
  for (const double from_m : {15_mm, 5_mm}) {
    Contact above(soft.contact_scene()), below(soft.contact_scene());
    EXPECT_EQ(ride(above, from_m, from_m + 60_mm).most_N, 0.0);
    EXPECT_EQ(ride(below, -GetParam() - from_m, -GetParam() - from_m - 60_mm).most_N, 0.0);
  }
}

TEST_P(ThinFlap, PushedThroughAndFarAwayIsFree) {
  const tests::ContactSurface surface(flap_);
  tests::SoftBody soft(surface, {{{}, kRadius_m}}, 0.0);
  Contact contact(soft.contact_scene());
  ride(contact, 20_mm, -100_mm);
  EXPECT_EQ(ride(contact, -100_mm, -120_mm).most_N, 0.0);
  // And it can be touched again, from the side on which it is.
  EXPECT_LT(ride(contact, -120_mm, -GetParam() - 2_mm).last_N, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Thickness, ThinFlap, ::testing::Values(2_mm, 4_mm, 5_mm, 8_mm));

mesh::SurfaceMesh fine_sheet() {
  return tests::make_flap(
      {.length_m = 40_mm, .width_m = 40_mm, .thickness_m = 1_mm, .edge_m = 1.2_mm});
}

TEST(TwoSheets, OneMillimetreApartPressAlikeFromBothSides) {
  expect_both_sides_alike(tests::join(fine_sheet(), tests::shifted(fine_sheet(), {0, 0, -2_mm})),
                          0.0, -3_mm);
}

TEST(TwoSheets, ASmallSphereBetweenThemPressesBoth) {
  const tests::ContactSurface surface(
      tests::join(fine_sheet(), tests::shifted(fine_sheet(), {0, 0, -5_mm})));  // 4 mm apart
  tests::SoftBody soft(surface, {{{}, 1_mm}}, 0.0);
  const double middle_m = -3_mm, want_N = soft.curve.respond(0.5_mm).force_N;
  for (const double side : {1.0, -1.0}) {
    Contact contact(soft.contact_scene());
    const Ride in = ride(contact, middle_m, middle_m + side * 1.5_mm);
    EXPECT_NEAR(in.last_N, -side * want_N, 0.02 * want_N);
    EXPECT_EQ(ride(contact, middle_m + side * 1.5_mm, middle_m).last_N, 0.0);
  }
}

}  // namespace tact::model::contact::thin_flap_test
