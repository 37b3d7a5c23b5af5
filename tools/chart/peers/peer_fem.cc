// SPDX-License-Identifier: Apache-2.0
// The full linear organ, solved once a tick with a factor made beforehand.
//
//     press  d = d_tip(a) + r F(a)            CL-1, CT-1, CT-2
//     pull   (C_reg + diag(c_disc, c_side, c_side)) f = (d, 0, 0)
//     r, C_reg   what the solve gives under a Hertz patch, less a half-space's under the same patch
//
// Each tick loads the patch around the nearest vertex (three loads while pulled) and substitutes
// back. The tip's own dent is exact, so the mesh need not resolve the contact: a plain nodal load
// would be less accurate at the same price. The patch is two mean edges wide or the contact.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "model/fem/hertz_load.h"
#include "model/fem/linear_solver.h"
#include "model/indent/compliance_law.h"
#include "model/indent/compliance_tip.h"
#include "tools/chart/peers/chart_peers.h"
#include "tools/condense/condense_organ.h"
#include "tools/ground_truth/gmsh.h"

namespace tact::tools::chart {
namespace {

using model::Result;
using model::Vec3;
using model::contact::Indentation;
using model::indent::ElasticTip;
namespace fem = model::fem;

constexpr double kPatchEdges = 2.0;

/// CL-1 at one depth.
model::indent::TipState pressed(const ElasticTip& tip, double regular_m_per_N, double depth_m) {
  double low = 0.0, high = 20.0;  // s of CT-1
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    const model::indent::TipState state = tip_state(tip, s);
    (state.depth_m + regular_m_per_N * state.force_N < depth_m ? low : high) = s;
  }
  return tip_state(tip, low);
}

class FemPeer final : public Subject {
 public:
  FemPeer(const model::scene::Scene& scene, fem::TetMesh body, fem::LinearSolver solver,
          double edge_m)
      : scene_(scene),
        body_(std::move(body)),
        boundary_(fem::find_boundary(body_)),
        solver_(std::move(solver)),
        material_{scene.elastic->youngs_modulus_Pa, scene.elastic->poisson_ratio},
        tip_{material_.youngs_modulus_Pa, material_.poisson_ratio, scene.tool.spheres[0].radius_m},
        patch_m_(kPatchEdges * condense::median_edge_m(scene.organ_mesh.view())),
        edge_m_(edge_m) {
    moved_m_.resize(solver_.nodes());
    dent_m_.resize(scene.organ_mesh.vertex_m.size());
    for (std::uint32_t v = 0; v < dent_m_.size(); ++v) surface_.push_back(v);
    for (auto& m : many_m_) m.resize(surface_.size());
  }

  double tick(const Indentation& in) override {
    const Vec3 inward = -in.normal;
    const auto weights = fem::hertz_weights(body_, boundary_, nearest_vertex(in.place), patch_m_);
    const double force_N = in.dent_m < 0.0 ? pull(in, inward, weights) : press(in, inward, weights);
    return force_N;
  }

  void release() override {}

  void shape(const Indentation& in, double pitch_m, std::span<double> ring_m) override {
    ring_means(scene_.organ_mesh.view(), in, pitch_m, dent_m_, ring_m);
    // Under the tip the exact dent, which the mesh does not resolve.
    if (!ring_m.empty()) ring_m[0] = in.dent_m;
  }

  bool is_stepped() const override { return false; }
  std::size_t memory_bytes() const override { return solver_.memory_bytes(); }
  std::string given() const override {
    return fmt::format(
        "E and nu of the scene; {} quadratic tetrahedra of {:g} mm; {} unknowns; one solve a tick; "
        "the tip's own dent exact",
        body_.element.size(), edge_m_ * 1e3, solver_.unknowns());
  }

 private:
  std::uint32_t nearest_vertex(const model::contact::Place& place) const {
    const auto c =
        std::max_element(place.weight.begin(), place.weight.end()) - place.weight.begin();
    return scene_.organ_mesh.triangle[place.triangle][static_cast<std::size_t>(c)];
  }

