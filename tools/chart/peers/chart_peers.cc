// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/peers/chart_peers.h"

#include <algorithm>
#include <cmath>

#include "tools/mesh/held_box.h"

namespace tact::tools::chart {
namespace {

// Chosen: the middle of the reference's depths of 1 to 10 mm.
constexpr double kFitDepth_m = 0.005;

}  // namespace

model::Result<std::unique_ptr<Subject>> make_peer(const PeerInput& input, const Variant& variant) {
  const auto iterations = static_cast<int>(variant.peer_size);
  switch (variant.peer) {
    case PeerKind::kFem:
      return make_fem_peer(input, 1e-6 * static_cast<double>(variant.peer_size));
    case PeerKind::kSpringMesh:
      return make_spring_peer(input, iterations);
    case PeerKind::kBulletSurface:
      return make_bullet_peer(input, false, iterations);
    case PeerKind::kBulletVolume:
      return make_bullet_peer(input, true, iterations);
    case PeerKind::kNone:
      break;
  }
  return model::Error{"no peer"};
}

std::vector<std::uint32_t> held_vertices(const model::scene::Scene& scene) {
  std::vector<std::uint32_t> held;
  if (!scene.elastic) return held;
  const auto& mesh = scene.organ_mesh;
  const mesh::HeldBox box{scene.elastic->fixed_min_m, scene.elastic->fixed_max_m};
  const auto is_inside = [&](std::uint32_t v) {
    return box.holds(mesh.vertex_m[v] - scene.organ.position_m);
  };
  for (const auto& t : mesh.triangle)
    if (std::all_of(t.begin(), t.end(), is_inside)) held.insert(held.end(), t.begin(), t.end());
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

std::vector<ProbeCase> fit_cases(const std::vector<ProbeCase>& cases) {
  const auto away_m = [](const ProbeCase& c) { return std::abs(c.in.dent_m - kFitDepth_m); };
  const bool all_held_out =
      std::all_of(cases.begin(), cases.end(), [](const ProbeCase& c) { return c.held_out; });
  std::vector<ProbeCase> out;
  for (const ProbeCase& c : cases) {
    // Presses alone; where every site is held out there is nothing else to fit to.
    if (c.in.held || (c.held_out && !all_held_out)) continue;
    if (out.empty() || out.back().site != c.site)
      out.push_back(c);
    else if (away_m(c) < away_m(out.back()))
      out.back() = c;
  }
  return out;
}

double mean_force_N(Subject& subject, const std::vector<ProbeCase>& cases) {
  double sum_N = 0.0;
  for (const ProbeCase& c : cases) {
    sum_N += settle(subject.is_stepped(), [&] { return subject.tick(c.in); }).force_N;
    // Each from rest: what the one before left behind would act on the next.
    subject.release();
  }
  return sum_N / static_cast<double>(std::max<std::size_t>(1, cases.size()));
}

double mean_reference_N(const std::vector<ProbeCase>& cases) {
  double sum_N = 0.0;
  for (const ProbeCase& c : cases) sum_N += c.reference_N;
  return sum_N / static_cast<double>(std::max<std::size_t>(1, cases.size()));
}

}  // namespace tact::tools::chart
