// SPDX-License-Identifier: Apache-2.0
// A cover plate with bolts and ribs, 104 x 124 x 8 mm, and on it a soft gasket: two closed bodies,
// the plate first. The plate's top is z = 0, the gasket's crest z = 6.1 mm.
//
//     gasket   bead of elliptic section, 10 x 6 mm, along a rectangle of 52 x 72 mm with corners
//              of 14 mm; it lies a tenth of a millimetre above the plate
//     bolts    eight hexagon heads on washers round the rim
#include <array>

#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

constexpr std::size_t kPlateVertices = 7200;
constexpr std::size_t kGasketVertices = 2800;
constexpr double kBlend_mm = 0.8;

// Of the plate: half its size, its corners and its edges.
constexpr double kHalfX_mm = 52.0, kHalfY_mm = 62.0, kThick_mm = 8.0;
constexpr double kCorner_mm = 10.0, kEdge_mm = 2.4;

// Of the gasket: its middle line and half its section.
constexpr double kLineX_mm = 26.0, kLineY_mm = 36.0, kLineCorner_mm = 14.0;
constexpr double kBeadWidth_mm = 5.0, kBeadHeight_mm = 3.0, kGap_mm = 0.1;

constexpr std::array<std::array<double, 2>, 3> kBolts_mm{{{42, 52}, {42, 0}, {0, 52}}};

// Flat distance to a rectangle with round corners, negative inside.
double rectangle_mm(const Vec3& p, double half_x_mm, double half_y_mm, double corner_mm) {
  const double x = std::abs(p.x) - half_x_mm + corner_mm;
  const double y = std::abs(p.y) - half_y_mm + corner_mm;
  const double a = std::max(x, 0.0), b = std::max(y, 0.0);
  return std::sqrt(a * a + b * b) + std::min(std::max(x, y), 0.0) - corner_mm;
}

// A flat shape between two heights, round at its edges.
double slab_mm(double flat_mm, double z_mm, double low_mm, double high_mm, double edge_mm) {
  const double up = std::abs(z_mm - 0.5 * (low_mm + high_mm)) - 0.5 * (high_mm - low_mm) + edge_mm;
  const double over = flat_mm + edge_mm;
  const double a = std::max(over, 0.0), b = std::max(up, 0.0);
  return std::sqrt(a * a + b * b) + std::min(std::max(over, up), 0.0) - edge_mm;
}

// Across the flats 11 mm; the head's foot is in the plate.
double bolt_mm(const Vec3& p, double x_mm, double y_mm) {
  const double x = std::abs(std::abs(p.x) - x_mm), y = std::abs(std::abs(p.y) - y_mm);
  const double hexagon = std::max(x, 0.5 * x + std::sqrt(0.75) * y) - 5.5;
  const double washer = std::sqrt(x * x + y * y) - 8.0;
  return joined_mm(slab_mm(hexagon, p.z, -3.0, 5.5, 0.9), slab_mm(washer, p.z, -3.0, 1.4, 0.6),
                   kBlend_mm);
}

double plate_mm(const Vec3& p) {
  const double rim = rectangle_mm(p, kHalfX_mm, kHalfY_mm, kCorner_mm);
  double d = slab_mm(rim, p.z, -kThick_mm, 0.0, kEdge_mm);
  for (const auto& [x_mm, y_mm] : kBolts_mm) d = joined_mm(d, bolt_mm(p, x_mm, y_mm), kBlend_mm);
  // Within the gasket: two ribs and a lid.
  const Vec3 q{std::abs(p.x), std::abs(p.y), p.z};
  d = joined_mm(d, bar_mm(q, {0, 0, -0.3}, 2.6, {13, 22, -0.3}, 2.2), 1.6);
  const double lid = std::sqrt(p.x * p.x + p.y * p.y) - 9.0;
  return joined_mm(d, slab_mm(lid, p.z, -3.0, 4.0, 1.2), 1.2);
}

double gasket_mm(const Vec3& p) {
  const double beside = rectangle_mm(p, kLineX_mm, kLineY_mm, kLineCorner_mm);
  const Vec3 section{beside, 0.0, p.z - kGap_mm - kBeadHeight_mm};
  return ellipsoid_mm(section, {}, {kBeadWidth_mm, 1.0, kBeadHeight_mm});
}

// Fine at edges, corners and bolts, coarse on the flats and below.
double plate_edge_ratio(const Vec3& p) {
  const double inside_mm = -rectangle_mm(p, kHalfX_mm, kHalfY_mm, kCorner_mm) - 4.0;
  if (p.z > 0.3 || inside_mm < 0.0) return 0.7;
  return std::min(0.7 + 0.2 * inside_mm, p.z > -4.0 ? 1.2 : 3.0);
}

double gasket_edge_ratio(const Vec3& p) { return std::clamp(1.3 - 0.08 * p.z, 0.8, 1.3); }

}  // namespace

model::Result<Shape> make_cover_shape() {
  const Body plate{plate_mm, plate_edge_ratio, {-58, -68, -12}, {58, 68, 10}, 1.5, {}};
  const Body gasket{gasket_mm, gasket_edge_ratio, {-36, -46, -4}, {36, 46, 10}, 1.5, {}};
  auto both = make_grown(plate, kPlateVertices, 0);
  if (!both) return both;
  const auto second = make_grown(gasket, kGasketVertices, 0);
  if (!second) return second.error();
  append(*both, *second);
  return both;
}

}  // namespace tact::tools::make_meshes
