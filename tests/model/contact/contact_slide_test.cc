// SPDX-License-Identifier: Apache-2.0
// Tissue that is dragged along by the stiffness of its own: MC-5.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/contact/contact.h"
#include "model/units.h"
#include "tests/support/shapes.h"
#include "tests/support/soft_half_space.h"

namespace tact::model::contact::contact_slide_test {

constexpr double kRadius_m = 4_mm, kNu = 0.45, kShear_Pa = 5000.0 / (2.0 * (1.0 + kNu));

class Slide : public testing::Test {
 protected:
  Wrench render_at(const Vec3& moved_m, double grip_ratio = 0.0) {
    const Tool tool{.position_m = Vec3{0, 0, kRadius_m} + moved_m, .grip_ratio = grip_ratio};
    contact.detect_contact(tool);
    return contact.render_force(tool, false).wrench;
  }
  void press(double from_m, double to_m, double x_m = 0.0) {
    for (int i = 0; i <= 400; ++i) render_at({x_m, 0, -from_m - (to_m - from_m) * i / 400.0});
  }
  /// Of a round contact.
  static double stiffness_N_per_m(double radius_m) {
    return 8.0 * kShear_Pa * radius_m / (2.0 - kNu);
  }
  double indentation_m() const { return contact.contacts()[0].indentation_m; }
  double along_J() const {
    const SphereContact& sphere_contact = contact.contacts()[0];
    return 0.5 * norm(tangential(sphere_contact.force_N, sphere_contact.normal)) *
           norm(sphere_contact.shift_m);
  }

  tests::SoftHalfSpace tissue;
  mesh::SurfaceMesh mesh = tests::make_plate(160_mm, 32);
  TriangleTree tree = make_triangle_tree(mesh.view());
  ProbeSphere sphere{{}, kRadius_m};
  Contact contact{{.law = &tissue.field,
                   .parameters = {.friction_ratio = 5.0, .tear_force_N = 0.3},
                   .spheres = {&sphere, 1},
                   .surface = mesh.view(),
                   .tree = tree.view(),
                   .blade = {}}};
};

TEST_F(Slide, ATouchingSphereIsHeldBackByTheContactThatItMakes) {
  press(-1_mm, 2_mm);
  const double own = stiffness_N_per_m(std::sqrt(kRadius_m * indentation_m()));
  const double rendered_N = -render_at({0.5_mm, 0, -2_mm}).force_N.x;
  EXPECT_NEAR(rendered_N, own * 0.5_mm, 0.01 * own * 0.5_mm) << "in steps of 1 %";
}

TEST_F(Slide, ADeeperContactKeepsItsForceAlongTheSurfaceAndLosesEnergy) {
  press(-1_mm, 1_mm);
  const double before_N = render_at({0.4_mm, 0, -1_mm}).force_N.x, before_J = along_J();
  press(1_mm, 3_mm, 0.4_mm);
  const double after_N = render_at({0.4_mm, 0, -3_mm}).force_N.x;
  EXPECT_NEAR(after_N, before_N, 1e-9);
  EXPECT_LT(along_J(), 0.7 * before_J);
  const double deep_N = render_at({0.5_mm, 0, -3_mm}).force_N.x;
  press(3_mm, 2.9_mm, 0.5_mm);
  EXPECT_NEAR(render_at({0.5_mm, 0, -2.9_mm}).force_N.x, deep_N, 1e-9) << "a hand trembles";
}

TEST_F(Slide, HeldTissueTearsWhereItsOwnStiffnessSays) {
  press(-1_mm, 2_mm);
  double x_m = 0.0;
  for (render_at({0, 0, -2_mm}, 1.0); contact.contacts()[0].state == ContactState::kHeld;
       render_at({x_m, 0, -2_mm}, 1.0))
    x_m += 0.01_mm;
  EXPECT_NEAR(x_m, 0.3 / stiffness_N_per_m(kRadius_m), 0.1_mm);
}

TEST_F(Slide, AStiffnessOfTheSceneCountsBeforeTheTissuesOwn) {
  Contact fixed({.law = &tissue.field,
                 .parameters = {.friction_ratio = 5.0,
                                .sliding_stiffness_N_per_m = 100.0,
                                .tear_force_N = 0.3},
                 .spheres = {&sphere, 1},
                 .surface = mesh.view(),
                 .tree = tree.view(),
                 .blade = {}});
  Wrench rendered;
  for (const Vec3& at : {Vec3{0, 0, kRadius_m}, Vec3{0, 0, 2_mm}, Vec3{0.1_mm, 0, 2_mm}}) {
    fixed.detect_contact({.position_m = at});
    rendered = fixed.render_force({.position_m = at}, false).wrench;
  }
  EXPECT_NEAR(rendered.force_N.x, -100.0 * 0.1_mm, 1e-9);
}

/// Tissue with a grain: soft along it, stiff across, the grain turning from triangle to triangle.
class Grained final : public ContactLaw {
 public:
  explicit Grained(double turn_rad) : turn_rad_(turn_rad) {}

  ContactLawResponse respond(const Indentation& in) RT_SAFE override {
    return tissue_.field.respond(in);
  }
  TangentCompliance tangent_compliance(const SurfacePoint& surface_point, bool,
                                       const Axes& axes) const RT_SAFE override {
    const double angle_rad = turn_rad_ * surface_point.triangle;
    const Vec2 grain = axes.of({std::cos(angle_rad), std::sin(angle_rad), 0.0});
    constexpr double kAlong = 0.08, kAcross = 0.02, kMore = kAlong - kAcross;  // m/N
    return {.rest_m_per_N = {.xx = kAcross + kMore * grain.x * grain.x,
                             .xy = kMore * grain.x * grain.y,
                             .yy = kAcross + kMore * grain.y * grain.y}};
  }
  void leave(std::size_t) RT_SAFE override {}
  void advance() RT_SAFE override {}
  std::size_t profile(const Indentation&, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 0.0; }

