// SPDX-License-Identifier: Apache-2.0
#include "tools/make_meshes/edit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tact::tools::make_meshes {
namespace {

using model::cross;
using model::dot;
using model::Vec3;
using model::contact::TriangleCorners;

constexpr double kMinTurn = 0.3;  // cosine between normals before and after an edit

bool has(const TriangleCorners& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

bool same_way(const Vec3& n, const Vec3& m) { return dot(n, m) > kMinTurn * norm(n) * norm(m); }

double cotangent(const Vec3& tip, const Vec3& a, const Vec3& b) {
  return dot(a - tip, b - tip) / norm(cross(a - tip, b - tip));
}

}  // namespace

Editor::Editor(Shape shape)
    : vertex_mm_(std::move(shape.vertex_mm)),
      triangle_(std::move(shape.triangle)),
      fan_(vertex_mm_.size()),
      on_rim_(vertex_mm_.size(), true),  // not known yet
      vertices_(vertex_mm_.size()) {
  for (std::uint32_t t = 0; t < triangle_.size(); ++t)
    for (const std::uint32_t v : triangle_[t]) fan_[v].push_back(t);
  const std::vector<Edge> all = edges();
  on_rim_.assign(vertex_mm_.size(), false);
  for (const Edge& e : all)
    if (e.rim) on_rim_[e.a] = on_rim_[e.b] = true;
}

Editor::Pair Editor::between(std::uint32_t a, std::uint32_t b) const {
  Pair found;
  for (const std::uint32_t t : fan_[a]) {
    if (has(triangle_[t], b)) found.triangle[found.count++] = t;
    if (found.count == 2) break;
  }
  return found;
}

std::vector<std::uint32_t> Editor::around(std::uint32_t v) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : fan_[v]) {
    for (const std::uint32_t w : triangle_[t])
      if (w != v) found.push_back(w);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::uint32_t Editor::across(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t v : triangle_[t])
    if (v != a && v != b) return v;
  return a;
}

void Editor::replace(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
  std::replace(triangle_[t].begin(), triangle_[t].end(), from, to);
}

void Editor::leave(std::uint32_t v, std::uint32_t t) {
  fan_[v].erase(std::find(fan_[v].begin(), fan_[v].end(), t));
}

std::vector<Edge> Editor::edges() const {
  std::vector<Edge> found;
  for (const TriangleCorners& t : triangle_) {
    if (t[0] == t[1]) continue;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = t[e], b = t[(e + 1) % 3];
      const bool rim = on_rim_[a] && on_rim_[b] && between(a, b).count == 1;
      if (a < b || rim) found.push_back({a, b, rim});
    }
  }
  return found;
}

std::uint32_t Editor::split(std::uint32_t a, std::uint32_t b) {
  const auto middle = static_cast<std::uint32_t>(vertex_mm_.size());
  const Pair old = between(a, b);
  vertex_mm_.push_back(0.5 * (vertex_mm_[a] + vertex_mm_[b]));
  fan_.emplace_back();
  on_rim_.push_back(old.count == 1);
  ++vertices_;
  for (std::size_t i = 0; i < old.count; ++i) {  // t keeps a, the new one gets b
    const std::uint32_t t = old.triangle[i];
    const auto fresh = static_cast<std::uint32_t>(triangle_.size());
    triangle_.push_back(triangle_[t]);
    replace(t, b, middle);
    replace(fresh, a, middle);
    leave(b, t);
    fan_[b].push_back(fresh);
    fan_[across(t, a, middle)].push_back(fresh);
    fan_[middle].insert(fan_[middle].end(), {t, fresh});
  }
  return middle;
}

bool Editor::keeps_facing(std::uint32_t gone, std::uint32_t kept) const {
  const auto normal = [&](const TriangleCorners& t) {
    const auto at = [&](std::uint32_t v) { return vertex_mm_[v]; };
    return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
  };
  return std::all_of(fan_[gone].begin(), fan_[gone].end(), [&](std::uint32_t t) {
    TriangleCorners moved = triangle_[t];
    if (has(moved, kept)) return true;
    std::replace(moved.begin(), moved.end(), gone, kept);
    const Vec3 before = normal(triangle_[t]), after = normal(moved);
    return norm(after) > 0.0 && (norm(before) <= 1e-9 || same_way(before, after));
  });
}

