// SPDX-License-Identifier: Apache-2.0
// Spring-handled forceps: one hexagonal tube from tip to tip, bent round at the spring, with a
// bridge between its two arms at the pivot.
//
//     tube   29 sections of 6 vertices               174 vertices, 28 x 12 + 2 x 4 = 344 triangles
//     bridge one quad of each arm out, four quads in      -4 + 8 triangles
//
// V - E + F = 174 - 522 + 348 = 0: a closed surface with one hole, between pivot and spring.
#include <array>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {
namespace {

using model::normalized;
using model::Vec3;
using model::contact::TriangleCorners;

// A section of the right arm (y > 0), square to its centre line.
struct Section {
  double z_mm = 0.0;
  double y_mm = 0.0;           // of the centre line
  double half_width_mm = 0.0;  // in the plane of the tool
  double half_depth_mm = 0.0;  // along x
};

constexpr std::array<Section, 14> kArm{{{0.0, 4.0, 0.7, 0.9},
                                        {4.0, 4.4, 1.0, 1.3},
                                        {9.0, 4.6, 1.3, 1.7},
                                        {15.0, 4.4, 1.6, 2.0},
                                        {21.0, 3.7, 1.8, 2.2},
                                        {26.0, 3.1, 1.9, 2.6},
                                        {31.0, 3.3, 1.9, 2.6},
                                        {37.0, 5.2, 1.8, 2.4},
                                        {45.0, 8.4, 1.7, 2.8},
                                        {54.0, 10.6, 1.6, 3.3},
                                        {64.0, 11.4, 1.6, 3.5},
                                        {74.0, 10.6, 1.5, 3.3},
                                        {83.0, 8.4, 1.4, 2.9},
                                        {89.5, 4.8, 1.2, 2.6}}};
constexpr Section kSpring{92.0, 0.0, 1.1, 2.5};
constexpr std::uint32_t kBridge = 5;  // between this section of each arm and the next
constexpr std::uint32_t kSections = 2 * kArm.size() + 1;

Vec3 centre_mm(std::uint32_t i) {
  if (i == kArm.size()) return {0.0, 0.0, kSpring.z_mm};
  const bool right = i < kArm.size();
  const Section& s = kArm[right ? i : kSections - 1 - i];
  return {0.0, right ? s.y_mm : -s.y_mm, s.z_mm};
}

Vec3 outward(std::uint32_t i) {
  const Vec3 way = centre_mm(i + 1 < kSections ? i + 1 : i) - centre_mm(i > 0 ? i - 1 : i);
  return normalized(Vec3{0.0, way.z, -way.y});
}

// Corners 1, 2 make the flat outer face, 4, 5 the flat inner face with which jaws grip.
void add_section(std::uint32_t i, Shape& shape) {
  const Section& s = i == kArm.size() ? kSpring : kArm[i < kArm.size() ? i : kSections - 1 - i];
  const Vec3 out_mm = s.half_width_mm * outward(i);
  const Vec3 deep_mm{s.half_depth_mm, 0.0, 0.0};
  for (const auto& [depth, width] :
       {std::array{1.0, 0.0}, {0.6, 1.0}, {-0.6, 1.0}, {-1.0, 0.0}, {-0.6, -1.0}, {0.6, -1.0}}) {
    shape.vertex_mm.push_back(centre_mm(i) + depth * deep_mm + width * out_mm);
  }
}

void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, Shape& shape) {
  shape.triangle.push_back({a, b, c});
  shape.triangle.push_back({a, c, d});
}

}  // namespace

model::Result<Shape> make_forceps_shape() {
  Shape shape;
  for (std::uint32_t i = 0; i < kSections; ++i) add_section(i, shape);
  const auto at = [](std::uint32_t section, std::uint32_t k) { return 6 * section + k % 6; };
  const std::uint32_t left = kSections - 2 - kBridge;  // the bridge's lower section on the left arm
  for (std::uint32_t i = 0; i + 1 < kSections; ++i) {
    for (std::uint32_t k = 0; k < 6; ++k) {
      const bool opened = k == 4 && (i == kBridge || i == left);
      if (!opened) add_quad(at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k), shape);
    }
  }
  // Round the opening of the right arm; the left arm's opening is its mirror image.
  const std::array<std::uint32_t, 4> here{at(kBridge, 4), at(kBridge, 5), at(kBridge + 1, 5),
                                          at(kBridge + 1, 4)};
  const std::array<std::uint32_t, 4> there{at(left + 1, 4), at(left + 1, 5), at(left, 5),
                                           at(left, 4)};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    add_quad(here[k], here[next], there[next], there[k], shape);
  }
  const std::uint32_t last = kSections - 1;  // flat tips
  for (std::uint32_t k = 1; k < 5; ++k) {
    shape.triangle.push_back({at(0, 0), at(0, k + 1), at(0, k)});
    shape.triangle.push_back({at(last, 0), at(last, k), at(last, k + 1)});
  }
  return shape;
}

}  // namespace tact::tools::make_meshes
