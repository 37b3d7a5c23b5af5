// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/chart/measure/measure.h"
#include "tools/ground_truth/reference_fits.h"
#include "tools/program/interrupt.h"

namespace tact::tools::chart {
namespace {

using model::Result;
using model::Vec3;
using model::contact::Indentation;

/// The vertex as a place: one of its triangles, all the weight on its corner.
model::contact::SurfacePoint place_of(const model::mesh::SurfaceMesh& mesh, std::uint32_t vertex) {
  model::contact::SurfacePoint place{.triangle = mesh.fan[mesh.fan_start[vertex]], .weight = {}};
  for (std::size_t c = 0; c < 3; ++c)
    if (mesh.triangle[place.triangle][c] == vertex) place.weight[c] = 1.0;
  return place;
}

bool is_held_out(const model::scene::Scene& scene, std::uint32_t vertex) {
  return std::any_of(scene.reference_sites.begin(), scene.reference_sites.end(),
                     [&](const auto& s) { return s.vertex == vertex && s.held_out; });
}

}  // namespace

Result<std::vector<ProbeCase>> cases_of(const model::scene::Scene& scene,
                                        const ground_truth::ReferenceData& reference) {
  if (auto differs = check_reference_fits(reference, scene, ground_truth::ModulusOf::kSame))
    return std::move(*differs);
  std::vector<ProbeCase> cases;
  for (std::size_t i = 0; i < reference.sites.size(); ++i) {
    const ground_truth::SolvedSite& site = reference.sites[i];
    for (const ground_truth::ReferenceCase& c : site.cases) {
      // The chart's reference is linear (measure.h).
      if (c.large_strain) continue;
      const Indentation in{.sphere = 0,
                           .surface_point = place_of(scene.organ_mesh, site.vertex),
                           .normal = -site.direction,
                           .indentation_m = c.depth_m,
                           .held = !c.is_press()};
      cases.push_back({.site = i,
                       .held_out = is_held_out(scene, site.vertex),
                       .in = in,
                       .reference_N = c.force_N,
                       .reference_ring_m = c.profile_m});
    }
  }
  return cases;
}

SettledForce settle(bool is_stepped, const std::function<double()>& tick_force_N) {
  // As measure.h says: within 0.1 % over 50 ticks.
  constexpr int kWindow = 50;
  constexpr double kSteady_ratio = 1e-3;
  if (!is_stepped) return {.force_N = tick_force_N(), .ticks = 1};
  double low_N = 0.0, high_N = 0.0;
  for (int i = 0; i < kMaxSettleTicks; ++i) {
    const double force_N = tick_force_N();
    if (i % kWindow == 0) low_N = high_N = force_N;
    low_N = std::min(low_N, force_N);
    high_N = std::max(high_N, force_N);
    const double size_N = std::max(std::abs(low_N), std::abs(high_N));
    if (i % kWindow == 0 && program::is_interrupted()) break;  // the run will say so
    if (i % kWindow == kWindow - 1 && high_N - low_N <= kSteady_ratio * size_N)
      return {.force_N = force_N, .ticks = i + 1};
  }
  // It never stood: the middle of its last swing.
  return {.force_N = 0.5 * (low_N + high_N), .ticks = kMaxSettleTicks};
}

Answers measure_answers(Subject& subject, const std::vector<ProbeCase>& cases, double pitch_m) {
  Answers out;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ProbeCase& c = cases[i];
    const bool elsewhere =
        i > 0 && (cases[i - 1].site != c.site || cases[i - 1].in.held != c.in.held);
    // Deeper at the same site it goes on, as a press does; elsewhere it begins from rest.
    if (elsewhere) subject.release();
    const SettledForce settled = settle(subject.is_stepped(), [&] { return subject.tick(c.in); });
    Sample sample{.site = c.site,
                  .held_out = c.held_out,
                  .depth_m = c.in.indentation_m,
                  .force_N = settled.force_N,
                  .reference_N = c.reference_N,
                  .ring_m = std::vector<double>(c.reference_ring_m.size()),
                  .reference_ring_m = c.reference_ring_m};
    subject.shape(c.in, pitch_m, sample.ring_m);
    out.settle_ticks = std::max(out.settle_ticks, settled.ticks);
    out.samples.push_back(std::move(sample));
  }
  subject.release();
  return out;
}

}  // namespace tact::tools::chart
