// SPDX-License-Identifier: Apache-2.0
// What a surface of springs and anchors gives way, by its closed forms and by its own network.
#include "model/springs/patch_surface.h"

#include <gtest/gtest.h>

#include <vector>

#include "model/springs/spring_network.h"
#include "tests/model/springs/patch_fixture.h"

namespace tact::model::springs::patch_surface_test {

constexpr std::uint32_t kSide = 41;

/// Equal triangles of this edge, one row a line, in z = 0.
mesh::SurfaceMesh make_net(double edge_m) {
  std::vector<Vec3> vertex_m;
  std::vector<contact::TriangleCorners> triangle;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x)
      vertex_m.push_back({edge_m * (x - 0.5 * y), edge_m * 0.5 * std::sqrt(3.0) * y, 0.0});
  for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t v = y * kSide + x;
      triangle.push_back({v, v + 1, v + kSide + 1});
      triangle.push_back({v, v + kSide + 1, v + kSide});
    }
  return *mesh::make_surface_mesh(vertex_m, triangle);
}

/// How far 1 mN moves the middle vertex of the whole net along itself, per N.
double compliance_of_the_net_m_per_N(const PatchSurface& surface, const Vec3& force_N) {
  const std::size_t n = surface.mesh.vertex_m.size(), middle = n / 2;
  const std::vector<Vec3> rest(surface.mesh.vertex_m.begin(), surface.mesh.vertex_m.end());
  std::vector<Vec3> at = rest, velocity(n), load = surface.load_N;
  load[middle] += force_N;
  const double k = surface.tissue.surface_stiffness_N_per_m;
  std::vector<Spring> springs;
  for (const PatchEdge& e : surface.edge)
    springs.push_back({e.a, e.b, k, 0.001 * k, surface.rest_length_m(e)});
  const std::vector<double> inverse(n, 1000.0), drag(n, 0.02);
  const SpringNetwork net{.node = {at, velocity, rest, load, inverse, surface.anchor_N_per_m, drag},
                          .spring = springs,
                          .probe = {}};
  SpringStepper stepper(n, springs.size());
  for (int i = 0; i < 100; ++i)
    stepper.step(net, {.method = {Integrator::kImplicitEuler, 0.5}, .step_s = 0.05});
  return dot(at[middle] - rest[middle], force_N) / dot(force_N, force_N);
}

TEST(PatchSurface, GivesWaySidewaysAsItsNetDoes) {
  const mesh::SurfaceMesh mesh = make_net(0.004);
  for (const double p : {0.0, 0.4}) {
    for (const double a : {4.0, 40.0}) {
      const PatchTissue tissue{
          .surface_stiffness_N_per_m = 20.0, .body_stiffness_N_per_m = a, .pretension_ratio = p};
      const PatchSurface surface = make_patch_surface(mesh.view(), tissue);
      const std::size_t middle = mesh.vertex_m.size() / 2;
      const double want = compliance_of_the_net_m_per_N(surface, {0.0004, 0.0003, 0.0});
      EXPECT_NEAR(surface.sideways_m_per_N[middle], want, 0.1 * want) << p << ", " << a;
    }
  }
}

}  // namespace tact::model::springs::patch_surface_test
