// SPDX-License-Identifier: Apache-2.0
#include "model/contact/moved_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "model/contact/contact.h"
#include "model/contact/fair_surface.h"
#include "model/contact/rotation.h"
#include "model/indent/compliance_law.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::moved_contact_test {

constexpr double kRadius_m = 4_mm, kE_Pa = 5000.0, kNu = 0.45;

/// A body whose compliance is the same tensor everywhere, times E, with a slope along x.
struct Body {
  Body(mesh::SurfaceMesh m, const std::array<float, 6>& times_E_per_m, float slope_times_E_per_m2)
      : mesh(std::move(m)), corner(fair_corners(mesh.view())), compliance(mesh.vertex_m.size()) {
    for (std::size_t v = 0; v < compliance.size(); ++v)
      for (std::size_t k = 0; k < 6; ++k) {
        const auto x_m = static_cast<float>(mesh.vertex_m[v].x);
        const float slope = k < 3 ? slope_times_E_per_m2 : 0.0F;
        compliance[v].times_E_per_m[k] = times_E_per_m[k] + slope * x_m;
        compliance[v].slope_step_times_E_per_m2 = slope_times_E_per_m2;
        compliance[v].slope_steps[k] = {static_cast<std::int16_t>(k < 3), 0, 0};
      }
  }
  SmoothSurface surface() const { return {mesh.view(), corner, compliance, kE_Pa}; }
  ContactScene scene(double friction_ratio = 0.0) {
    organ = {.surface = surface(),
             .contact_modulus_Pa = kE_Pa / (1.0 - kNu * kNu),
             .poisson_ratio = kNu,
             .held_N_per_m = 100.0,
             .range_m = 12_mm,
             .creep = {}};
    return {.law = &field,
            .parameters = {.friction_ratio = friction_ratio, .tear_force_N = 1.0},
            .spheres = spheres,
            .surface = mesh.view(),
            .tree = tree.view(),
            .organ = &organ,
            .blade = {}};
  }

  mesh::SurfaceMesh mesh;
  std::vector<SurfaceCorner> corner;
  std::vector<VertexCompliance> compliance;
  std::vector<double> flat{0.0};
  indent::ComplianceCurve tip = *indent::make_compliance_curve(
      {.tip = {.youngs_modulus_Pa = kE_Pa, .poisson_ratio = kNu, .radius_m = kRadius_m},
       .working_depth_m = 12_mm,
       .ring_pitch_m = 2_mm,
       .ring_m_per_N = flat});
  std::array<const law::Law*, 1> curve{&tip};
  tissue::ElasticField field{{.curves = curve,
                              .coordinate = {},
                              .pull_coordinate = {},
                              .surface = mesh.view(),
                              .relaxation = {}}};
  TriangleTree tree = make_triangle_tree(mesh.view());
  BendingOrgan organ;
  std::vector<ProbeSphere> spheres{{{}, kRadius_m}};
};

Body rigid_plate() { return {tests::make_plate(100_mm, 20), {}, 0.0F}; }

Wrench render_force(Contact& contact, const Tool& tool) {
  contact.detect_contact(tool);
  return contact.render_force(tool, false).wrench;
}
Wrench glide(Contact& contact, const Vec3& from_m, const Vec3& to_m, double grip_ratio = 0.0) {
  Wrench out;
  for (int i = 0; i <= 200; ++i)
    out = render_force(
        contact, {.position_m = from_m + (i / 200.0) * (to_m - from_m), .grip_ratio = grip_ratio});
  return out;
}
/// From 5 mm over the middle of a plate.
Wrench pressed(Contact& contact, double depth_m) {
  return glide(contact, {1_mm, 2_mm, kRadius_m + 5_mm}, {1_mm, 2_mm, kRadius_m - depth_m});
}

