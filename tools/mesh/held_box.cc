// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/held_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact::tools::mesh {
namespace {

using model::Vec3;

constexpr double kHeld_ratio = 0.1;  // of the organ's extent along the axis
constexpr double kAround_m = 0.01;   // of the box beyond the organ
constexpr std::array<double Vec3::*, 3> kAxes{&Vec3::x, &Vec3::y, &Vec3::z};

}  // namespace

bool HeldBox::holds(const Vec3& p_m) const {
  return std::all_of(kAxes.begin(), kAxes.end(), [&](auto axis) {
    return min_m.*axis <= p_m.*axis && p_m.*axis <= max_m.*axis;
  });
}

HeldBox far_tenth(const model::mesh::SurfaceMesh& organ, const Vec3& inward) {
  const auto sum = summarize(organ);
  const Vec3 around_m{kAround_m, kAround_m, kAround_m};
  HeldBox box{sum.low_m - around_m, sum.high_m + around_m};
  double Vec3::* const axis = *std::max_element(kAxes.begin(), kAxes.end(), [&](auto a, auto b) {
    return std::abs(inward.*a) < std::abs(inward.*b);
  });
  const double tenth_m = kHeld_ratio * (sum.high_m.*axis - sum.low_m.*axis);
  if (inward.*axis < 0.0)
    box.max_m.*axis = sum.low_m.*axis + tenth_m;
  else
    box.min_m.*axis = sum.high_m.*axis - tenth_m;
  return box;
}

std::size_t held_triangles(const model::mesh::SurfaceMesh& organ, const HeldBox& box) {
  const auto holds = [&](std::uint32_t v) { return box.holds(organ.vertex_m[v]); };
  return static_cast<std::size_t>(
      std::count_if(organ.triangle.begin(), organ.triangle.end(),
                    [&](const auto& t) { return std::all_of(t.begin(), t.end(), holds); }));
}

}  // namespace tact::tools::mesh
