// SPDX-License-Identifier: Apache-2.0
// A scalpel: the cutting edge starts at the origin and runs straight up along +z, facing +x.
//
//     blade   edge on the z axis to z = 24, back slanting to x = -8, 0.8 mm thick
//     handle  flat bar to z = 140
//
// Each section has its front at x = front, its back at x = back and a thickness along y:
// 15 sections of 7 points and two ends: 107 vertices, 210 triangles.
#include <array>

#include "tools/make_meshes/loft.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

struct Section {
  double z_mm = 0.0, front_mm = 0.0, back_mm = 0.0;
  double thick_mm = 0.0;
  double bevel_ratio = 0.5;  // of the way from front to back where the full thickness begins
};

constexpr std::array<Section, 15> kSections{{{3, 0, -1.6, 0.30, 0.5},
                                             {7, 0, -3.4, 0.50, 0.5},
                                             {12, 0, -5.4, 0.70, 0.4},
                                             {18, 0, -7.2, 0.80, 0.35},
                                             {24, 0, -8, 0.80, 0.35},
                                             {28, -0.6, -7.6, 0.9, 0.3},
                                             {32, -1.2, -6.8, 1.6, 0.25},
                                             {38, -1.0, -7.0, 2.6, 0.2},
                                             {48, -0.2, -7.8, 3.0, 0.2},
                                             {62, 0.2, -8.2, 3.2, 0.2},
                                             {78, 0.2, -8.2, 3.2, 0.2},
                                             {94, 0, -8, 3.2, 0.2},
                                             {110, -0.4, -7.6, 3.2, 0.2},
                                             {126, -0.4, -7.6, 3.2, 0.2},
                                             {138, -0.8, -7.2, 2.8, 0.2}}};

std::vector<Vec3> points(const Section& s) {
  const double half_mm = 0.5 * s.thick_mm, width_mm = s.back_mm - s.front_mm;
  const double bevel_mm = s.front_mm + s.bevel_ratio * width_mm;
  const double middle_mm = 0.5 * (bevel_mm + s.back_mm);
  const double z = s.z_mm;
  return {{s.front_mm, 0, z},
          {bevel_mm, half_mm, z},
          {middle_mm, half_mm, z},
          {s.back_mm, 0.6 * half_mm, z},
          {s.back_mm, -0.6 * half_mm, z},
          {middle_mm, -half_mm, z},
          {bevel_mm, -half_mm, z}};
}

}  // namespace

model::Result<Shape> make_blade_shape() {
  std::vector<std::vector<Vec3>> ring;
  ring.reserve(kSections.size());
  for (const Section& s : kSections) ring.push_back(points(s));
  return make_loft({0, 0, 0}, ring, {-4, 0, 140});
}

}  // namespace tact::tools::make_meshes