TEST(MovedContact, OnARigidPlateIsTheLawOfTheTip) {
  Body body = rigid_plate();
  Contact contact(body.scene());
  const Wrench w = pressed(contact, 3_mm);
  EXPECT_NEAR(w.force_N.z, body.tip.respond(3_mm).force_N, 1e-9);
  EXPECT_NEAR(norm(tangential(w.force_N, {0, 0, 1})), 0.0, 1e-9);
  EXPECT_TRUE(contact.moved().status().is_solved);
  EXPECT_FALSE(contact.moved().status().is_fixed);
}

// d = d_tip(F) + r F, r = 50 / E.
TEST(MovedContact, OnAFlatOrganIsTipAndOrganInSeries) {
  Body body(tests::make_plate(100_mm, 20), {0, 0, 50, 0, 0, 0}, 0.0F);
  Contact contact(body.scene());
  const double force_N = pressed(contact, 4_mm).force_N.z;
  EXPECT_NEAR(body.tip.respond(4_mm - 50.0 / kE_Pa * force_N).force_N, force_N, 1e-4);
  EXPECT_GT(force_N, 0.01);
}

TEST(MovedContact, FrictionHoldsUpToCoulombsCone) {
  Body body = rigid_plate();
  Contact contact(body.scene(0.4));
  const double press_N = pressed(contact, 3_mm).force_N.z;
  const Vec3 at_m{1_mm, 2_mm, kRadius_m - 3_mm};
  const Wrench little = glide(contact, at_m, at_m + Vec3{0.05_mm, 0, 0});
  EXPECT_LT(little.force_N.x, 0.0);
  EXPECT_GT(little.force_N.x, -0.4 * press_N);
  const Wrench far = glide(contact, at_m + Vec3{0.05_mm, 0, 0}, at_m + Vec3{10_mm, 0, 0});
  EXPECT_NEAR(far.force_N.x, -0.4 * press_N, 1e-3 * press_N);
  EXPECT_NEAR(far.force_N.z, press_N, 1e-3 * press_N);
}

TEST(MovedContact, HoldingKeepsTheForceAndPullsBack) {
  Body body(tests::make_plate(100_mm, 20), {50, 50, 50, 0, 0, 0}, 500.0F);
  Contact contact(body.scene(0.4));
  const Vec3 at_m{1_mm, 2_mm, kRadius_m - 2_mm};
  pressed(contact, 2_mm);
  const Vec3 before_N = glide(contact, at_m, at_m + Vec3{0.5_mm, 0, 0}).force_N;
  const Tool held{.position_m = at_m + Vec3{0.5_mm, 0, 0}, .grip_ratio = 1.0};
  render_force(contact, held);  // from the next tick on it is held
  const Vec3 after_N = render_force(contact, held).force_N;
  EXPECT_LT(norm(after_N - before_N), 1e-4);
  const Vec3 up_m = at_m + Vec3{0.5_mm, 0, 4_mm};
  EXPECT_LT(glide(contact, at_m + Vec3{0.5_mm, 0, 0}, up_m, 1.0).force_N.z, -0.01) << "pulls back";
  EXPECT_EQ(norm(render_force(contact, {.position_m = up_m}).force_N), 0.0)
      << "let go, it does not";
}

// Dragged 12 mm towards where the organ is stiffer.
TEST(MovedContact, LettingGoStoresNoMoreThanWasHeld) {
  Body body(tests::make_plate(100_mm, 20), {400, 400, 400, 0, 0, 0}, -8000.0F);
  Contact contact(body.scene(0.4));
  pressed(contact, 3_mm);
  const Vec3 at_m{1_mm, 2_mm, kRadius_m - 3_mm}, there_m = at_m + Vec3{-12_mm, 0, -2_mm};
  render_force(contact, {.position_m = at_m, .grip_ratio = 1.0});
  glide(contact, at_m, there_m, 1.0);
  ASSERT_EQ(contact.contacts()[0].state, ContactState::kHeld);
  const double held_J = contact.contacts()[0].energy_J;
  render_force(contact, {.position_m = there_m});
  ASSERT_EQ(contact.contacts()[0].state, ContactState::kInContact);
  EXPECT_LE(contact.contacts()[0].energy_J, held_J);
  EXPECT_GT(contact.contacts()[0].energy_J, 0.0);
}

