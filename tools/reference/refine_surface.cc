#include "tools/reference/refine_surface.h"

#include <algorithm>
#include <unordered_map>

namespace tact::tools {
namespace {

using model::TriangleCorners;
using model::Vec3;

constexpr std::uint32_t kUnset = 0xFFFFFFFFU;
using Middles = std::unordered_map<std::uint64_t, std::uint32_t>;  // of the edges to split

std::uint64_t key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

/// Edge k joins corners k and (k + 1) % 3. Equal lengths: the smaller key, so neighbours agree.
std::size_t longest_edge(const Triangles& s, const TriangleCorners& t) {
  std::size_t best = 0;
  double best_m2 = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t p = t[k], q = t[(k + 1) % 3];
    const Vec3 e = s.vertex_m[std::min(p, q)] - s.vertex_m[std::max(p, q)];
    const double length_m2 = dot(e, e);
    const bool tie = length_m2 == best_m2 && key(p, q) < key(t[best], t[(best + 1) % 3]);
    if (length_m2 > best_m2 || tie) best = k;
    best_m2 = std::max(best_m2, length_m2);
  }
  return best;
}

Middles edges_to_split(const Triangles& s, const EdgeLengths& lengths) {
  Middles out;
  for (const TriangleCorners& t : s.triangle) {
    const std::size_t k = longest_edge(s, t);
    const Vec3 &p = s.vertex_m[t[k]], &q = s.vertex_m[t[(k + 1) % 3]];
    if (norm(q - p) > lengths.at(0.5 * (p + q))) out[key(t[k], t[(k + 1) % 3])] = kUnset;
  }
  for (bool changed = !out.empty(); changed;) {  // to the neighbours, until all agree
    changed = false;
    for (const TriangleCorners& t : s.triangle) {
      bool touched = false;
      for (std::size_t k = 0; k < 3; ++k) touched |= out.count(key(t[k], t[(k + 1) % 3])) > 0;
      if (!touched) continue;
      const std::size_t k = longest_edge(s, t);
      changed |= out.try_emplace(key(t[k], t[(k + 1) % 3]), kUnset).second;
    }
  }
  return out;
}

std::uint32_t middle_of(Triangles& s, Middles& middles, std::uint32_t p, std::uint32_t q) {
  const auto found = middles.find(key(p, q));
  if (found == middles.end()) return kUnset;
  if (found->second == kUnset) {
    found->second = static_cast<std::uint32_t>(s.vertex_m.size());
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

}  // namespace

Triangles refine_surface(Triangles surface, const EdgeLengths& lengths) {
  for (;;) {
    Middles middles = edges_to_split(surface, lengths);
    if (middles.empty()) return surface;
    split(surface, middles);
  }
}

}  // namespace tact::tools
