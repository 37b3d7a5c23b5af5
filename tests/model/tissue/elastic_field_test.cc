// SPDX-License-Identifier: Apache-2.0
// A family of laws over a surface: one potential, felt along the normal and along the surface.
#include "model/tissue/elastic_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/contact/contact.h"
#include "model/units.h"
#include "tests/support/no_alloc.h"
#include "tests/support/shapes.h"

namespace tact::model::tissue::elastic_field_test {

class Spring final : public law::Law {
 public:
  explicit Spring(double k) : k_(k) {}
  law::LawResponse respond(double d) const RT_SAFE override {
    return {k_ * d, k_, 0.5 * k_ * d * d, law::LawStatus::kOk};
  }
  law::LawRange range() const RT_SAFE override { return {-0.02, 0.02}; }
  std::size_t profile(double d, std::span<double> ring_m) const RT_SAFE override {
    ring_m[0] = d;
    ring_m[1] = k_ * 1e-6;
    return 2;
  }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  double k_;
};

std::vector<float> wavy(const mesh::SurfaceMesh& mesh) {
  std::vector<float> kappa;
  for (const Vec3& v : mesh.vertex_m)
    kappa.push_back(static_cast<float>(1.0 + std::sin(90.0 * v.x) * std::cos(70.0 * v.y)));
  return kappa;
}

// Springs of 50, 100 and 200 N/m; kappa varies over the surface as a smooth function of the place.
struct Bench {
  explicit Bench(mesh::SurfaceMesh m) : mesh(std::move(m)), tree(make_triangle_tree(mesh.view())) {}
  contact::Contact contact() {
    return contact::Contact({.law = &field,
                             .parameters = {.sliding_stiffness_N_per_m = 0.0, .tear_force_N = 10.0},
                             .spheres = {&sphere, 1},
                             .surface = mesh.view(),
                             .tree = tree.view(),
                             .blade = {}});
  }
  mesh::SurfaceMesh mesh;
  contact::TriangleTree tree;
  contact::ProbeSphere sphere{{}, 4_mm};
  Spring soft{50.0}, middle{100.0}, stiff{200.0};
  std::array<const law::Law*, 3> curves{&soft, &middle, &stiff};
  std::vector<float> coordinate = wavy(mesh);
  ElasticField field{{.curves = curves,
                      .coordinate = coordinate,
                      .pull_coordinate = {},
                      .surface = mesh.view(),
                      .relaxation = {}}};
};

TEST(ElasticField, BlendsNeighbouringLawsByTheCoordinateOfThePlace) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 4);
  Spring soft(50.0), middle(100.0), stiff(200.0);
  const std::array<const law::Law*, 3> curves{&soft, &middle, &stiff};
  const std::vector<float> coordinate(plate.vertex_m.size(), 1.25f);
  ElasticField field({.curves = curves,
                      .coordinate = coordinate,
                      .pull_coordinate = {},
                      .surface = plate.view(),
                      .relaxation = {}});
  const contact::Indentation in{.surface_point = {.triangle = 3, .weight = {0.2, 0.3, 0.5}},
                                .indentation_m = 2e-3};
  const contact::ContactLawResponse r = field.respond(in);
  EXPECT_NEAR(r.law.force_N, (0.75 * 100.0 + 0.25 * 200.0) * 2e-3, 1e-12);
  EXPECT_NEAR(r.law.stiffness_N_per_m, 125.0, 1e-9);
  EXPECT_NEAR(norm(r.slope_N), 0.0, 1e-12) << "nothing varies along the surface";
  std::array<double, 4> ring_m{};
  EXPECT_EQ(field.profile(in, ring_m), 2u);
  EXPECT_NEAR(ring_m[1], 125e-6, 1e-12);
}

TEST(ElasticField, CoordinatesAtBothEndsGiveTheOutermostLaws) {
  const mesh::SurfaceMesh plate = tests::make_plate(100_mm, 4);
  Spring soft(50.0), stiff(200.0);
  const std::array<const law::Law*, 2> curves{&soft, &stiff};
  for (const float end : {0.0f, 1.0f}) {
    const std::vector<float> coordinate(plate.vertex_m.size(), end);
    ElasticField field({.curves = curves,
                        .coordinate = coordinate,
                        .pull_coordinate = {},
                        .surface = plate.view(),
                        .relaxation = {}});
    const auto r = field.respond(
        {.surface_point = {.triangle = 0, .weight = {1, 0, 0}}, .indentation_m = 1e-3});
    EXPECT_NEAR(r.law.force_N, end == 0.0f ? 0.05 : 0.2, 1e-9);
  }
}