TEST(MovedContact, ContactBeginsWithTheDepthOfTheWayAndKeepsTheOffset) {
  Body body = rigid_plate();
  const ContactScene scene = body.scene();
  MovedContact moved(scene);
  const Sphere sphere{.radius_m = kRadius_m, .centre_m = {1_mm, 2_mm, kRadius_m - 3_mm}};
  ContactPoint contact_point;
  contact_point.surface_point.triangle = 20U * 20U;
  moved.begin(sphere, contact_point, 0.5_mm);
  moved.move(sphere);
  moved.respond();
  EXPECT_NEAR(moved.find(0)->depth_offset_m, 2.5_mm, 1e-6);
  EXPECT_NEAR(moved.find(0)->force_N.z, body.tip.respond(0.5_mm).force_N, 1e-6);
}

// Tip and organ in series, of one material: half of the force is left.
TEST(MovedContact, HeldDepthRelaxesAsTheMaterialDoes) {
  const std::vector<law::PronyTerm> terms{{.share = 0.5, .time_s = 0.05}};
  const law::Relaxation relaxation = *law::make_relaxation(terms, 1e-3);
  Body body(tests::make_plate(100_mm, 20), {0, 0, 200, 0, 0, 0}, 0.0F);
  tissue::ElasticField field({.curves = body.curve,
                              .coordinate = {},
                              .pull_coordinate = {},
                              .surface = body.mesh.view(),
                              .relaxation = relaxation});
  const auto held_N = [&](bool relaxes) {
    ContactScene scene = body.scene();
    body.organ.creep = relaxes ? law::Creep(relaxation) : law::Creep();
    if (relaxes) scene.law = &field;
    Contact contact(scene);
    Wrench last = pressed(contact, 4_mm);
    for (int i = 0; i < 1000; ++i) last = render_force(contact, {.position_m = {1_mm, 2_mm, 0}});
    return last.force_N.z;
  };
  EXPECT_NEAR(held_N(true) / held_N(false), 0.5, 0.005);
}

TEST(MovedContact, DoesNotAllocate) {
  Body body(tests::make_ball(40_mm, 3), {30, 40, 50, 1, 2, 3}, 900.0F);
  body.spheres = {{{-4_mm, 0, 0}, kRadius_m}, {{4_mm, 0, 0}, kRadius_m}};
  Contact contact(body.scene(0.4));
  const tests::NoAlloc guard;
  for (int i = 0; i <= 500; ++i) {
    const double t = i / 500.0;
    render_force(contact, {.position_m = {5_mm * t, 3_mm * t, 50_mm - 12_mm * t},
                           .orientation = quat_from_rotation_vector({0.2 * t, 0, 0.1 * t}),
                           .grip_ratio = i > 400 && i < 490 ? 1.0 : 0.0});
  }
  EXPECT_EQ(guard.calls(), 0U);
  EXPECT_GT(norm(contact.moved().organ().sphere[0].slope), 0.0) << "it has leaned";
}