  double press(const Indentation& in, const Vec3& inward,
               const std::vector<fem::NodeWeight>& weights) {
    load_.clear();
    for (const auto& w : weights) load_.push_back({w.node, w.weight * inward});
    solver_.solve(load_, moved_m_);
    double given_m_per_N = 0.0;
    for (const auto& w : weights) given_m_per_N += w.weight * dot(moved_m_[w.node], inward);
    // Less what a half-space gives under the same patch: the tip's own dent is exact (CT-1).
    const double regular = given_m_per_N - fem::hertz_normal_m_per_N(material_, patch_m_);
    const double force_N = pressed(tip_, regular, in.dent_m).force_N;
    for (std::size_t v = 0; v < dent_m_.size(); ++v)
      dent_m_[v] = force_N * dot(moved_m_[v], inward);
    return force_N;
  }

  double pull(const Indentation& in, const Vec3& inward,
              const std::vector<fem::NodeWeight>& weights) {
    const Vec3 side = std::abs(inward.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 t1 = normalized(cross(inward, side));
    const std::array<Vec3, 3> axis{inward, t1, cross(inward, t1)};
    // C_pq = sum_a w_a e_p . u_a under the load e_q: every node that carries weight is asked
    wanted_ = surface_;
    for (const auto& w : weights) wanted_.push_back(w.node);
    for (std::size_t q = 0; q < 3; ++q) {
      loads_[q].clear();
      for (const auto& w : weights) loads_[q].push_back({w.node, w.weight * axis[q]});
      many_m_[q].resize(wanted_.size());
    }
    solver_.solve(loads_, wanted_, many_m_);
    Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
    for (Eigen::Index p = 0; p < 3; ++p)
      for (Eigen::Index q = 0; q < 3; ++q)
        for (std::size_t a = 0; a < weights.size(); ++a)
          give(p, q) +=
              weights[a].weight * dot(axis[static_cast<std::size_t>(p)],
                                      many_m_[static_cast<std::size_t>(q)][surface_.size() + a]);
    const double side_m_per_N = 1.0 / tip_.sideways_stiffness_N_per_m() -
                                fem::hertz_tangential_m_per_N(material_, patch_m_);
    give(0, 0) +=
        1.0 / tip_.pulled_stiffness_N_per_m() - fem::hertz_normal_m_per_N(material_, patch_m_);
    give(1, 1) += side_m_per_N;
    give(2, 2) += side_m_per_N;
    const Eigen::Vector3d f = give.ldlt().solve(Eigen::Vector3d(in.dent_m, 0.0, 0.0));
    for (std::size_t v = 0; v < dent_m_.size(); ++v) {
      dent_m_[v] = 0.0;
      for (std::size_t q = 0; q < 3; ++q)
        dent_m_[v] += f[static_cast<Eigen::Index>(q)] * dot(many_m_[q][v], inward);
    }
    return f[0];
  }

  const model::scene::Scene& scene_;
  fem::TetMesh body_;
  fem::Boundary boundary_;
  fem::LinearSolver solver_;
  fem::Elasticity material_;
  ElasticTip tip_;
  double patch_m_, edge_m_;
  std::vector<fem::NodeLoad> load_;
  std::array<std::vector<fem::NodeLoad>, 3> loads_;
  std::vector<std::uint32_t> surface_, wanted_;
  std::vector<Vec3> moved_m_;
  std::array<std::vector<Vec3>, 3> many_m_;
  std::vector<double> dent_m_;
};

}  // namespace

Result<std::unique_ptr<Subject>> make_fem_peer(const PeerInput& input, double edge_m) {
  const model::scene::Scene& scene = input.scene;
  if (!scene.elastic)
    return model::Error{scene.path + ": has no [elastic], which the peer fem needs; add it"};
  const auto& mesh = scene.organ_mesh;
  auto body = ground_truth::fill_with_gmsh(
      mesh.vertex_m, mesh.triangle,
      {.at_m = {}, .radius_m = 0.0, .fine_m = edge_m, .growth = 0.0, .largest_m = 0.0});
  if (!body) return body.error();
  const Vec3 at = scene.organ.position_m;
  const auto fixed =
      fem::nodes_of_faces_in_box(*body, fem::find_boundary(*body), scene.elastic->fixed_min_m + at,
                                 scene.elastic->fixed_max_m + at);
  auto solver = fem::make_linear_solver(
      *body, {scene.elastic->youngs_modulus_Pa, scene.elastic->poisson_ratio}, fixed);
  if (!solver) return solver.error();
  return std::unique_ptr<Subject>(
      std::make_unique<FemPeer>(scene, std::move(*body), std::move(*solver), edge_m));
}

}  // namespace tact::tools::chart
