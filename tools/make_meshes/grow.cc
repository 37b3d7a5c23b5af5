// SPDX-License-Identifier: Apache-2.0
// From a field to triangles of the wanted size and number: split what is long, collapse what is
// short, flip to Delaunay, centre each vertex in its fan, pull it back to the surface; repeat.
// Then edges are split or collapsed, the worst first, until the counts are met exactly.
//
//     A = (sqrt(3)/2) sum h^2     area of V near equilateral triangles pairs of edge h = s ratio(p)
#include <algorithm>
#include <cmath>

#include "tools/make_meshes/edit.h"
#include "tools/make_meshes/field.h"

namespace tact::tools::make_meshes {
namespace {

using model::cross;
using model::dot;
using model::norm;
using model::Vec3;
using model::contact::TriangleCorners;

constexpr int kRounds = 8;           // of splitting and collapsing to size
constexpr int kRepairs = 4;          // of edges that came out short on the way to the counts
constexpr int kMaxCorrections = 60;  // rounds towards the exact count
constexpr int kPolish = 24;          // rounds of flipping and centring at the end
constexpr int kRimSteps = 8;         // a line settles slower than a surface
constexpr double kLong = 1.40, kShort = 0.72;  // of the wanted length

struct Measured {
  double ratio = 0.0;  // length over wanted length
  Edge edge;
  std::size_t order = 0;  // of the triangles
};

class Grower {
 public:
  Grower(const Body& body, std::size_t vertices)
      : body_(body), editor_(rough_surface(body)), wanted_vertices_(vertices) {}

  model::Result<Shape> grow(std::size_t rim_edges) {
    for (int round = 0; round < kRounds; ++round) {
      set_scale();
      for (const Measured& m : measured(true))
        if (m.ratio > kLong) split(m.edge);
      collapse_short(true);
      settle(2);
    }
    bool met = correct(true, rim_edges);
    for (int round = 0; met && round < kRepairs; ++round) {
      collapse_short(false);  // rims have their number now
      met = correct(false, wanted_vertices_);
    }
    if (!met) {
      return model::Error{
          "a body cannot be cut into the wanted number of triangles; ask for "
          "more vertices or a coarser rim"};
    }
    settle(kPolish);
    flip(3);
    return editor_.shape();
  }

 private:
  double wanted_mm(const Vec3& p) const { return scale_mm_ * body_.edge_ratio(p); }

