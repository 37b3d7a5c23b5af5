// SPDX-License-Identifier: Apache-2.0
// edit.h - a triangle surface under change: edges are split, collapsed and flipped.
//
// Every edit keeps the surface sound (at most two triangles on an edge, one fan round a vertex) and
// refuses where it would not. Removed vertices and triangles stay as gaps until shape() packs them.
#pragma once

#include <array>

#include "tools/make_meshes/meshes.h"

namespace tact::tools::make_meshes {

struct Edge {
  std::uint32_t a = 0, b = 0;
  bool rim = false;  // one triangle only
};

class Editor {
 public:
  explicit Editor(Shape shape);

  std::vector<model::Vec3>& vertex_mm() { return vertex_mm_; }
  const std::vector<model::contact::TriangleCorners>& triangle() const { return triangle_; }
  const std::vector<std::uint32_t>& fan(std::uint32_t v) const { return fan_[v]; }
  bool is_alive(std::uint32_t v) const { return !fan_[v].empty(); }
  bool is_on_rim(std::uint32_t v) const { return on_rim_[v]; }
  std::size_t vertices() const { return vertices_; }
  double length_mm(const Edge& e) const { return norm(vertex_mm_[e.b] - vertex_mm_[e.a]); }

  /// Each edge once, in the order of the triangles.
  std::vector<Edge> edges() const;

  /// Both ends are there and still joined.
  bool is_edge(std::uint32_t a, std::uint32_t b) const { return between(a, b).count > 0; }

  /// A new vertex in the middle of the edge; its number.
  std::uint32_t split(std::uint32_t a, std::uint32_t b);

  /// `gone` moves to `kept` and both become one vertex. False, and no change, where the surface
  /// would tear, fold or lose a rim.
  bool collapse(std::uint32_t gone, std::uint32_t kept);

  /// The other diagonal of the two triangles at an edge, where Delaunay asks for it.
  bool flip_if_better(std::uint32_t a, std::uint32_t b);

  Shape shape() const;

 private:
  struct Pair {  // the triangles at an edge
    std::array<std::uint32_t, 2> triangle{};
    std::size_t count = 0;
  };
  Pair between(std::uint32_t a, std::uint32_t b) const;
  std::vector<std::uint32_t> around(std::uint32_t v) const;
  std::uint32_t across(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;
  void replace(std::uint32_t t, std::uint32_t from, std::uint32_t to);
  void leave(std::uint32_t v, std::uint32_t t);
  bool keeps_facing(std::uint32_t gone, std::uint32_t kept) const;

  std::vector<model::Vec3> vertex_mm_;                     // mm
  std::vector<model::contact::TriangleCorners> triangle_;  // a removed one has three equal corners
  std::vector<std::vector<std::uint32_t>> fan_;            // triangles round each vertex
  std::vector<bool> on_rim_;
  std::size_t vertices_ = 0;
};

}  // namespace tact::tools::make_meshes
