// SPDX-License-Identifier: Apache-2.0
// A patch whose nodes left the finite numbers: no force until it is let alone, then a fresh one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/model/springs/patch_fixture.h"
#include "tests/support/no_alloc.h"

namespace tact::model::springs {
namespace {

using tests::PressedPatch;
using tests::soft_patch;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// As a step that is too long would: no checked patch does so by itself.
void throw_first_node(SpringPatch& patch, const Vec3& to_m) {
  const_cast<PatchRegion&>(patch.region()).network({}).node.position_m[0] = to_m;
}

bool is_silent(const contact::ContactLawResponse& r) {
  return r.law.status == law::LawStatus::kSingular && r.law.force_N == 0.0 &&
         r.law.stiffness_N_per_m == 0.0 && r.slope_N == Vec3{};
}

TEST(SpringPatchBroke, GivesNoForceUntilEverySphereHasLeft) {
  for (const Vec3& thrown_m : {Vec3{kNaN, 0, 0}, Vec3{0, 0, -1e200}, Vec3{0, 0, 3.0}}) {
    SpringPatchParameters p = soft_patch();
    p.spheres = 2;
    p.node_mass_kg = 0.004;
    PressedPatch pressed(p);
    SpringPatch& patch = pressed.patch();
    const contact::Indentation beside{
        .sphere = 1, .surface_point = {500, {0.3, 0.3, 0.4}}, .indentation_m = 0.001};
    for (int i = 0; i < 100; ++i) {
      EXPECT_EQ(pressed.move_to(0.001, 0.002, 0.003).law.status, law::LawStatus::kOk);
      patch.respond(beside);
      pressed.advance();
    }
    EXPECT_FALSE(patch.is_broken());
    throw_first_node(patch, thrown_m);
    const tests::NoAlloc guard;
    for (int i = 0; i < 50; ++i) {
      if (i > 0) {
        EXPECT_TRUE(is_silent(pressed.move_to(0.001, 0.002, 0.003))) << "tick " << i;
        EXPECT_TRUE(is_silent(patch.respond(beside))) << "tick " << i;
      }
      pressed.advance();
      EXPECT_EQ(patch.is_broken(), i > 0 || !std::isfinite(thrown_m.x) || thrown_m.z < -1e100);
    }
    patch.leave(0);
    EXPECT_TRUE(patch.is_broken()) << "one sphere still presses";
    EXPECT_TRUE(is_silent(patch.respond(beside)));
    patch.leave(1);
    EXPECT_FALSE(patch.is_broken());
    const contact::ContactLawResponse fresh = pressed.move_to(0.001, 0.002, 0.002);
    EXPECT_EQ(fresh.law.status, law::LawStatus::kOk);
    EXPECT_NEAR(fresh.law.force_N, 0.6, 1e-12) << "300 N/m * 2 mm, nothing remembered";
    EXPECT_EQ(guard.calls(), 0u);
  }
}

TEST(SpringPatchBroke, ASoundPatchNeverReportsThatItBroke) {
  PressedPatch pressed(soft_patch());
  for (int i = 0; i < 500; ++i) {
    pressed.move_to(0.0, 0.0, 0.01 * std::sin(0.2 * i), true);
    pressed.advance();
    EXPECT_FALSE(pressed.patch().is_broken());
  }
}

}  // namespace
}  // namespace tact::model::springs
