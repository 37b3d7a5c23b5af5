// SPDX-License-Identifier: Apache-2.0
// Are the hand's strokes so fast that the neglected inertia of the tissue matters?
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "firmware/admission/notes.h"
#include "model/indent/compliance_law.h"
#include "model/indent/inertia.h"
#include "model/scene/scene_strokes.h"

namespace tact::firmware::admission {
namespace {

/// The organ under the first sphere as a half-space: that of [elastic], or the incompressible one
/// with the law's force at a depth of one radius.
std::optional<model::indent::ElasticTip> half_space_of(const model::scene::Scene& scene,
                                                       const model::scene::TissueLaw& law) {
  const double radius_m = scene.tool.spheres[0].radius_m;
  if (scene.elastic)
    return model::indent::ElasticTip{.youngs_modulus_Pa = scene.elastic->youngs_modulus_Pa,
                                     .poisson_ratio = scene.elastic->poisson_ratio,
                                     .radius_m = radius_m};
  const double depth_m = std::min(radius_m, law.range().press_m);
  const auto unit = model::indent::half_space_under(radius_m, depth_m);
  if (!unit) return std::nullopt;
  // Tissue is nearly incompressible. E follows from E* of the half-space: E = E* (1 - nu^2).
  constexpr double kIncompressible = 0.5;
  return model::indent::ElasticTip{.youngs_modulus_Pa = (1.0 - kIncompressible * kIncompressible) *
                                                        law.curve()->respond(depth_m).force_N /
                                                        unit->respond(depth_m).force_N,
                                   .poisson_ratio = kIncompressible,
                                   .radius_m = radius_m};
}

struct Press {
  double depth_m = 0.0;  // of the lowest sphere below the contact point
  double speed_mps = 0.0;
  double limit_mps = 0.0;  // IN-2
};

/// The point of the hand's path with the highest ratio of speed to that limit. The slope of a
/// minimum-jerk move is 30 s^2 (1 - s)^2 times its mean, at most 15/8.
Press fastest_press(const model::scene::Scene& scene, const model::indent::ElasticTip& tip,
                    double share) {
  // Chosen: the ratio of two smooth curves needs few samples.
  constexpr int kSamples = 100;
  const double least_m = 0.25 * tip.radius_m;  // lighter contacts are hardly perceptible
  const double reach_m = model::scene::reach_m(scene.tool.spheres, scene.hand_inward);
  Press worst{.limit_mps = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 1; i < scene.hand.path.size(); ++i) {
    const auto &from = scene.hand.path[i - 1], &to = scene.hand.path[i];
    // The depth as scene_strokes.h defines it, from the way points.
    const double start_m = dot(from.position_m - scene.hand_site_m, scene.hand_inward) + reach_m;
    const double way_m = dot(to.position_m - from.position_m, scene.hand_inward);
    for (int k = 1; k < kSamples && way_m > 0.0; ++k) {
      const double s = static_cast<double>(k) / kSamples, rest = 1.0 - s;
      Press at{.depth_m = start_m + way_m * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
               .speed_mps = 30.0 * s * s * rest * rest * way_m / (to.time_s - from.time_s)};
      // The limit of IN-2 falls to 0 with the depth.
      if (at.depth_m < least_m) continue;
      at.limit_mps = model::indent::inertia_speed_mps(tip, at.depth_m, share);
      // Compares ratios without a division, because the first limit is infinite.
      if (at.speed_mps * worst.limit_mps > worst.speed_mps * at.limit_mps) worst = at;
    }
  }
  return worst;
}

}  // namespace

std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law) {
  constexpr double kNoticedForce_ratio =
      0.07;  // smallest relative change of force that people notice
  // A stepped law has masses of its own.
  if (law.curve() == nullptr) return {};
  const auto tip = half_space_of(scene, law);
  if (!tip) return {};
  const Press press = fastest_press(scene, *tip, kNoticedForce_ratio);
  if (!(press.speed_mps > press.limit_mps)) return {};
  return fmt::format(
      "{}: a stroke of the hand presses with {:.0f} mm/s at a depth of {:.1f} mm; from {:.0f} mm/s "
      "on the inertia of tissue, which this law leaves out, is more than {:.0f} % of the force "
      "there: give the stroke more time, or expect less force than tissue has",
      scene.path, 1e3 * press.speed_mps, 1e3 * press.depth_m, 1e3 * press.limit_mps,
      100.0 * kNoticedForce_ratio);
}

}  // namespace tact::firmware::admission
