// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/calculix/rigid_ball.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tact::tools::reference {
namespace {

using model::Vec3;
using model::contact::TriangleCorners;

constexpr int kHalvings = 3;     // of an octahedron's edges: 0.2 R
constexpr double kBack = -0.5;   // cosine to the pole, beyond which nothing can touch
constexpr double kInner = 0.8;   // of the radius
constexpr double kMiddle = 0.9;  // of the radius

/// Points on the unit sphere, each once.
struct Sphere {
  std::vector<Vec3> point{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> between;

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] = between.try_emplace(std::minmax(a, b), point.size());
    if (is_new) point.push_back(normalized(point[a] + point[b]));
    return at->second;
  }
};

std::vector<TriangleCorners> halved(const std::vector<TriangleCorners>& triangles, Sphere& sphere) {
  std::vector<TriangleCorners> out;
  for (const auto& [a, b, c] : triangles) {
    const std::uint32_t ab = sphere.middle(a, b), bc = sphere.middle(b, c),
                        ca = sphere.middle(c, a);
    out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return out;
}

/// A copy of the sphere's points, made as they are asked for.
class Layer {
 public:
  Layer(const Sphere& sphere, double radius_m, RigidBall& ball)
      : sphere_(sphere), radius_m_(radius_m), ball_(ball) {}

  std::uint32_t node(std::uint32_t point) {
    const auto [at, is_new] = node_.try_emplace(point, ball_.node_m.size());
    if (is_new) ball_.node_m.push_back(radius_m_ * sphere_.point[point]);
    return at->second;
  }

 private:
  const Sphere& sphere_;
  double radius_m_;
  RigidBall& ball_;
  std::map<std::uint32_t, std::uint32_t> node_;
};

}  // namespace

RigidBall make_rigid_ball(double radius_m) {
  Sphere sphere;
  std::vector<TriangleCorners> triangles{{0, 1, 2}, {0, 2, 4}, {0, 4, 5}, {0, 5, 1},
                                         {3, 2, 1}, {3, 4, 2}, {3, 5, 4}, {3, 1, 5}};
  for (int i = 0; i < kHalvings; ++i) triangles = halved(triangles, sphere);
  RigidBall ball;
  // All nodes move by one vector: the inner layers only give the wedges their thickness.
  Layer inner(sphere, kInner * radius_m, ball), outer(sphere, radius_m, ball),
      middle(sphere, kMiddle * radius_m, ball);
  for (const auto& [a, b, c] : triangles) {
    if ((sphere.point[a].x + sphere.point[b].x + sphere.point[c].x) / 3.0 < kBack) continue;
    const std::array<std::uint32_t, 6> face{
        a, b, c, sphere.middle(a, b), sphere.middle(b, c), sphere.middle(c, a)};
    WedgeNodes wedge{};
    for (std::size_t k = 0; k < 3; ++k) {
      wedge[k] = inner.node(face[k]);
      wedge[3 + k] = outer.node(face[k]);
      wedge[6 + k] = inner.node(face[3 + k]);
      wedge[9 + k] = outer.node(face[3 + k]);
      wedge[12 + k] = middle.node(face[k]);
    }
    ball.wedge.push_back(wedge);
  }
  return ball;
}

}  // namespace tact::tools::reference
