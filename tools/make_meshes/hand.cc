// SPDX-License-Identifier: Apache-2.0
// A right hand that points: forefinger straight down, the other fingers closed, and a cuff.
//
// The fingertip is at the origin, the arm goes towards +z, the palm faces +x, the thumb is at -y.
//
//     2 865 vertices and 5 722 triangles:  V - E + F = V - F/2 = 4,  two closed bodies of 2 each:
//     hand  2 465 vertices, 4 926 triangles;  cuff above the wrist  400 vertices, 796.
#include <array>

#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::Vec3;

constexpr std::size_t kHandVertices = 2465;
constexpr std::size_t kCuffVertices = 400;

struct Bar {
  Vec3 from_mm{}, to_mm{};
  double from_radius_mm = 0.0, to_radius_mm = 0.0;
};

constexpr std::array<Bar, 3> kForefinger{{{{0, 0, 6.5}, {0, 0, 26}, 6.5, 7.5},
                                          {{0, 0, 26}, {-1, 0, 50}, 7.5, 8.2},
                                          {{-1, 0, 50}, {-4, 1, 90}, 8.5, 10.0}}};

// Each closed finger: away from its knuckle, round, and back into the palm.
constexpr std::array<Bar, 9> kClosed{{{{-4, 20, 88}, {10, 20, 56}, 10.0, 9.0},
                                      {{10, 20, 56}, {30, 20, 66}, 9.0, 8.0},
                                      {{30, 20, 66}, {22, 20, 86}, 8.0, 7.5},
                                      {{-4, 38, 91}, {10, 37, 60}, 9.5, 8.5},
                                      {{10, 37, 60}, {29, 37, 70}, 8.5, 7.5},
                                      {{29, 37, 70}, {21, 37, 89}, 7.5, 7.0},
                                      {{-4, 54, 98}, {9, 52, 70}, 8.5, 7.5},
                                      {{9, 52, 70}, {25, 51, 78}, 7.5, 6.5},
                                      {{25, 51, 78}, {18, 51, 94}, 6.5, 6.5}}};

constexpr std::array<Bar, 3> kThumb{{{{4, 10, 138}, {14, -14, 112}, 15.0, 11.5},
                                     {{14, -14, 112}, {16, -28, 88}, 10.5, 9.0},
                                     {{16, -28, 88}, {14, -31, 66}, 9.0, 7.0}}};

constexpr std::array<Bar, 6> kPalm{{{{-4, 1, 90}, {0, 16, 150}, 10.5, 13.0},
                                    {{-4, 20, 88}, {0, 22, 150}, 11.0, 14.0},
                                    {{-4, 38, 91}, {0, 28, 150}, 10.5, 14.0},
                                    {{-4, 54, 98}, {0, 34, 150}, 9.5, 13.0},
                                    {{12, 24, 84}, {8, 28, 130}, 12.0, 14.0},
                                    {{15, 22, 74}, {14, 50, 85}, 14.0, 11.0}}};  // fills the fist

constexpr std::array<Bar, 2> kWrist{
    {{{0, 17, 120}, {0, 15, 143}, 14.0, 15.0}, {{0, 33, 120}, {0, 35, 143}, 14.0, 15.0}}};

constexpr Vec3 kCuff_mm{0, 25, 173};

template <std::size_t kBars>
double bars_mm(const std::array<Bar, kBars>& bars, const Vec3& p, double blend_mm) {
  double d = 1e3;
  for (const Bar& b : bars)
    d = joined_mm(d, bar_mm(p, b.from_mm, b.from_radius_mm, b.to_mm, b.to_radius_mm), blend_mm);
  return d;
}

double hand_mm(const Vec3& p) {
  double d = joined_mm(bars_mm(kPalm, p, 6.0), bars_mm(kWrist, p, 8.0), 10.0);
  d = joined_mm(d, bars_mm(kForefinger, p, 3.0), 5.0);
  d = joined_mm(d, bars_mm(kClosed, p, 2.0), 3.0);
  return joined_mm(d, bars_mm(kThumb, p, 4.0), 3.0);
}

// A flat bead, round at its edges.
double cuff_mm(const Vec3& p) {
  const Vec3 u{(p.x - kCuff_mm.x) / 21.0, (p.y - kCuff_mm.y) / 29.0, (p.z - kCuff_mm.z) / 7.0};
  const double round = u.x * u.x + u.y * u.y;
  return 5.0 * (std::sqrt(std::sqrt(round * round + u.z * u.z * u.z * u.z)) - 1.0);
}

// Finer towards the tip.
double hand_edge_ratio(const Vec3& p) { return std::clamp(0.5 + 0.008 * p.z, 0.5, 1.0); }
double cuff_edge_ratio(const Vec3&) { return 1.0; }

}  // namespace

model::Result<Shape> make_hand_shape() {
  const Body hand{hand_mm, hand_edge_ratio, {-35, -45, -8}, {55, 75, 182}, 2.6, {}};
  const Body cuff{cuff_mm, cuff_edge_ratio, {-30, -15, 160}, {30, 65, 195}, 2.6, {}};
  auto both = make_grown(hand, kHandVertices, 0);
  if (!both) return both;
  const auto second = make_grown(cuff, kCuffVertices, 0);
  if (!second) return second.error();
  append(*both, *second);
  return both;
}

}  // namespace tact::tools::make_meshes
