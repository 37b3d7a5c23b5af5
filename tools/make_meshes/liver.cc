// SPDX-License-Identifier: Apache-2.0
// The liver: an ellipsoid made thick on one side and thin on the other, with a notched lower edge.
//
//     y = 75 u_y
//     x = W(u_y) u_x - notch(u_x, u_y)          dx/du_x > 0
//     z = T(u_x, u_y) u_z + C(u_x, u_y)         T > 0
//
// u: point of the unit sphere. Each line rises with its own u for fixed others, so the map is one
// to one and the surface cannot cut itself. C lifts the bottom of thin parts rather than lowering
// their top, so that the top stays a gentle dome for a tool to press on.
#include <cmath>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

// Half width along x, mm.
double half_width_mm(double s) { return 49.5 * (1.0 - 0.16 * s - 0.02 * s * s); }

// Half thickness along z, mm: the right lobe (-y) is thick, the lower edge (+x) thin.
double half_thickness_mm(double r, double s) {
  return 25.4 * (1.0 - 0.30 * s - 0.12 * s * s) * (1.0 - 0.34 * r - 0.10 * r * r);
}

// The notch of the round ligament, cut into the lower edge, mm.
double notch_mm(double r, double s) {
  const double edge = 0.5 * (1.0 + r);
  const double across = (s - 0.30) / 0.15;
  return 12.0 * edge * edge * edge * std::exp(-across * across);
}

Vec3 liver_mm(const Vec3& u) {
  const double thick_mm = half_thickness_mm(u.x, u.y);
  const double camber_mm = 11.0 * u.x * u.x + 9.0 * u.y * u.y;
  // A hollow under the middle, where vessels enter.
  const double hollow_mm = 6.0 * std::exp(-4.0 * (u.x * u.x + u.y * u.y)) * 0.5 * (1.0 - u.z);
  const double z_mm = thick_mm * u.z + (30.0 - thick_mm) - camber_mm + hollow_mm;
  return {half_width_mm(u.y) * u.x - notch_mm(u.x, u.y), 75.0 * u.y, z_mm};
}

}  // namespace

model::Result<Shape> make_liver_shape(std::size_t vertices) {
  return make_body(vertices, liver_mm);
}

}  // namespace tact::tools::make_meshes
