// SPDX-License-Identifier: Apache-2.0
// The gum of a lower jaw without its teeth: a U-shaped ridge, 50 x 60 x 15 mm, crest towards +z.
//
// The middle line is a half circle of 22.5 mm about (kArch_mm, 0), open towards -x, and two
// straight legs. Across, the ridge is a rounded trapezium; mounds on the crest mark where teeth
// were.
#include <array>

#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

constexpr std::size_t kVertices = 2300;
constexpr double kArch_mm = -5.0;     // x of the circle's centre
constexpr double kRadius_mm = 22.5;   // of the circle
constexpr double kLegEnd_mm = -17.5;  // x
constexpr double kHalfHeight_mm = 7.5;
constexpr double kRound_mm = 4.0;
constexpr double kMound_mm = 5.5;  // radius

// Mounds: the middle front, then pairs to both sides. The first three pairs lie on the circle at
// (1 - t^2, 2 t) / (1 + t^2), t the tangent of half their angle.
constexpr std::array<double, 3> kHalfTangents{0.19, 0.42, 0.73};
constexpr std::array<double, 1> kLegMounds_mm{-14.0};  // x

// Flat distance to the middle line.
double beside_mm(const Vec3& p) {
  const double x = p.x - kArch_mm, y = std::abs(p.y);
  if (x > 0.0) return std::abs(std::sqrt(x * x + y * y) - kRadius_mm);
  const double past = std::max(kLegEnd_mm - p.x, 0.0), off = y - kRadius_mm;
  return std::sqrt(past * past + off * off);
}

double mound_mm(const Vec3& p, double x_mm, double y_mm) {
  return norm(Vec3{p.x - x_mm, std::abs(p.y) - y_mm, p.z - (kHalfHeight_mm - kMound_mm)}) -
         kMound_mm;
}

double gum_mm(const Vec3& p) {
  const double half_width_mm = 6.8 - 1.0 * p.z / kHalfHeight_mm;
  const double ridge_mm = kHalfHeight_mm - 1.2;  // the mounds rise above it
  const double a = beside_mm(p) - half_width_mm + kRound_mm;
  const double b = (p.z > 0.0 ? p.z - ridge_mm : -p.z - kHalfHeight_mm) + kRound_mm;
  const double over = std::max(a, 0.0), up = std::max(b, 0.0);
  double d = std::sqrt(over * over + up * up) + std::min(std::max(a, b), 0.0) - kRound_mm;
  d = joined_mm(d, mound_mm(p, kArch_mm + kRadius_mm, 0.0), 1.5);
  for (const double t : kHalfTangents) {
    const double s = kRadius_mm / (1.0 + t * t);
    d = joined_mm(d, mound_mm(p, kArch_mm + s * (1.0 - t * t), s * 2.0 * t), 1.5);
  }
  for (const double x_mm : kLegMounds_mm) d = joined_mm(d, mound_mm(p, x_mm, kRadius_mm), 1.5);
  return d;
}

// Fine and even above the middle, where the blade goes.
double edge_ratio(const Vec3& p) { return std::clamp(1.0 - 0.12 * p.z, 1.0, 1.5); }

}  // namespace

model::Result<Shape> make_gum_shape() {
  const Body gum{gum_mm, edge_ratio, {-30, -35, -10}, {30, 35, 10}, 1.7, {}};
  return make_grown(gum, kVertices, 0);
}

}  // namespace tact::tools::make_meshes
