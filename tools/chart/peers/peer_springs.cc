// SPDX-License-Identifier: Apache-2.0
// Masses and springs of the whole surface, all stepped every tick by implicit Euler.
//
// The springs are those of the scene's spring patch if it has one: along every edge, and from every
// vertex to its place at rest. All of them, and the virtual spring under the tip, are scaled by one
// factor until the mean force fits; the mass of a vertex is the organ's over their number.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/mesh/mesh.h"
#include "model/springs/patch_surface.h"
#include "model/springs/spring_network.h"
#include "tools/chart/peers/chart_peers.h"

namespace tact::tools::chart {
namespace {

using model::Result;
using model::Vec3;
using model::contact::Indentation;
using model::scene::LawKind;
using model::scene::Scene;
using model::springs::ProbeSpring;

// Where the scene has no patch. N/m, N/m, s, s, -: an edge four times as stiff as a body spring.
constexpr model::springs::PatchTissue kTissue{40.0, 10.0, 0.005, 0.005, 0.0};

struct Springs {
  model::springs::PatchTissue tissue;
  double coupling_N_per_m = 0.0;
};

Springs springs_of(const Scene& scene, double scale) {
  const bool has_patch = scene.describes(LawKind::kSpringPatch);
  Springs s{.tissue = has_patch ? scene.spring_patch.tissue : kTissue,
            .coupling_N_per_m =
                has_patch ? scene.spring_patch.coupling_stiffness_N_per_m : kCoupling_N_per_m};
  s.tissue.surface_stiffness_N_per_m *= scale;
  s.tissue.body_stiffness_N_per_m *= scale;
  s.coupling_N_per_m *= scale;
  return s;
}

class SpringPeer final : public Subject {
 public:
  SpringPeer(const Scene& scene, int iterations, double scale)
      : scene_(scene),
        springs_(springs_of(scene, scale)),
        scale_(scale),
        surface_(make_patch_surface(scene.organ_mesh.view(), springs_.tissue)),
        stepper_(scene.organ_mesh.vertex_m.size(), surface_.edge.size()),
        rule_{.method = {.integrator = model::springs::Integrator::kImplicitEuler},
              .step_s = 1.0 / scene.rate_Hz,
              .iterations = iterations} {
    const std::size_t n = scene.organ_mesh.vertex_m.size();
    const double volume_m3 = std::abs(summarize(scene.organ_mesh).volume_m3);
    const double mass_kg = kDensity_kg_per_m3 * volume_m3 / static_cast<double>(n);
    position_ = scene.organ_mesh.vertex_m;
    velocity_.resize(n);
    inverse_mass_.assign(n, 1.0 / mass_kg);
    // An infinite mass does not move.
    for (const std::uint32_t v : held_vertices(scene)) inverse_mass_[v] = 0.0;
    drag_.resize(n);
    for (std::size_t v = 0; v < n; ++v)
      drag_[v] = springs_.tissue.body_damping_time_s * surface_.anchor_N_per_m[v];
    for (const model::springs::PatchEdge& e : surface_.edge) {
      const double k = springs_.tissue.surface_stiffness_N_per_m;
      spring_.push_back({.i = e.a,
                         .j = e.b,
                         .stiffness_N_per_m = k,
                         .damping_Ns_per_m = springs_.tissue.damping_time_s * k,
                         .rest_length_m = surface_.rest_length_m(e)});
    }
    dent_m_.resize(n);
  }

  double tick(const Indentation& in) override {
    const auto& mesh = scene_.organ_mesh;
    probe_.node = mesh.triangle[in.place.triangle];
    probe_.weight = in.place.weight;
    for (std::size_t c = 0; c < 3; ++c) probe_.push[c] = -mesh.vertex_normal[probe_.node[c]];
    probe_.depth_m = in.dent_m;
    probe_.held = in.held;
    probe_.stiffness_N_per_m = springs_.coupling_N_per_m;
    stepper_.step(network(), rule_);
    return probe_force_N(probe_, dent_m(probe_, position_, mesh.vertex_m));
  }

  void release() override {
    position_ = scene_.organ_mesh.vertex_m;
    std::fill(velocity_.begin(), velocity_.end(), Vec3{});
  }

  void shape(const Indentation& in, double pitch_m, std::span<double> ring_m) override {
    for (std::size_t v = 0; v < dent_m_.size(); ++v)
      dent_m_[v] = -dot(position_[v] - scene_.organ_mesh.vertex_m[v], in.normal);
    ring_means(scene_.organ_mesh.view(), in, pitch_m, dent_m_, ring_m);
  }

  bool is_stepped() const override { return true; }
  std::size_t memory_bytes() const override {
    return stepper_.memory_bytes() + surface_.memory_bytes() +
           position_.size() * (2 * sizeof(Vec3) + 3 * sizeof(double)) +
           spring_.size() * sizeof(model::springs::Spring);
  }
  std::string given() const override {
    return fmt::format(
        "all {} vertices and {} edges; implicit Euler; {} conjugate gradients a tick of {:g} ms; "
        "springs x {:.3g} so that the mean force at 5 mm fits",
        position_.size(), spring_.size(), rule_.iterations, 1e3 * rule_.step_s, scale_);
  }

 private:
  model::springs::SpringNetwork network() {
    return {.node = {.position_m = position_,
                     .velocity_mps = velocity_,
                     .rest_m = scene_.organ_mesh.vertex_m,
                     .load_N = surface_.load_N,
                     .inverse_mass_per_kg = inverse_mass_,
                     .anchor_N_per_m = surface_.anchor_N_per_m,
                     .drag_Ns_per_m = drag_},
            .spring = spring_,
            .probe = {&probe_, 1}};
  }

  const Scene& scene_;
  Springs springs_;
  double scale_;
  model::springs::PatchSurface surface_;
  model::springs::SpringStepper stepper_;
  model::springs::StepRule rule_;
  ProbeSpring probe_{};
  std::vector<Vec3> position_, velocity_;
  std::vector<double> inverse_mass_, drag_, dent_m_;
  std::vector<model::springs::Spring> spring_;
};

}  // namespace

Result<std::unique_ptr<Subject>> make_spring_peer(const PeerInput& input, int iterations) {
  const auto fit = fit_cases(input.cases);
  const double wanted_N = mean_reference_N(fit);
  double scale = 1.0;
  // at rest the force is proportional to the scale; twice, as settling is not quite rest
  for (int i = 0; i < 2; ++i) {
    SpringPeer trial(input.scene, iterations, scale);
    const double force_N = mean_force_N(trial, fit);
    if (!(force_N > 0.0))
      return model::Error{"spring_mesh: no force at the reference's sites; check the scene's mesh"};
    scale *= wanted_N / force_N;
  }
  return std::unique_ptr<Subject>(std::make_unique<SpringPeer>(input.scene, iterations, scale));
}

}  // namespace tact::tools::chart
