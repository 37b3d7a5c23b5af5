// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/linear_places.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tact::tools::ground_truth {
namespace {

using model::Error;

constexpr double kMaxApart_m = 2e-4;  // points are those of meshes that are fine to 0.85 mm
constexpr double kSameWay_ratio = 0.9999;
constexpr double kMaxDepthApart_m = 1e-6;

bool is_same_place(const ToolPoint& a, const ToolPoint& b) {
  return a.vertex == b.vertex && a.tilt_deg == b.tilt_deg &&
         norm(a.point_m - b.point_m) <= kMaxApart_m &&
         dot(a.direction, b.direction) > kSameWay_ratio;
}

/// The largest error of the linear force at a depth that both have; none: they share no depth.
std::optional<DroppedPlace> compare(const ToolPoint& linear, const ToolPoint& finite) {
  std::optional<DroppedPlace> worst;
  for (const ToolCase& a : linear.cases)
    for (const ToolCase& b : finite.cases) {
      if (std::abs(a.depth_m - b.depth_m) > kMaxDepthApart_m) continue;
      const double error_ratio = a.force_N / b.force_N - 1.0;
      if (!worst || std::abs(error_ratio) > std::abs(worst->linear_error_ratio))
        worst = {name_of(linear), a.depth_m, error_ratio};
    }
  return worst;
}

}  // namespace

model::Result<std::vector<DroppedPlace>> drop_contradicted(ToolReference& linear,
                                                           const ToolReference& finite) {
  std::vector<DroppedPlace> dropped;
  std::size_t compared = 0;
  std::erase_if(linear.places, [&](const ToolPoint& place) {
    const auto other = std::ranges::find_if(
        finite.places, [&](const ToolPoint& one) { return is_same_place(place, one); });
    if (other == finite.places.end()) return false;
    const auto worst = compare(place, *other);
    if (!worst) return false;
    ++compared;
    const bool is_contradicted = std::abs(worst->linear_error_ratio) > kMaxLinearError_ratio;
    if (is_contradicted) dropped.push_back(*worst);
    return is_contradicted;
  });
  if (compared == 0)
    return Error{
        "--finite-strain has no place and depth of --tool-reference: solve it with the same "
        "--sites and --depths"};
  if (linear.places.empty())
    return Error{
        "finite strain contradicts every place of the linear reference by more than 3 %: evaluate "
        "the scene by tact-lab sweep SCENE --reference FILE, which presses at finite strain"};
  return dropped;
}

}  // namespace tact::tools::ground_truth
