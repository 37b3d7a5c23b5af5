// SPDX-License-Identifier: Apache-2.0
// Bullet's soft body under the same tip: position-based dynamics, one step a tick.
//
//     surface   links along the edges and across two of them, and matching to the shape at rest,
//               kMT = kLST^2
//     volume    links along the edges of the tetrahedra that fill the surface (gmsh)
//
// The tip is a penalty spring on the touched triangle, F = q (d - w), as in spring_mesh. Bullet has
// no modulus: its free stiffness (shape matching, or that of the links) is tried until
// the mean force at 5 mm fits within 4 %; if it does not between 1e-4 and 1, the nearest is taken
// and said.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/fem/boundary.h"
#include "tools/chart/peers/chart_peers.h"
#include "tools/condense/condense_organ.h"
#include "tools/ground_truth/gmsh.h"
#include "tools/program/interrupt.h"

namespace tact::tools::chart {
namespace {

using model::Result;
using model::Vec3;
using model::contact::Indentation;
using model::scene::Scene;

constexpr double kDamping_ratio = 0.02;  // of the velocity, a tick
constexpr int kTrials = 8;
constexpr double kFitted_ratio = 0.02;

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}
Vec3 from_bullet(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// Points and what links them; the surface's vertices come first.
struct BodyPlan {
  std::vector<Vec3> point_m;
  std::set<std::pair<int, int>> link;
  bool volume = false;
};

void add_links(BodyPlan& plan, std::span<const std::uint32_t> corners) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = static_cast<int>(corners[i]), b = static_cast<int>(corners[j]);
      plan.link.insert(std::minmax(a, b));
    }
}

Result<BodyPlan> surface_or_volume(const Scene& scene, bool volume) {
  const auto& mesh = scene.organ_mesh;
  BodyPlan plan{.point_m = mesh.vertex_m, .link = {}, .volume = volume};
  for (const auto& t : mesh.triangle) add_links(plan, t);
  if (!volume) return plan;
  const double edge_m = condense::median_edge_m(mesh.view());
  const auto body = ground_truth::fill_with_gmsh(
      mesh.vertex_m, mesh.triangle,
      {.at_m = {}, .radius_m = 0.0, .fine_m = 2.0 * edge_m, .growth = 0.0, .largest_m = 0.0});
  if (!body) return body.error();
  std::vector<std::uint32_t> number(body->node_m.size(), 0);  // of a corner among the points; + 1
  for (std::uint32_t v = 0; v < mesh.vertex_m.size(); ++v) number[v] = v + 1;
  for (const auto& element : body->element) {
    std::array<std::uint32_t, 4> corner{};
    for (std::size_t c = 0; c < 4; ++c) {
      std::uint32_t& known = number[element[c]];
      if (known == 0) {
        plan.point_m.push_back(body->node_m[element[c]]);
        known = static_cast<std::uint32_t>(plan.point_m.size());
      }
      corner[c] = known - 1;
    }
    add_links(plan, corner);
  }
  return plan;
}

