// A patch whose nodes left the finite numbers: no force until it is let alone, then a fresh one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/no_alloc.h"
#include "tests/patch_fixture.h"

namespace tact::model {

/// Throws the node under the contact to a place, as a step that is too long would.
struct SpringPatchBreaker {
  static void put_first_node(SpringPatch& patch, const Vec3& at_m) {
    patch.region_.network({}).node.position_m[0] = at_m;
  }
};

namespace {

using tests::PressedPatch;
using tests::soft_patch;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_silent(const SiteResponse& r) {
  return r.law.status == LawStatus::kSingular && r.law.force_N == 0.0 &&
         r.law.stiffness_N_per_m == 0.0 && r.slope_N == Vec3{};
}

TEST(SpringPatchBroke, GivesNoForceUntilEverySphereHasLeft) {
  for (const Vec3& thrown_m : {Vec3{kNaN, 0, 0}, Vec3{0, 0, -1e200}, Vec3{0, 0, 3.0}}) {
    SpringPatchParameters p = soft_patch();
    p.spheres = 2;
    p.node_mass_kg = 0.004;
    PressedPatch pressed(p);
    SpringPatch& patch = pressed.patch();
    const Indentation beside{.sphere = 1, .place = {500, {0.3, 0.3, 0.4}}, .depth_m = 0.001};
    for (int i = 0; i < 100; ++i) {
      EXPECT_EQ(pressed.move_to(0.001, 0.002, 0.003).law.status, LawStatus::kOk);
      patch.respond(beside);
      pressed.advance();
    }
    EXPECT_FALSE(patch.broke());
    SpringPatchBreaker::put_first_node(patch, thrown_m);
    const tests::NoAlloc guard;
    for (int i = 0; i < 50; ++i) {
      if (i > 0) {
        EXPECT_TRUE(is_silent(pressed.move_to(0.001, 0.002, 0.003))) << "tick " << i;
        EXPECT_TRUE(is_silent(patch.respond(beside))) << "tick " << i;
      }
      pressed.advance();
      EXPECT_EQ(patch.broke(), i > 0 || !std::isfinite(thrown_m.x) || thrown_m.z < -1e100);
    }
    patch.leave(0);
    EXPECT_TRUE(patch.broke()) << "one sphere still presses";
    EXPECT_TRUE(is_silent(patch.respond(beside)));
    patch.leave(1);
    EXPECT_FALSE(patch.broke());
    const SiteResponse fresh = pressed.move_to(0.001, 0.002, 0.002);
    EXPECT_EQ(fresh.law.status, LawStatus::kOk);
    EXPECT_NEAR(fresh.law.force_N, 0.6, 1e-12) << "300 N/m * 2 mm, nothing remembered";
    EXPECT_EQ(guard.calls(), 0u);
  }
}

TEST(SpringPatchBroke, ASoundPatchNeverTellsThatItBroke) {
  PressedPatch pressed(soft_patch());
  for (int i = 0; i < 500; ++i) {
    pressed.move_to(0.0, 0.0, 0.01 * std::sin(0.2 * i), true);
    pressed.advance();
    EXPECT_FALSE(pressed.patch().broke());
  }
}

}  // namespace
}  // namespace tact::model
