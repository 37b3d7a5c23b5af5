// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/organ/refine_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::reference {
namespace {

using model::Vec3;
using model::contact::TriangleCorners;
using model::fem::edge_key;

constexpr std::uint32_t kUnset = 0xFFFFFFFFU;
// Two rounds halve a triangle's edges: from 0.1 m to 0.1 um, far below any tool.
constexpr int kMaxRounds = 40;
constexpr std::size_t kMaxTriangles = 1000000;  // gmsh would need days for the body of more
using Middles = std::unordered_map<std::uint64_t, std::uint32_t>;  // of the edges to split

/// Edge k joins corners k and (k + 1) % 3. Equal lengths: the smaller key, so neighbours agree.
std::size_t longest_edge(const Triangles& s, const TriangleCorners& t) {
  std::size_t best = 0;
  double best_m2 = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t p = t[k], q = t[(k + 1) % 3];
    const Vec3 e = s.vertex_m[std::min(p, q)] - s.vertex_m[std::max(p, q)];
    const double length_m2 = dot(e, e);
    const bool tie = length_m2 == best_m2 && edge_key(p, q) < edge_key(t[best], t[(best + 1) % 3]);
    if (length_m2 > best_m2 || tie) best = k;
    best_m2 = std::max(best_m2, length_m2);
  }
  return best;
}

Middles edges_to_split(const Triangles& s, const ground_truth::EdgeLengths& lengths) {
  Middles out;
  for (const TriangleCorners& t : s.triangle) {
    const std::size_t k = longest_edge(s, t);
    const Vec3 &p = s.vertex_m[t[k]], &q = s.vertex_m[t[(k + 1) % 3]];
    // The longest edge only: the others follow in later rounds (Rivara).
    if (norm(q - p) > lengths.at(0.5 * (p + q))) out[edge_key(t[k], t[(k + 1) % 3])] = kUnset;
  }
  for (bool changed = !out.empty(); changed;) {  // to the neighbours, until all agree
    changed = false;
    for (const TriangleCorners& t : s.triangle) {
      bool touched = false;
      for (std::size_t k = 0; k < 3; ++k) touched |= out.count(edge_key(t[k], t[(k + 1) % 3])) > 0;
      if (!touched) continue;
      const std::size_t k = longest_edge(s, t);
      changed |= out.try_emplace(edge_key(t[k], t[(k + 1) % 3]), kUnset).second;
    }
  }
  return out;
}

std::uint32_t middle_of(Triangles& s, Middles& middles, std::uint32_t p, std::uint32_t q) {
  const auto found = middles.find(edge_key(p, q));
  if (found == middles.end()) return kUnset;
  if (found->second == kUnset) {
    found->second = static_cast<std::uint32_t>(s.vertex_m.size());
    // In the order of the numbers: the same bits, whichever triangle comes first.
    s.vertex_m.push_back(0.5 * (s.vertex_m[std::min(p, q)] + s.vertex_m[std::max(p, q)]));
  }
  return found->second;
}

/// a, b, c in their sense of rotation; edge c-a or b-c may carry a middle.
void add_half(std::vector<TriangleCorners>& out, std::uint32_t apex, std::uint32_t p,
              std::uint32_t q, std::uint32_t middle_pq) {
  if (middle_pq == kUnset) {
    out.push_back({apex, p, q});
    return;
  }
  out.push_back({apex, p, middle_pq});
  out.push_back({apex, middle_pq, q});
}

void split(Triangles& s, Middles& middles) {
  std::vector<TriangleCorners> out;
  out.reserve(s.triangle.size() * 2);
  const std::vector<TriangleCorners> old = std::move(s.triangle);
  for (const TriangleCorners& t : old) {
    const std::size_t k = longest_edge(s, t);
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    const std::uint32_t m = middle_of(s, middles, a, b);
    if (m == kUnset) {
      out.push_back(t);
      continue;
    }
    // The halves (m, b, c) and (m, c, a): each keeps one of the other two edges.
    add_half(out, m, b, c, middle_of(s, middles, b, c));
    add_half(out, m, c, a, middle_of(s, middles, c, a));
  }
  s.triangle = std::move(out);
}