bool Editor::collapse(std::uint32_t gone, std::uint32_t kept) {
  const Pair lost = between(gone, kept);
  if (lost.count == 0 || (on_rim_[gone] && lost.count != 1)) return false;
  // The ends may share no neighbour but the tips of the lost triangles, and those keep a fan.
  const std::vector<std::uint32_t> here = around(gone), there = around(kept);
  std::vector<std::uint32_t> common;
  std::set_intersection(here.begin(), here.end(), there.begin(), there.end(),
                        std::back_inserter(common));
  if (common.size() != lost.count) return false;
  for (const std::uint32_t tip : common)
    if (fan_[tip].size() <= (on_rim_[tip] ? 2u : 4u)) return false;
  if (on_rim_[gone] && here.size() + there.size() < 7) return false;
  if (!keeps_facing(gone, kept)) return false;
  for (std::size_t i = 0; i < lost.count; ++i) {
    const std::uint32_t t = lost.triangle[i];
    const TriangleCorners corners = triangle_[t];
    for (const std::uint32_t v : corners) leave(v, t);
    triangle_[t] = {0, 0, 0};
  }
  for (const std::uint32_t t : fan_[gone]) {
    replace(t, gone, kept);
    fan_[kept].push_back(t);
  }
  fan_[gone].clear();
  --vertices_;
  return true;
}

bool Editor::flip_if_better(std::uint32_t a, std::uint32_t b) {
  const Pair pair = between(a, b);
  if (pair.count != 2) return false;
  std::uint32_t near = pair.triangle[0], far = pair.triangle[1];
  const auto follows = [&](const TriangleCorners& t) {  // runs from a to b
    return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
  };
  if (!follows(triangle_[near])) std::swap(near, far);
  const std::uint32_t c = across(near, a, b), d = across(far, a, b);
  for (const std::uint32_t v : {a, b})
    if (fan_[v].size() <= (on_rim_[v] ? 2u : 4u)) return false;
  if (is_edge(c, d)) return false;
  // Delaunay: the angles that face the edge add up to at most 180 degrees, cot c + cot d >= 0.
  if (!(cotangent(vertex_mm_[c], vertex_mm_[a], vertex_mm_[b]) +
            cotangent(vertex_mm_[d], vertex_mm_[a], vertex_mm_[b]) <
        -1e-9))
    return false;
  const Vec3 before = cross(vertex_mm_[b] - vertex_mm_[a], vertex_mm_[c] - vertex_mm_[a]) +
                      cross(vertex_mm_[d] - vertex_mm_[a], vertex_mm_[b] - vertex_mm_[a]);
  const Vec3 left = cross(vertex_mm_[d] - vertex_mm_[a], vertex_mm_[c] - vertex_mm_[a]);
  const Vec3 right = cross(vertex_mm_[b] - vertex_mm_[d], vertex_mm_[c] - vertex_mm_[d]);
  if (!same_way(before, left) || !same_way(before, right)) return false;
  triangle_[near] = {a, d, c};
  triangle_[far] = {d, b, c};
  leave(b, near);
  leave(a, far);
  fan_[d].push_back(near);
  fan_[c].push_back(far);
  return true;
}

Shape Editor::shape() const {
  Shape packed;
  std::vector<std::uint32_t> place(vertex_mm_.size(), 0);
  for (std::uint32_t v = 0; v < vertex_mm_.size(); ++v) {
    if (!is_alive(v)) continue;
    place[v] = static_cast<std::uint32_t>(packed.vertex_mm.size());
    packed.vertex_mm.push_back(vertex_mm_[v]);
  }
  for (const TriangleCorners& t : triangle_)
    if (t[0] != t[1]) packed.triangle.push_back({place[t[0]], place[t[1]], place[t[2]]});
  return packed;
}

}  // namespace tact::tools::make_meshes