 private:
  tests::SoftHalfSpace tissue_;
  double turn_rad_ = 0.0;
};

class Grain : public Slide {
 protected:
  Contact contact_with(ContactLaw& law, double friction_ratio) const {
    return Contact({.law = &law,
                    .parameters = {.friction_ratio = friction_ratio, .tear_force_N = 10.0},
                    .spheres = {&sphere, 1},
                    .surface = mesh.view(),
                    .tree = tree.view(),
                    .blade = {}});
  }
  static Wrench render_at(Contact& contact, const Vec3& centre_m) {
    contact.detect_contact({.position_m = centre_m});
    return contact.render_force({.position_m = centre_m}, false).wrench;
  }
};

TEST_F(Grain, EachDirectionHasAStiffnessOfItsOwn) {
  Grained law(0.0);
  Contact dragged = contact_with(law, 10.0);
  render_at(dragged, {0, 0, kRadius_m + 1_mm});
  render_at(dragged, {0, 0, kRadius_m - 3_mm});
  const Wrench rendered = render_at(dragged, {0.4_mm, 0.3_mm, kRadius_m - 3_mm});
  EXPECT_NEAR(rendered.force_N.x, -0.4_mm / 0.08, 1e-12);
  EXPECT_NEAR(rendered.force_N.y, -0.3_mm / 0.02, 1e-12);
}

TEST_F(Grain, SteadySlidingIsOpposedAlongItsOwnDirection) {
  Grained law(0.0);
  Contact rubbed = contact_with(law, 0.3);
  render_at(rubbed, {0, 0, kRadius_m + 1_mm});
  Wrench rendered;
  for (int i = 0; i <= 3000; ++i)
    rendered = render_at(rubbed, {0.006_mm * i, 0.008_mm * i, kRadius_m - 3_mm});
  const double cap_N = 0.3 * rendered.force_N.z;
  EXPECT_NEAR(rendered.force_N.x, -0.6 * cap_N, 1e-3 * cap_N);
  EXPECT_NEAR(rendered.force_N.y, -0.8 * cap_N, 1e-3 * cap_N);
}

// MC-9 for slips of any length: the force is at its cap, parallel to the slip, and energy is lost.
TEST_F(Grain, OneSlipLosesEnergyAlongItsOwnForce) {
  Grained law(0.0);
  for (int k = 1; k <= 200; ++k) {
    Contact jerked = contact_with(law, 0.3);
    render_at(jerked, {0, 0, kRadius_m + 1_mm});
    render_at(jerked, {0, 0, kRadius_m - 3_mm});
    const double length_m = 0.05_mm * k, angle_rad = 0.7 * k;
    const Vec2 moved_m{length_m * std::cos(angle_rad), length_m * std::sin(angle_rad)};
    const Vec3 centre_m{moved_m.x, moved_m.y, kRadius_m - 3_mm};
    const Vec3 force_N = -render_at(jerked, centre_m).force_N;
    const double cap_N = -0.3 * force_N.z,
                 spring_N = std::hypot(moved_m.x / 0.08, moved_m.y / 0.02);
    const Vec2 f_N{force_N.x, force_N.y};
    const Vec2 slip_m = moved_m - Vec2{0.08 * f_N.x, 0.02 * f_N.y};
    if (!(spring_N > cap_N)) continue;
    EXPECT_NEAR(norm(f_N), cap_N, 1e-12) << k;
    const double before_J = 0.5 * (moved_m.x * moved_m.x / 0.08 + moved_m.y * moved_m.y / 0.02);
    EXPECT_LE(0.5 * (0.08 * f_N.x * f_N.x + 0.02 * f_N.y * f_N.y), before_J) << k;
    EXPECT_GT(dot(f_N, slip_m), 0.999 * norm(f_N) * norm(slip_m)) << k << ": parallel";
  }
}

TEST_F(Grain, ClosedStrokeOverVaryingGrainReturnsNoEnergy) {
  Grained law(1.3);
  for (int k = 0; k < 20; ++k) {
    Contact moved = contact_with(law, 1.0 + 0.3 * k);
    double work_J = 0.0;
    Vec3 at_m{0, 0, kRadius_m + 1_mm};
    Wrench before = render_at(moved, at_m);
    for (int i = 1; i <= 8000; ++i) {
      const double p = 2.0 * std::numbers::pi * i / 8000.0;
      const Vec3 next_m{(6_mm + 0.3_mm * k) * std::sin(2 * p), 8_mm * std::sin(p),
                        kRadius_m + 1_mm - 5_mm * (1 - std::cos(p)) / 2};
      const Wrench rendered = render_at(moved, next_m);
      work_J += 0.5 * dot(rendered.force_N + before.force_N, next_m - at_m);
      at_m = next_m;
      before = rendered;
      ASSERT_LE(work_J + moved.contacts()[0].energy_J, 2e-8) << k << ", tick " << i;
    }
    EXPECT_LT(work_J, -1e-6) << "rubbing costs energy";
  }
}

}  // namespace tact::model::contact::contact_slide_test