  void set_scale() {
    double sum = 0.0;
    const auto& p = editor_.vertex_mm();
    for (const TriangleCorners& t : editor_.triangle()) {
      if (t[0] == t[1]) continue;
      const double ratio = body_.edge_ratio((p[t[0]] + p[t[1]] + p[t[2]]) / 3.0);
      sum += 0.5 * norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])) / (ratio * ratio);
    }
    scale_mm_ = std::sqrt(sum / (0.5 * std::sqrt(3.0) * double(wanted_vertices_)));
  }

  double ratio_of(const Edge& e) {
    const auto& p = editor_.vertex_mm();
    return editor_.length_mm(e) / wanted_mm(0.5 * (p[e.a] + p[e.b]));
  }

  // All edges, the longest or the shortest first; equal ones in the order of the triangles.
  std::vector<Measured> measured(bool longest_first) {
    std::vector<Measured> all;
    for (const Edge& e : editor_.edges()) all.push_back({ratio_of(e), e, all.size()});
    std::sort(all.begin(), all.end(), [&](const Measured& m, const Measured& n) {
      if (m.ratio == n.ratio) return m.order < n.order;
      return longest_first ? m.ratio > n.ratio : m.ratio < n.ratio;
    });
    return all;
  }

  bool split(const Edge& e) {
    if (!editor_.is_edge(e.a, e.b)) return false;
    put_on_surface(editor_.split(e.a, e.b), 2);
    return true;
  }

  void collapse_short(bool rims_too) {
    for (const Measured& m : measured(false))
      if (m.ratio < kShort && (rims_too || !m.edge.rim)) collapse(m.edge);
  }

  // False for edges that an earlier collapse has already changed.
  bool collapse(const Edge& e) {
    if (!editor_.is_alive(e.a) || !editor_.is_alive(e.b)) return false;
    if (ratio_of(e) > 1.0) return false;
    return editor_.collapse(e.a, e.b) || editor_.collapse(e.b, e.a);
  }

  std::size_t count(bool rim) const {
    if (!rim) return editor_.vertices();
    std::size_t edges = 0;
    for (const Edge& e : editor_.edges()) edges += e.rim;
    return edges;
  }

  // A small share of the edges in each round, so that the neighbours can make room.
  bool correct(bool rim, std::size_t wanted) {
    for (int round = 0; round < kMaxCorrections; ++round) {
      std::size_t have = count(rim);
      if (have == wanted) return true;
      const bool grow = have < wanted;
      const std::size_t most = std::max<std::size_t>(4, have / 16);
      std::size_t done = 0;
      for (const Measured& m : measured(grow)) {
        if (have == wanted || done == most) break;
        if (m.edge.rim != rim || !(grow ? split(m.edge) : collapse(m.edge))) continue;
        grow ? ++have : --have;
        ++done;
      }
      settle(3);
    }
    return count(rim) == wanted;
  }

  void put_on_surface(std::uint32_t v, int steps) {
    Vec3& p = editor_.vertex_mm()[v];
    if (!editor_.is_on_rim(v)) {
      p = pulled_to_surface(body_.distance_mm, p, steps);
      return;
    }
    const Cut& cut = nearest_cut(body_, p);
    for (int i = 0; i < 2 * steps; ++i) {  // a rim lies on the surface and on its plane
      p = pulled_to_surface(body_.distance_mm, p, 1);
      p -= dot(p - cut.centre_mm, cut.outward) * cut.outward;
    }
  }

  void settle(int rounds) {
    for (int i = 0; i < rounds; ++i) {
      flip(1);
      centre();
    }
  }

  void flip(int passes) {
    for (int i = 0; i < passes; ++i)
      for (const Edge& e : editor_.edges()) editor_.flip_if_better(e.a, e.b);
  }

  // To the centre of the fan. Weights of area / h^4 keep the
  // grading: near small triangles a vertex is drawn as strongly as near large ones.
  void centre() {
    auto& p = editor_.vertex_mm();
    std::vector<Vec3> sum(p.size());
    std::vector<double> weight(p.size(), 0.0);
    for (const TriangleCorners& t : editor_.triangle()) {
      if (t[0] == t[1]) continue;
      const Vec3 middle = (p[t[0]] + p[t[1]] + p[t[2]]) / 3.0;
      const double h = body_.edge_ratio(middle);
      const double area = norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
      for (const std::uint32_t v : t) {
        sum[v] += area / (h * h * h * h) * middle;
        weight[v] += area / (h * h * h * h);
      }
    }
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      if (!(weight[v] > 0.0) || editor_.is_on_rim(v)) continue;
      p[v] += 0.8 * (sum[v] / weight[v] - p[v]);
      put_on_surface(v, 1);
    }
    if (!body_.cuts.empty()) spread_rims();
  }

  // Rim vertices move to the middle of their two neighbours on the rim.
  void spread_rims() {
    auto& p = editor_.vertex_mm();
    std::vector<Edge> rim = editor_.edges();
    std::erase_if(rim, [](const Edge& e) { return !e.rim; });
    for (int i = 0; i < kRimSteps; ++i) {
      std::vector<Vec3> sum(p.size());
      for (const Edge& e : rim) {
        sum[e.a] += p[e.b];
        sum[e.b] += p[e.a];
      }
      for (const Edge& e : rim) {  // each rim vertex starts one rim edge
        p[e.a] += 0.5 * (0.5 * sum[e.a] - p[e.a]);
        put_on_surface(e.a, 1);
      }
    }
  }

  const Body& body_;
  Editor editor_;
  std::size_t wanted_vertices_;
  double scale_mm_ = 1.0;
};

}  // namespace

model::Result<Shape> make_grown(const Body& body, std::size_t vertices, std::size_t rim_edges) {
  return Grower(body, vertices).grow(rim_edges);
}

void append(Shape& shape, const Shape& second) {
  const auto first = static_cast<std::uint32_t>(shape.vertex_mm.size());
  shape.vertex_mm.insert(shape.vertex_mm.end(), second.vertex_mm.begin(), second.vertex_mm.end());
  for (const auto& t : second.triangle)
    shape.triangle.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace tact::tools::make_meshes