// Force on the tool against the central difference of the energy, for a tool moved in x, y and z.
void expect_slope_of_energy(Bench& bench, const Vec3& at_m) {
  const auto render_force = [&bench](const Vec3& p_m, const Vec3& from_m) {
    contact::Contact contact = bench.contact();
    for (int i = 0; i <= 400; ++i)
      contact.detect_contact({.position_m = from_m + (i / 400.0) * (p_m - from_m)}),
          contact.render_force({}, false);
    contact.detect_contact({.position_m = p_m});
    const Wrench w = contact.render_force({.position_m = p_m}, false).wrench;
    return std::pair{w.force_N, contact.contacts()[0].energy_J};
  };
  const Vec3 outside_m = at_m + Vec3{0, 0, 10_mm};
  const double h = 1e-7;
  const auto [force_N, energy_J] = render_force(at_m, outside_m);
  const Vec3 axis[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
  const double part_N[3] = {force_N.x, force_N.y, force_N.z};
  for (int i = 0; i < 3; ++i) {
    const double ahead_J = render_force(at_m + axis[i], outside_m).second;
    const double behind_J = render_force(at_m - axis[i], outside_m).second;
    EXPECT_NEAR(-(ahead_J - behind_J) / (2.0 * h), part_N[i], 2e-5) << "axis " << i;
  }
  EXPECT_GT(energy_J, 0.0);
}

TEST(ElasticField, ForceOnTheToolIsTheSlopeOfOnePotentialAlongTheSurfaceToo) {
  Bench plate(tests::make_plate(100_mm, 10));
  expect_slope_of_energy(plate, {3.1_mm, 7.7_mm, 2_mm});
  expect_slope_of_energy(plate, {-22.3_mm, 11.9_mm, 1_mm});
  Bench ball(tests::make_ball(50_mm, 2));  // coarse: faces, edges and corners are all met
  for (const double x : {0.7_mm, 3.3_mm, 8.1_mm, 13.7_mm})
    expect_slope_of_energy(ball, {x, 0.4 * x, 51.5_mm - 0.3 * x});
}

/// Work of the hand over a closed stroke, and the size of its parts, J.
std::pair<double, double> closed_stroke_J(double deepest_m) {
  Bench bench(tests::make_ball(50_mm, 3));
  contact::Contact contact = bench.contact();
  const auto path = [deepest_m](double phase) {  // down, along a loop over the cap, up
    const double angle = 2.0 * std::numbers::pi * phase;
    const double r = 53.0_mm - deepest_m * std::sin(std::numbers::pi * phase);
    const Vec3 away{0.3 * std::sin(angle), 0.3 * (1.0 - std::cos(angle)), 1.0};
    return r / norm(away) * away + Vec3{0, 0, 1.5_mm};
  };
  double work_J = 0.0, size_J = 0.0;
  Vec3 before_m = path(0.0), before_N{};
  const int ticks = 40'000;
  for (int i = 0; i <= ticks; ++i) {
    const Vec3 at_m = path(static_cast<double>(i) / ticks);
    contact.detect_contact({.position_m = at_m});
    const Vec3 force_N = contact.render_force({.position_m = at_m}, false).wrench.force_N;
    const double part_J = -0.5 * dot(force_N + before_N, at_m - before_m);
    work_J += part_J;
    size_J += std::abs(part_J);
    before_m = at_m;
    before_N = force_N;
  }
  return {work_J, size_J};
}

TEST(ElasticField, AClosedStrokeOverSoftAndStiffPlacesReturnsNoEnergy) {
  const auto [work_J, size_J] = closed_stroke_J(1.0_mm);
  EXPECT_NEAR(work_J, 0.0, 1e-3 * size_J);
  EXPECT_GT(size_J, 1e-5);
}

// Where the centre crosses an edge of the ball's coarse facets the proxy lags: that takes some.
TEST(ElasticField, ClosedStrokeOverFacetEdgesReturnsNoEnergy) {
  const auto [work_J, size_J] = closed_stroke_J(4.0_mm);
  EXPECT_GE(work_J, -1e-3 * size_J);
  EXPECT_LE(work_J, 0.08 * size_J);
  EXPECT_GT(size_J, 1e-5);
}

TEST(ElasticField, NotANumberGivesZeroForceAndNoMemory) {
  Spring spring(100.0);
  const law::Law* curve = &spring;
  ElasticField field({.curves = {&curve, 1},
                      .coordinate = {},
                      .pull_coordinate = {},
                      .surface = {},
                      .relaxation = {}});
  const auto bad = field.respond({.indentation_m = std::nan("")});
  EXPECT_EQ(bad.law.status, law::LawStatus::kInvalid);
  EXPECT_EQ(bad.law.force_N, 0.0);
  field.advance();
  EXPECT_NEAR(field.respond({.indentation_m = 1e-3}).law.force_N, 0.1, 1e-12);
}

TEST(ElasticField, APlaceThatTheSurfaceDoesNotHaveGivesZeroForce) {
  Bench bench(tests::make_plate(100_mm, 4));
  const double nan = std::nan("");
  const auto triangles = static_cast<std::uint32_t>(bench.mesh.triangle.size());
  for (const contact::Indentation& in :
       {contact::Indentation{.surface_point = {}, .indentation_m = 1e-3},
        contact::Indentation{.surface_point = {triangles, {0.3, 0.3, 0.4}}, .indentation_m = 1e-3},
        contact::Indentation{.surface_point = {0, {nan, 0.5, 0.5}}, .indentation_m = 1e-3},
        contact::Indentation{.sphere = contact::kMaxSpheres,
                             .surface_point = {0, {0.3, 0.3, 0.4}},
                             .indentation_m = 1e-3}}) {
    const contact::ContactLawResponse r = bench.field.respond(in);
    EXPECT_EQ(r.law.status, law::LawStatus::kInvalid);
    EXPECT_EQ(r.law.force_N, 0.0);
    EXPECT_EQ(r.slope_N, Vec3{});
    std::array<double, 4> ring_m{};
    EXPECT_EQ(bench.field.profile(in, ring_m), 0u);
  }
}

TEST(ElasticField, LeavesTheHeapAlone) {
  Bench bench(tests::make_plate(100_mm, 10));
  const tests::NoAlloc guard;
  for (std::uint32_t t = 0; t < 50; ++t)
    (void)bench.field.respond(
        {.surface_point = {.triangle = t, .weight = {0.3, 0.3, 0.4}}, .indentation_m = 1e-3});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::model::tissue::elastic_field_test