/// Cuts one triangle that no edge leaves twice: `side` is -1, 0 or 1 at each corner.
void cut(Triangles& s, Middles& cuts, const Circle& circle, const TriangleCorners& t,
         const std::vector<int>& side, std::vector<TriangleCorners>& out) {
  const auto crossing = [&](std::uint32_t p, std::uint32_t q) {
    const auto [at, is_new] = cuts.try_emplace(edge_key(p, q), kUnset);
    if (!is_new) return at->second;
    const Vec3 a = s.vertex_m[std::min(p, q)], b = s.vertex_m[std::max(p, q)];
    double low = 0.0, high = 1.0;  // along a to b; the distance from the axis may be curved
    const bool starts_inside = circle.away_m(a) < circle.radius_m;
    for (int i = 0; i < 50; ++i) {
      const double half = 0.5 * (low + high);
      const bool inside = circle.away_m(a + half * (b - a)) < circle.radius_m;
      (inside == starts_inside ? low : high) = half;
    }
    at->second = static_cast<std::uint32_t>(s.vertex_m.size());
    s.vertex_m.push_back(a + low * (b - a));
    return at->second;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    if (side[a] == 0 && side[b] * side[c] < 0) {  // from a corner through the edge opposite
      const std::uint32_t m = crossing(b, c);
      out.push_back({a, b, m});
      out.push_back({a, m, c});
      return;
    }
    if (side[a] * side[b] < 0 && side[a] * side[c] < 0) {  // cuts corner a off
      const std::uint32_t m = crossing(a, b), n = crossing(c, a);
      out.push_back({a, m, n});
      out.push_back({m, b, c});
      out.push_back({m, c, n});
      return;
    }
  }
  out.push_back(t);
}

}  // namespace

double Circle::away_m(const Vec3& p_m) const {
  const Vec3 r = p_m - at_m;
  return norm(r - dot(r, axis) * axis);
}

Triangles cut_along(Triangles surface, const Circle& circle, double reach_m) {
  constexpr double kNear = 0.2;  // of the shortest edge at a vertex
  std::vector<double> shortest_m(surface.vertex_m.size(), 1e9);
  for (const TriangleCorners& t : surface.triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = t[k], q = t[(k + 1) % 3];
      const double length_m = norm(surface.vertex_m[p] - surface.vertex_m[q]);
      shortest_m[p] = std::min(shortest_m[p], length_m);
      shortest_m[q] = std::min(shortest_m[q], length_m);
    }
  }
  std::vector<int> side(surface.vertex_m.size(), 0);  // 0 far away too: nothing is cut there
  for (std::size_t i = 0; i < side.size(); ++i) {
    const double beyond_m = circle.away_m(surface.vertex_m[i]) - circle.radius_m;
    // The cylinder meets the far side of the organ, too.
    if (norm(surface.vertex_m[i] - circle.at_m) > reach_m) continue;
    if (std::abs(beyond_m) > kNear * shortest_m[i]) side[i] = beyond_m < 0.0 ? -1 : 1;
  }
  Middles cuts;
  std::vector<TriangleCorners> out;
  const std::vector<TriangleCorners> old = std::move(surface.triangle);
  for (const TriangleCorners& t : old) cut(surface, cuts, circle, t, side, out);
  surface.triangle = std::move(out);
  return surface;
}

model::Result<Triangles> refine_surface(Triangles surface,
                                        const ground_truth::EdgeLengths& lengths) {
  const bool has_goal = lengths.fine_m > 0.0;  // a NaN is none
  for (int round = 0; has_goal && round < kMaxRounds && surface.triangle.size() < kMaxTriangles;
       ++round) {
    if (program::is_interrupted()) return program::interruption();
    Middles middles = edges_to_split(surface, lengths);
    if (middles.empty()) return surface;
    split(surface, middles);
  }
  return model::Error{
      fmt::format("the surface around ({:.4g}, {:.4g}, {:.4g}) m cannot be refined to edges of "
                  "{:.3g} m; ask for a larger depth or a larger tool radius",
                  lengths.at_m.x, lengths.at_m.y, lengths.at_m.z, lengths.fine_m)};
}

}  // namespace tact::tools::reference
