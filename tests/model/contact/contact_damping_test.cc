// SPDX-License-Identifier: Apache-2.0
// A law that resists speed, on a whole tool: it takes energy in every tick, and never pulls.
#include <gtest/gtest.h>

#include <cmath>

#include "model/contact/contact.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::contact_damping_test {

constexpr double kTick_s = 1_ms, kRadius_m = 4_mm;

// F + b d' = k d (1 + lambda d')
class SpringWithLoss final : public law::Law {
 public:
  explicit SpringWithLoss(double lambda_s_per_m) : lambda_s_per_m_(lambda_s_per_m) {}
  law::LawResponse respond(double d) const RT_SAFE override {
    if (!(d > 0.0)) return {.status = law::LawStatus::kNoContact};
    return {kStiffness_N_per_m * d, kStiffness_N_per_m, 0.5 * kStiffness_N_per_m * d * d};
  }
  double damping_Ns_per_m(double d) const RT_SAFE override {
    return lambda_s_per_m_ * respond(d).force_N;
  }
  law::LawRange range() const RT_SAFE override { return {0.0, 12_mm}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1_mm; }

 private:
  static constexpr double kStiffness_N_per_m = 40.0;
  double lambda_s_per_m_;
};

struct Bench {
  explicit Bench(double lambda_s_per_m, bool coupled = false)
      : law(lambda_s_per_m),
        field({.curves = {&curve, 1},
               .coordinate = {},
               .pull_coordinate = {},
               .surface = {},
               .relaxation = {},
               .neighbours = {.contact_modulus_Pa = coupled ? 6000.0 : 0.0},
               .damps = lambda_s_per_m > 0.0}) {}

  SpringWithLoss law;
  const law::Law* curve = &law;
  tissue::ElasticField field;
  mesh::SurfaceMesh mesh = tests::make_plate(100_mm, 20);
  TriangleTree tree = make_triangle_tree(mesh.view());
  std::vector<ProbeSphere> spheres{{{0, -5_mm, 0}, kRadius_m}, {{0, 5_mm, 0}, kRadius_m}};
  Contact contact{{.law = &field,
                   .parameters = {.tear_force_N = 0.6},
                   .spheres = spheres,
                   .surface = mesh.view(),
                   .tree = tree.view(),
                   .blade = {}}};
};

// Both spheres pressed by one stroke, one a little behind the other as the tool rolls.
Tool tool_at(double time_s) {
  const double rate = 2.0 * std::numbers::pi * 2.0, roll = 0.3 * std::sin(3.0 * rate * time_s);
  return {.position_m = {0, 0, 5_mm + 8_mm * std::cos(rate * time_s)},
          .orientation = quat_from_rotation_vector({roll, 0, 0}),
          .velocity_mps = {0, 0, -8_mm * rate * std::sin(rate * time_s)},
          .angular_velocity_radps = {0.9 * rate * std::cos(3.0 * rate * time_s), 0, 0}};
}

TEST(ContactDamping, TakesEnergyFromEverySphereInEveryTickAndNeverPulls) {
  for (const bool coupled : {false, true}) {
    Bench elastic(0.0, coupled), damped(20.0, coupled);
    double taken_J = 0.0;
    bool let_go = false;
    for (int i = 0; i < 1000; ++i) {
      const Tool tool = tool_at(i * kTick_s);
      for (Bench* bench : {&elastic, &damped}) bench->contact.detect_contact(tool);
      const Wrench plain = elastic.contact.render_force(tool, true).wrench,
                   with = damped.contact.render_force(tool, true).wrench;
      const Vec3 added_N = with.force_N - plain.force_N,
                 added_Nm = with.torque_Nm - plain.torque_Nm;
      const double power_W =
          -dot(added_N, tool.velocity_mps) - dot(added_Nm, tool.angular_velocity_radps);
      EXPECT_GE(power_W, -1e-12) << "tick " << i;
      taken_J += power_W * kTick_s;
      for (std::size_t k = 0; k < 2; ++k) {
        const SphereContact &a = elastic.contact.contacts()[k], &b = damped.contact.contacts()[k];
        EXPECT_GE(dot(b.force_N, b.normal), 0.0) << "tick " << i;
        EXPECT_EQ(a.energy_J, b.energy_J) << "what is stored is not touched by it";
        let_go = let_go || (a.force_N.z > 0.0 && b.force_N == Vec3{});
      }
    }
    EXPECT_GT(taken_J, 1e-4);
    EXPECT_TRUE(let_go) << "a release faster than 1 / lambda";
  }
}

TEST(ContactDamping, PressesHarderTheFaster) {
  Bench damped(2.0);
  damped.contact.detect_contact({.position_m = {0, 0, 5_mm}});
  Tool tool{.position_m = {0, 0, 1_mm}, .velocity_mps = {0, 0, -0.1}};
  damped.contact.detect_contact(tool);
  const double fast_N = damped.contact.render_force(tool, true).wrench.force_N.z;
  tool.velocity_mps = {};
  damped.contact.detect_contact(tool);
  EXPECT_NEAR(fast_N / damped.contact.render_force(tool, true).wrench.force_N.z, 1.2, 1e-12);
}

/// A force that is set by hand, and a resistance that takes all of it away.
class SetForce final : public ContactLaw {
 public:
  double force_N = 0.0;

  ContactLawResponse respond(const Indentation&) RT_SAFE override {
    return {.law = {.force_N = force_N, .stiffness_N_per_m = 40.0}};
  }
  double resistance_N(const Indentation&, double answer_N) const RT_SAFE override {
    return -answer_N;
  }
  double stiffest_N_per_m(const SurfacePoint&, bool) const RT_SAFE override { return 40.0; }
  void leave(std::size_t) RT_SAFE override {}
  void advance() RT_SAFE override {}
  std::size_t profile(const Indentation&, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 0.0; }
};

TEST(ContactDamping, DoesNotPullInWhileTheForceFollowsAJump) {
  Bench bench(0.0);
  SetForce law;
  Contact contact({.law = &law,
                   .parameters = {.tear_force_N = 0.6},
                   .spheres = bench.spheres,
                   .surface = bench.mesh.view(),
                   .tree = bench.tree.view(),
                   .blade = {}});
  const auto force_N = [&](double z_m) {
    contact.detect_contact({.position_m = {0, 0, z_m}});
    return contact.render_force({.position_m = {0, 0, z_m}}, true).wrench.force_N.z;
  };
  force_N(5_mm);
  law.force_N = 0.1;
  EXPECT_NEAR(force_N(2_mm), 0.0, 1e-12);
  law.force_N = 1.0;  // at rest
  for (int i = 0; i < 120; ++i) ASSERT_GE(force_N(2_mm), -1e-12) << i;
}

}  // namespace tact::model::contact::contact_damping_test
