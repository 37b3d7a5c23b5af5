// SPDX-License-Identifier: Apache-2.0
// tet_blocks.h - blocks of quadratic tetrahedra for tests: six to a cell, all round one diagonal.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "model/fem/tet_mesh.h"

namespace tact::tests {

/// Corners of the cells at every combination of the three ascending lists, m.
inline model::fem::TetMesh tet_block(const std::vector<double>& x, const std::vector<double>& y,
                                     const std::vector<double>& z) {
  model::fem::TetMesh mesh;
  const auto number = [&](std::size_t i, std::size_t j, std::size_t k) {
    return static_cast<std::uint32_t>((k * y.size() + j) * x.size() + i);
  };
  for (const double c : z)
    for (const double b : y)
      for (const double a : x) mesh.node_m.push_back({a, b, c});
  constexpr std::array<std::array<std::size_t, 3>, 6> kWays{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::vector<std::array<std::uint32_t, 4>> corners;
  for (std::size_t k = 0; k + 1 < z.size(); ++k)
    for (std::size_t j = 0; j + 1 < y.size(); ++j)
      for (std::size_t i = 0; i + 1 < x.size(); ++i)
        for (std::size_t w = 0; w < kWays.size(); ++w) {
          std::array<std::size_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> c{number(i, j, k)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[kWays[w][step]];
            c[step + 1] = number(at[0], at[1], at[2]);
          }
          if (w >= 3) std::swap(c[2], c[3]);  // odd permutations are inside out
          corners.push_back(c);
        }
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middle;
  const auto middle_of = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)},
                                                 static_cast<std::uint32_t>(mesh.node_m.size()));
    if (is_new) mesh.node_m.push_back(0.5 * (mesh.node_m[a] + mesh.node_m[b]));
    return at->second;
  };
  for (const auto& c : corners)
    mesh.element.push_back({c[0], c[1], c[2], c[3], middle_of(c[0], c[1]), middle_of(c[1], c[2]),
                            middle_of(c[2], c[0]), middle_of(c[0], c[3]), middle_of(c[1], c[3]),
                            middle_of(c[2], c[3])});
  return mesh;
}

/// 0, length / cells, ..., length.
inline std::vector<double> even_steps(double length_m, int cells) {
  std::vector<double> out;
  for (int i = 0; i <= cells; ++i) out.push_back(length_m * i / cells);
  return out;
}

}  // namespace tact::tests
