// SPDX-License-Identifier: Apache-2.0
// The heart, lying on its back: two ventricles that end in one apex, two atria, and the stumps of
// aorta, lung artery and vena cava, cut open.
//
//     V - E + F = 2 - rims,  E = (3 F + R) / 2,  R edges on the rims
//     10 026 vertices and 19 409 triangles leave  R = 639 + 2 rims:  three rims share 645 edges.
//
// So the rims are finely divided (0.4 mm), and the edges grow away from them.
#include <algorithm>
#include <array>

#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

constexpr std::size_t kVertices = 10'026;
constexpr std::size_t kRimEdges = 645;
constexpr double kReach_mm = 19.0;  // past the end of each vessel, short of its neighbours

struct Vessel {
  Vec3 root_mm{}, end_mm{};
  double root_radius_mm = 0.0, end_radius_mm = 0.0;
  double cut_ratio = 0.0;  // of the way from root to end
};

constexpr std::array<Vessel, 3> kVessels{{
    {{-20, 0, 8}, {-72, -8, 14}, 15.0, 13.0, 0.92},     // aorta
    {{-14, -14, 20}, {-57, 34, 28}, 15.0, 12.0, 0.92},  // lung artery, crosses over the aorta
    {{-36, -28, -4}, {-72, -40, 4}, 14.0, 10.0, 0.90},  // vena cava
}};

Vec3 cut_centre_mm(const Vessel& v) { return v.root_mm + v.cut_ratio * (v.end_mm - v.root_mm); }

double heart_mm(const Vec3& p) {
  const double left = bar_mm(p, {-12, 8, -2}, 35.0, {42, 8, -8}, 12.0);
  const double right = bar_mm(p, {-14, -16, 6}, 28.0, {30, 0, -2}, 13.0);
  double d = joined_mm(left, right, 8.0);
  d = joined_mm(d, ellipsoid_mm(p, {-36, -22, -4}, {20, 22, 24}), 6.0);  // right atrium
  d = joined_mm(d, ellipsoid_mm(p, {-38, 14, -12}, {20, 26, 22}), 6.0);  // left atrium
  for (const Vessel& v : kVessels)
    d = joined_mm(d, bar_mm(p, v.root_mm, v.root_radius_mm, v.end_mm, v.end_radius_mm), 5.0);
  return d;
}

double edge_ratio(const Vec3& p) {
  double near_mm = 100.0;  // to the nearest rim, a circle
  for (const Vessel& v : kVessels) {
    const Vec3 from = p - cut_centre_mm(v), along = normalized(v.end_mm - v.root_mm);
    const double over_mm = dot(from, along), out_mm = norm(from - over_mm * along);
    const double radius_mm = v.root_radius_mm + v.cut_ratio * (v.end_radius_mm - v.root_radius_mm);
    const double beside_mm = out_mm - radius_mm;
    near_mm = std::min(near_mm, std::sqrt(over_mm * over_mm + beside_mm * beside_mm));
  }
  return std::min(0.35 + 0.28 * near_mm, 2.0);
}

}  // namespace

model::Result<Shape> make_heart_shape() {
  Body body{heart_mm, edge_ratio, {-100, -60, -60}, {70, 60, 60}, 2.7, {}};
  for (const Vessel& v : kVessels)
    body.cuts.push_back({cut_centre_mm(v), normalized(v.end_mm - v.root_mm), kReach_mm});
  return make_grown(body, kVertices, kRimEdges);
}

}  // namespace tact::tools::make_meshes
