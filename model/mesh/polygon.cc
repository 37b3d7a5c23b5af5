// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/polygon.h"

#include <algorithm>

namespace tact::model::mesh {
namespace {

class EarClipper {
 public:
  EarClipper(std::span<const std::uint32_t> corner, std::span<const Vec3> vertex)
      : left_(corner.begin(), corner.end()), vertex_(vertex) {
    // Newell: n = sum p_i x p_(i+1), taken from the first corner to keep the digits.
    for (std::size_t i = 1; i + 1 < left_.size(); ++i) normal_ += doubled_area(0, i, i + 1);
    normal_ = normalized(normal_);
  }

  void clip(std::vector<contact::TriangleCorners>& triangle) {
    while (left_.size() > 3) {
      std::size_t ear = left_.size();
      double best = 0.0;  // an ear turns with the polygon
      for (std::size_t i = 0; i < left_.size(); ++i) {
        const double round = roundness(i);
        if (round > best && is_empty(i)) {
          best = round;
          ear = i;
        }
      }
      if (ear == left_.size()) break;
      triangle.push_back({left_[before(ear)], left_[ear], left_[after(ear)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (std::size_t i = 1; i + 1 < left_.size(); ++i)
      triangle.push_back({left_[0], left_[i], left_[i + 1]});
  }

 private:
  std::size_t before(std::size_t i) const { return i == 0 ? left_.size() - 1 : i - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == left_.size() ? 0 : i + 1; }
  const Vec3& at(std::size_t i) const { return vertex_[left_[i]]; }
  Vec3 doubled_area(std::size_t a, std::size_t b, std::size_t c) const {
    return cross(at(b) - at(a), at(c) - at(a));
  }

  double roundness(std::size_t i) const {
    const std::size_t a = before(i), c = after(i);
    const Vec3 ab = at(i) - at(a), bc = at(c) - at(i), ca = at(a) - at(c);
    const double longest2 = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
    // Turning against the polygon gives a negative area: no ear.
    return longest2 > 0.0 ? dot(doubled_area(a, i, c), normal_) / longest2 : 0.0;
  }

  // No other corner inside the ear or on its border, seen along the normal.
  bool is_empty(std::size_t i) const {
    const std::size_t a = before(i), c = after(i);
    for (std::size_t other = 0; other < left_.size(); ++other) {
      const std::uint32_t v = left_[other];
      // By vertex, not by place: a polygon with a slit names a vertex twice.
      if (v == left_[a] || v == left_[i] || v == left_[c]) continue;
      if (dot(doubled_area(a, i, other), normal_) >= 0.0 &&
          dot(doubled_area(i, c, other), normal_) >= 0.0 &&
          dot(doubled_area(c, a, other), normal_) >= 0.0) {
        return false;
      }
    }
    return true;
  }

  std::vector<std::uint32_t> left_;  // corners not yet cut off
  std::span<const Vec3> vertex_;
  Vec3 normal_;
};

}  // namespace

void cut_polygon(std::span<const std::uint32_t> corner, std::span<const Vec3> vertex,
                 std::vector<contact::TriangleCorners>& triangle) {
  if (corner.size() == 3)
    triangle.push_back({corner[0], corner[1], corner[2]});
  else
    EarClipper(corner, vertex).clip(triangle);
}

}  // namespace tact::model::mesh
