// SPDX-License-Identifier: Apache-2.0
// The peers on a small block: each is held, gives what theory or the fit asks, and is not crippled.
#include "tools/chart/peers/chart_peers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "model/indent/compliance_tip.h"
#include "tests/support/test_scene.h"

namespace tact::tools::chart::chart_peers_test {

using model::Vec3;

constexpr double kRadius_m = 0.004;
constexpr double kE_Pa = 5000.0, kNu = 0.45;

/// A closed box of cubes' faces, 60 x 60 x 40 mm, top at z = 0.
model::mesh::SurfaceMesh make_box() {
  constexpr int kX = 10, kZ = 6;  // cells
  constexpr double kCell_m = 0.006;
  std::map<std::array<int, 3>, std::uint32_t> number;
  std::vector<Vec3> vertices;
  std::vector<model::contact::TriangleCorners> triangles;
  const auto at = [&](int x, int y, int z) {
    const auto [entry, is_new] =
        number.try_emplace({x, y, z}, static_cast<std::uint32_t>(vertices.size()));
    if (is_new)
      vertices.push_back({(x - kX / 2) * kCell_m, (y - kX / 2) * kCell_m, (z - kZ) * kCell_m});
    return entry->second;
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  };
  for (int i = 0; i < kX; ++i)
    for (int j = 0; j < kX; ++j) {
      quad(at(i, j, kZ), at(i + 1, j, kZ), at(i + 1, j + 1, kZ), at(i, j + 1, kZ));
      quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
    }
  for (int i = 0; i < kX; ++i)
    for (int k = 0; k < kZ; ++k) {
      quad(at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1));
      quad(at(i, kX, k), at(i, kX, k + 1), at(i + 1, kX, k + 1), at(i + 1, kX, k));
      quad(at(0, i, k), at(0, i, k + 1), at(0, i + 1, k + 1), at(0, i + 1, k));
      quad(at(kX, i, k), at(kX, i + 1, k), at(kX, i + 1, k + 1), at(kX, i, k + 1));
    }
  return *model::mesh::make_surface_mesh(vertices, triangles);
}

class Peers : public testing::Test {
 protected:
  Peers() {
    scene_.organ_mesh = make_box();
    scene_.elastic = model::scene::ElasticSettings{.youngs_modulus_Pa = kE_Pa,
                                                   .poisson_ratio = kNu,
                                                   .fixed_min_m = {-1, -1, -1},
                                                   .fixed_max_m = {1, 1, -0.035}};
    ground_truth::SolvedSite site{.point_m = {0, 0, 0}, .direction = {0, 0, -1}, .cases = {}};
    for (std::uint32_t v = 0; v < scene_.organ_mesh.vertex_m.size(); ++v)
      if (norm(scene_.organ_mesh.vertex_m[v]) < 1e-9) site.vertex = v;
    for (const double depth_m : {0.002, 0.005})
      site.cases.push_back(
          {.depth_m = depth_m, .force_N = half_space_N(depth_m), .profile_m = {depth_m, 0.0, 0.0}});
    site.cases.push_back(
        {.depth_m = -0.005, .force_N = -kTip.pulled_stiffness_N_per_m() * 0.005, .profile_m = {}});
    reference_.tool_radius_m = kRadius_m;
    reference_.body.youngs_modulus_Pa = kE_Pa;
    reference_.body.poisson_ratio = kNu;
    reference_.body.fixed_min_m = scene_.elastic->fixed_min_m;
    reference_.body.fixed_max_m = scene_.elastic->fixed_max_m;
    reference_.ring_pitch_m = 0.006;
    reference_.sites = {site};
    const auto cases = cases_of(scene_, reference_);
    EXPECT_TRUE(cases) << cases.error().sentence;
    if (cases) cases_ = *cases;
  }

  static double half_space_N(double depth_m) {
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 60; ++i) {
      const double s = 0.5 * (low + high);
      (tip_state(kTip, s).depth_m < depth_m ? low : high) = s;
    }
    return tip_state(kTip, low).force_N;
  }
  PeerInput input() const { return {scene_, cases_}; }

  static constexpr model::indent::ElasticTip kTip{kE_Pa, kNu, kRadius_m};
  model::scene::Scene scene_ = tests::make_plate_scene();
  ground_truth::ReferenceData reference_;
  std::vector<ProbeCase> cases_;
};

TEST_F(Peers, HoldTheVerticesOfTheBoxAndNoOther) {
  const auto held = held_vertices(scene_);
  EXPECT_EQ(held.size(), 11U * 11U);  // the bottom; no side triangle lies in the box
  for (const std::uint32_t v : held) EXPECT_LT(scene_.organ_mesh.vertex_m[v].z, -0.035);
}

TEST_F(Peers, FitToTheDepthNearestToFiveMillimetres) {
  const auto fit = fit_cases(cases_);
  ASSERT_EQ(fit.size(), 1U);
  EXPECT_EQ(fit[0].in.dent_m, 0.005);
  EXPECT_EQ(mean_reference_N(fit), half_space_N(0.005));
}

TEST_F(Peers, FiniteElementsPressLikeAThickBlock) {
  // A block 36 mm thick on a rigid bottom is stiffer than the half-space by d(r F)/d: a few percent
  // at 2 mm, and never softer (RF-6: 7 % at 5 mm for 50 mm and R = 5 mm).
  auto peer = make_fem_peer(input(), 0.008);
  ASSERT_TRUE(peer) << peer.error().sentence;
  for (const ProbeCase& c : cases_) {
    const double ratio = (*peer)->tick(c.in) / c.reference_N;
    EXPECT_GT(ratio, 0.97) << c.in.dent_m;
    EXPECT_LT(ratio, 1.20) << c.in.dent_m;
    std::vector<double> ring_m(4);
    (*peer)->shape(c.in, 0.006, ring_m);
    EXPECT_EQ(ring_m[0], c.in.dent_m);
    EXPECT_GT(ring_m[1] * c.in.dent_m, 0.0);  // the surface beside follows
    EXPECT_LT(std::abs(ring_m[3]), std::abs(ring_m[1]));
  }
}

TEST_F(Peers, SpringsOfTheWholeMeshAreFittedAndReturnToRest) {
  auto peer = make_spring_peer(input(), 10);
  ASSERT_TRUE(peer) << peer.error().sentence;
  const auto fit = fit_cases(cases_);
  EXPECT_NEAR(mean_force_N(**peer, fit) / mean_reference_N(fit), 1.0, 0.02);
  (*peer)->release();
  std::vector<double> ring_m(3);
  (*peer)->shape(fit[0].in, 0.006, ring_m);
  for (const double u_m : ring_m) EXPECT_EQ(u_m, 0.0);
}

TEST_F(Peers, BulletIsFitted) {
  auto peer = make_bullet_peer(input(), false, 4);
  ASSERT_TRUE(peer) << peer.error().sentence;
  const auto fit = fit_cases(cases_);
  EXPECT_NEAR(mean_force_N(**peer, fit) / mean_reference_N(fit), 1.0, 0.05) << (*peer)->given();
}

}  // namespace tact::tools::chart::chart_peers_test