class BulletPeer final : public Subject {
 public:
  BulletPeer(const Scene& scene, const BodyPlan& plan, int iterations, double stiffness)
      : scene_(scene),
        rest_m_(plan.point_m),
        iterations_(iterations),
        stiffness_(stiffness),
        volume_(plan.volume) {
    world_.setGravity({0, 0, 0});
    world_.getWorldInfo().m_gravity = {0, 0, 0};
    std::vector<btVector3> points;
    for (const Vec3& p : plan.point_m) points.push_back(to_bullet(p));
    body_ = new btSoftBody(&world_.getWorldInfo(), static_cast<int>(points.size()), points.data(),
                           nullptr);
    for (const auto& [a, b] : plan.link) body_->appendLink(a, b);
    for (const auto& t : scene.organ_mesh.triangle)
      body_->appendFace(static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2]));
    auto& material = *body_->m_materials[0];
    material.m_kLST = static_cast<btScalar>(volume_ ? stiffness : std::sqrt(stiffness));
    if (!volume_) body_->generateBendingConstraints(2);
    // Bullet: against a bias of its solver from the order of the links.
    body_->randomizeConstraints();
    auto& settings = body_->m_cfg;
    settings.piterations = iterations;
    settings.kDP = static_cast<btScalar>(kDamping_ratio);
    // The tip is a spring of ours; Bullet's own contact would be a second one.
    settings.collisions = 0;
    const double volume_m3 = std::abs(summarize(scene.organ_mesh).volume_m3);
    body_->setTotalMass(static_cast<btScalar>(kDensity_kg_per_m3 * volume_m3), false);
    // Mass 0 is Bullet's word for "does not move".
    for (const std::uint32_t v : held_vertices(scene)) body_->setMass(static_cast<int>(v), 0);
    if (!volume_) {
      settings.kMT = static_cast<btScalar>(stiffness);
      body_->setPose(false, true);
    }
    world_.addSoftBody(body_);  // the world does not own it
    dent_m_.resize(scene.organ_mesh.vertex_m.size());
  }
  BulletPeer(const BulletPeer&) = delete;
  BulletPeer& operator=(const BulletPeer&) = delete;
  ~BulletPeer() override {
    world_.removeSoftBody(body_);
    delete body_;
  }

  double tick(const Indentation& in) override {
    const auto& mesh = scene_.organ_mesh;
    const auto& corner = mesh.triangle[in.place.triangle];
    double dent_m = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      dent_m += in.place.weight[c] * dot(moved_m(corner[c]), -mesh.vertex_normal[corner[c]]);
    double force_N = kCoupling_N_per_m * (in.dent_m - dent_m);
    // A press never pulls.
    if (!in.held) force_N = std::max(0.0, force_N);
    for (std::size_t c = 0; c < 3; ++c)
      body_->addForce(to_bullet(-force_N * in.place.weight[c] * mesh.vertex_normal[corner[c]]),
                      static_cast<int>(corner[c]));
    step();
    return force_N;
  }

  void release() override {
    for (std::size_t i = 0; i < rest_m_.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[static_cast<int>(i)];
      node.m_x = node.m_q = to_bullet(rest_m_[i]);
      node.m_v = node.m_f = {0, 0, 0};
    }
  }

  void shape(const Indentation& in, double pitch_m, std::span<double> ring_m) override {
    for (std::uint32_t v = 0; v < dent_m_.size(); ++v) dent_m_[v] = -dot(moved_m(v), in.normal);
    ring_means(scene_.organ_mesh.view(), in, pitch_m, dent_m_, ring_m);
  }

  bool is_stepped() const override { return true; }
  std::size_t memory_bytes() const override {
    return static_cast<std::size_t>(body_->m_nodes.size()) * sizeof(btSoftBody::Node) +
           static_cast<std::size_t>(body_->m_links.size()) * sizeof(btSoftBody::Link) +
           static_cast<std::size_t>(body_->m_faces.size()) * sizeof(btSoftBody::Face);
  }
  std::string given() const override {
    return fmt::format(
        "{} nodes and {} links; {} position iterations and one step a tick of {:g} ms; {} = {:.3g} "
        "so that the mean force at 5 mm is {}",
        body_->m_nodes.size(), body_->m_links.size(), iterations_, 1e3 / scene_.rate_Hz,
        volume_ ? "kLST" : "kMT = kLST squared", stiffness_, fitted_ ? "right" : "nearest");
  }
  void set_fitted(bool fitted) { fitted_ = fitted; }

 private:
  Vec3 moved_m(std::uint32_t vertex) const {
    return from_bullet(body_->m_nodes[static_cast<int>(vertex)].m_x) -
           scene_.organ_mesh.vertex_m[vertex];
  }
  // 0 substeps: one step of the tick's own length, without interpolation.
  void step() { world_.stepSimulation(static_cast<btScalar>(1.0 / scene_.rate_Hz), 0); }

  const Scene& scene_;
  const std::vector<Vec3> rest_m_;
  int iterations_;
  double stiffness_;
  bool volume_, fitted_ = true;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btSoftBody* body_ = nullptr;
  std::vector<double> dent_m_;
};

}  // namespace

Result<std::unique_ptr<Subject>> make_bullet_peer(const PeerInput& input, bool volume,
                                                  int iterations) {
  const auto plan = surface_or_volume(input.scene, volume);
  if (!plan) return plan.error();
  const auto fit = fit_cases(input.cases);
  const double wanted_N = mean_reference_N(fit);
  const auto force_N = [&](double stiffness) {
    BulletPeer trial(input.scene, *plan, iterations, stiffness);
    return mean_force_N(trial, fit);
  };
  // the force grows with Bullet's stiffness, roughly as a power: false position in logarithms
  struct Trial {
    double stiffness, force_N;
  };
  Trial low{1e-4, force_N(1e-4)}, high{1.0, force_N(1.0)};
  const auto miss = [&](const Trial& t) { return std::abs(t.force_N - wanted_N); };
  Trial best = miss(low) < miss(high) ? low : high;
  if (low.force_N < wanted_N && high.force_N > wanted_N) {
    for (int i = 0; i < kTrials; ++i) {
      const double least_N = std::max(low.force_N, 1e-3 * wanted_N);  // it may give way for good
      const double share = std::log(wanted_N / least_N) / std::log(high.force_N / least_N);
      const double stiffness =
          low.stiffness * std::pow(high.stiffness / low.stiffness, std::clamp(share, 0.1, 0.9));
      const Trial now{stiffness, force_N(stiffness)};
      if (miss(now) < miss(best)) best = now;
      if (miss(now) < kFitted_ratio * wanted_N || program::is_interrupted()) break;
      (now.force_N < wanted_N ? low : high) = now;
    }
  }
  auto peer = std::make_unique<BulletPeer>(input.scene, *plan, iterations, best.stiffness);
  peer->set_fitted(std::abs(mean_force_N(*peer, fit) - wanted_N) < 2.0 * kFitted_ratio * wanted_N);
  return std::unique_ptr<Subject>(std::move(peer));
}

}  // namespace tact::tools::chart
