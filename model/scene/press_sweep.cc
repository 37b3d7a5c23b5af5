// SPDX-License-Identifier: Apache-2.0
#include "model/scene/press_sweep.h"

#include <algorithm>

namespace tact::model::scene {
namespace {

// On a surface that is steeper against the hand the tool slides along it: cos 60 degrees.
constexpr double kMinFacing = 0.5;

}  // namespace

std::vector<PressPoint> press_points(const Scene& scene, std::size_t count, bool square,
                                     bool upright) {
  const auto& normals = scene.organ_mesh.vertex_normal;
  std::vector<PressPoint> out;
  const auto add = [&](PressWay way, double least_facing) {
    std::vector<std::uint32_t> fit;
    for (std::uint32_t v = 0; v < normals.size(); ++v)
      if (-dot(normals[v], scene.hand_inward) >= least_facing) fit.push_back(v);
    const std::size_t n = count == 0 ? fit.size() : std::min(count, fit.size());
    for (std::size_t i = 0; i < n; ++i) out.push_back({fit[i * fit.size() / n], way});
  };
  if (square) add(PressWay::kSquare, -2.0);
  if (upright) add(PressWay::kUpright, kMinFacing);
  return out;
}

const PressResult* PressSweep::stiffest() const {
  const PressResult* most = nullptr;
  for (const PressResult& r : results)
    if (r.state == PressState::kPressed &&
        (most == nullptr || r.slope_N_per_m.value > most->slope_N_per_m.value))
      most = &r;
  return most;
}

std::vector<const PressResult*> PressSweep::flawed() const {
  std::vector<const PressResult*> out;
  for (const PressResult& r : results)
    if (flaws_of(r, settings).any()) out.push_back(&r);
  // Equals in the order in which they were pressed: all point into one vector.
  std::ranges::sort(out, [this](const PressResult* a, const PressResult* b) {
    const double one = severity(*a, settings), other = severity(*b, settings);
    return one > other || (one == other && a < b);
  });
  return out;
}

std::size_t PressSweep::count(PressState state) const {
  return static_cast<std::size_t>(std::ranges::count(results, state, &PressResult::state));
}

Result<PressSweep> sweep_presses(
    const Scene& scene, std::span<const PressPoint> places, const PressSettings& settings,
    const std::function<bool(std::size_t done, std::size_t all)>& goes_on, const Tissue* tissue) {
  const auto presser = Presser::make(scene, settings, tissue);
  if (!presser) return presser.error();
  PressSweep out{.settings = (*presser)->settings(), .results = {}};
  for (const PressPoint& place : places) {
    out.results.push_back((*presser)->press(place));
    if (goes_on && !goes_on(out.results.size(), places.size()))
      return Error{"the sweep was stopped"};
  }
  return out;
}

}  // namespace tact::model::scene