// -d/dt of load . (Q^k shift + Q arm), by differences.
TEST(Rotation, MomentIsTheSlopeOfTheLoadsWork) {
  constexpr double kChord = 0.4, kMove = 1e-6;
  const Vec3 n = normalized(Vec3{0.3, -0.5, 0.9}), shift_m{0.01, 0.02, -0.03}, arm_m{0.02, 0, 0.01};
  const Vec3 load_N{0.3, 0.2, -0.5}, e1 = normalized(cross(n, {1, 0, 0})), e2 = cross(n, e1);
  for (const double tangent : {1e-4, 0.02, 0.4, 1.5}) {
    const Vec3 t = tangent * normalized(e1 + 0.7 * e2);
    const auto work_J = [&](const Vec3& slope) {
      const Rotation q = rotation_of_slope(n, slope, kChord);
      return dot(load_N, rotated(q.chord, q.axis, shift_m) + rotated(q.whole, q.axis, arm_m));
    };
    const Rotation q = rotation_of_slope(n, t, kChord);
    const Vec3 moment_Nm = moment_on_slope(q, kChord, load_N, rotated(q.chord, q.axis, shift_m),
                                           rotated(q.whole, q.axis, arm_m));
    for (const Vec3& e : {e1, e2}) {
      const double slope_Nm = (work_J(t + kMove * e) - work_J(t - kMove * e)) / (2.0 * kMove);
      EXPECT_NEAR(dot(moment_Nm, e), -slope_Nm, 1e-9) << tangent;
    }
  }
}

TEST(SmoothSurface, IsContinuousOverEveryEdge) {
  Body body(tests::make_ball(40_mm, 2), {30, 40, 50, 1, 2, 3}, 900.0F);
  const SmoothSurface surface = body.surface();
  const auto frame_of = [&](const SurfacePoint& surface_point) {
    SurfaceFrame f;
    f.surface_point = surface_point;
    fill_geometry(surface, f);
    fill_compliance(surface, f);
    return f;
  };
  for (std::uint32_t t = 0; t < body.mesh.triangle.size(); ++t)
    for (std::size_t e = 0; e < 3; ++e) {
      SurfacePoint here{.triangle = t, .weight = {}},
          there{.triangle = body.mesh.neighbour[t][e], .weight = {}};
      const std::size_t end = (e + 1) % 3;
      here.weight[e] = 0.3, here.weight[end] = 0.7;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = body.mesh.triangle[there.triangle][k];
        if (v == body.mesh.triangle[t][e]) there.weight[k] = 0.3;
        if (v == body.mesh.triangle[t][end]) there.weight[k] = 0.7;
      }
      const SurfaceFrame a = frame_of(here), b = frame_of(there);
      ASSERT_LT(norm(a.point_m - b.point_m), 1e-14);
      ASSERT_LT(norm(a.normal - b.normal), 1e-14);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(norm(a.compliance_m_per_N.row[k] - b.compliance_m_per_N.row[k]), 1e-14);
        ASSERT_LT(norm(a.slope_per_N.row[k] - b.slope_per_N.row[k]), 1e-14);
      }
    }
}

// As large as the mesh, and the normal across the surface: n . dx is of second order.
TEST(SmoothSurface, SmoothedBallKeepsTheSizeOfItsMesh) {
  Body body(tests::make_ball(40_mm, 3), {}, 0.0F);
  double smooth_m = 0.0, flat_m = 0.0, tilt = 0.0;
  for (std::uint32_t t = 0; t < body.mesh.triangle.size(); ++t) {
    for (const std::array<double, 3>& w :
         {std::array{0.6, 0.2, 0.2}, std::array{0.2, 0.6, 0.2}, std::array{0.2, 0.2, 0.6}}) {
      SurfaceFrame f;
      f.surface_point = {.triangle = t, .weight = w};
      fill_geometry(body.surface(), f);
      const auto& corner_m = body.mesh.view().record[t].corner_m;
      smooth_m += norm(f.point_m);
      flat_m += norm(w[0] * corner_m[0] + w[1] * corner_m[1] + w[2] * corner_m[2]);
      for (const Vec3& along : f.point_m_per_m)
        tilt = std::max(tilt, std::abs(dot(f.normal, normalized(along))));
    }
  }
  EXPECT_NEAR(smooth_m / flat_m, 1.0, 1e-3);
  EXPECT_LT(tilt, 0.02) << "of the flat triangles: up to 0.1";
}

}  // namespace tact::model::contact::moved_contact_test
