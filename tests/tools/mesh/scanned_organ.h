// SPDX-License-Identifier: Apache-2.0
// scanned_organ.h - an organ as a scanner and a segmentation give it, with what is wrong with it.
//
// The zero of a sum of round bumps on a grid of 0.9 mm, cut into tetrahedra: a closed surface with
// the steps of voxels, open where the scan ends. Around it islands of noise, on it splinters that
// share an edge with it, doubled faces and faces that are missing; millimetres, with the scanner's
// origin more than a metre away.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>
#include <vector>

#include "model/contact/surface.h"
#include "model/types.h"

namespace tact::tests {

inline constexpr model::Vec3 kScannerOffset_mm{-110.3, -205.1, -1310.7};

struct Soup {
  std::vector<model::Vec3> vertex;
  std::vector<model::contact::TriangleCorners> triangle;
};

/// The organ alone: of the whole volume the part that lies in the scan.
class ScannedOrgan {
 public:
  explicit ScannedOrgan(int cells) : n_(cells + 1) {
    value_.resize(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_) *
                  static_cast<std::size_t>(n_));
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j)
        for (int k = 0; k < n_; ++k) value_[at(i, j, k)] = organ(place(i, j, k));
  }

  /// Balls of about 3 cells where nothing is, on a coarse lattice: `count` of them.
  void add_islands(int count) {
    for (int i = 4; i + 4 < n_; i += 7)
      for (int j = 4; j + 4 < n_; j += 7)
        for (int k = 4; k + 4 < n_; k += 7) {
          if (count == 0 || organ(place(i, j, k)) > -0.25) continue;
          --count;
          for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
              for (int z = -2; z <= 2; ++z)
                value_[at(i + x, j + y, k + z)] = 1.6 - std::sqrt(x * x + y * y + z * z);
        }
  }

  Soup surface() {
    Soup soup;
    for (int i = 0; i + 1 < n_; ++i)
      for (int j = 0; j + 1 < n_; ++j)
        for (int k = 0; k + 1 < n_; ++k) cut_cell(i, j, k, soup);
    return soup;
  }

 private:
  static constexpr double kCell_mm = 0.9;

  std::size_t at(int i, int j, int k) const {
    const auto n = static_cast<std::size_t>(n_);
    return (static_cast<std::size_t>(i) * n + static_cast<std::size_t>(j)) * n +
           static_cast<std::size_t>(k);
  }
  model::Vec3 place(int i, int j, int k) const {
    return kCell_mm *
           model::Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
  }

  /// Above 0 inside. Its lower end lies beyond the scan.
  double organ(const model::Vec3& p) const {
    const double size = kCell_mm * n_;
    double sum = -0.5;
    for (const auto& [x, y, z, radius] :
         {std::array{0.5, 0.5, 0.0, 0.22}, std::array{0.42, 0.5, 0.3, 0.2},
          std::array{0.6, 0.45, 0.5, 0.2}, std::array{0.45, 0.62, 0.6, 0.16},
          std::array{0.5, 0.35, 0.68, 0.12}}) {
      const model::Vec3 d = (p - size * model::Vec3{x, y, z}) / (size * radius);
      sum += std::exp(-dot(d, d));
    }
    return sum;
  }

  void cut_cell(int i, int j, int k, Soup& soup) {
    // Six tetrahedra around the diagonal from corner 0 to corner 7.
    static constexpr std::array<std::array<int, 2>, 6> kPaths{
        {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
    for (const auto& [b, c] : kPaths) {
      std::array<std::size_t, 4> corner{};
      const std::array<int, 4> number{0, b, c, 7};
      for (std::size_t v = 0; v < 4; ++v)
        corner[v] = at(i + (number[v] & 1), j + ((number[v] >> 1) & 1), k + (number[v] >> 2));
      cut_tetrahedron(corner, soup);
    }
  }

  void cut_tetrahedron(const std::array<std::size_t, 4>& corner, Soup& soup) {
    std::vector<std::size_t> in, out;
    for (const std::size_t c : corner) (value_[c] > 0.0 ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    std::vector<std::uint32_t> ring;  // corners of the cut, in turn
    if (in.size() == 2)
      for (const auto& [a, b] : {std::array<int, 2>{0, 0}, {0, 1}, {1, 1}, {1, 0}})
        ring.push_back(
            crossing(in[static_cast<std::size_t>(a)], out[static_cast<std::size_t>(b)], soup));
    else
      for (const std::size_t a : in)
        for (const std::size_t b : out) ring.push_back(crossing(a, b, soup));
    const auto& v = soup.vertex;
    const model::Vec3 normal = cross(v[ring[1]] - v[ring[0]], v[ring[2]] - v[ring[0]]);
    const bool outwards = dot(normal, of(out[0]) - of(in[0])) > 0.0;
    for (std::size_t c = 1; c + 1 < ring.size(); ++c)
      soup.triangle.push_back(outwards
                                  ? model::contact::TriangleCorners{ring[0], ring[c], ring[c + 1]}
                                  : model::contact::TriangleCorners{ring[0], ring[c + 1], ring[c]});
  }

  model::Vec3 of(std::size_t corner) const {
    const auto n = static_cast<std::size_t>(n_);
    return place(static_cast<int>(corner / (n * n)), static_cast<int>(corner / n % n),
                 static_cast<int>(corner % n));
  }

  std::uint32_t crossing(std::size_t a, std::size_t b, Soup& soup) {
    if (a > b) std::swap(a, b);
    const auto [known, is_new] = vertex_of_.try_emplace(
        a * value_.size() + b, static_cast<std::uint32_t>(soup.vertex.size()));
    if (is_new) {
      // Never at a corner, where triangles would have no area.
      const double t = std::clamp(value_[a] / (value_[a] - value_[b]), 0.1, 0.9);
      soup.vertex.push_back(of(a) + t * (of(b) - of(a)) + kScannerOffset_mm);
    }
    return known->second;
  }

  int n_;
  std::vector<double> value_;
  std::unordered_map<std::size_t, std::uint32_t> vertex_of_;
};

/// What a segmentation does to a surface, on `each` triangles of it.
inline void spoil(Soup& soup, std::size_t each) {
  const std::size_t step = soup.triangle.size() / (4 * each);
  for (std::size_t i = 0; i < each; ++i) {
    const auto corner = soup.triangle[4 * i * step];
    const model::Vec3 a = soup.vertex[corner[0]], b = soup.vertex[corner[1]],
                      c = soup.vertex[corner[2]];
    const model::Vec3 normal = normalized(cross(b - a, c - a)),
                      aside = normalized(cross(normal, b - a));
    // A splinter on an edge, which has four triangles then.
    const auto p = static_cast<std::uint32_t>(soup.vertex.size()), q = p + 1;
    soup.vertex.push_back(0.5 * (a + b) + normal + 0.4 * aside);
    soup.vertex.push_back(0.5 * (a + b) + normal - 0.4 * aside);
    soup.triangle.push_back({corner[0], corner[1], p});
    soup.triangle.push_back({corner[1], corner[0], q});
    soup.triangle.push_back({corner[0], p, q});
    soup.triangle.push_back({corner[1], q, p});
    soup.triangle.push_back(soup.triangle[(4 * i + 1) * step]);  // doubled
    std::swap(soup.triangle[(4 * i + 2) * step][0], soup.triangle[(4 * i + 2) * step][1]);
    soup.triangle[(4 * i + 3) * step][2] = soup.triangle[(4 * i + 3) * step][1];  // no area
  }
}

/// Binary STL: no vertex is shared, numbers are float.
inline std::string as_stl(const Soup& soup) {
  std::string bytes(80, ' ');
  const auto put = [&bytes](const auto& value) {
    std::array<char, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    bytes.append(raw.data(), raw.size());
  };
  put(static_cast<std::uint32_t>(soup.triangle.size()));
  for (const auto& corners : soup.triangle) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const std::uint32_t v : corners)
      for (const double x : {soup.vertex[v].x, soup.vertex[v].y, soup.vertex[v].z})
        put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  return bytes;
}

inline std::string as_obj(const Soup& soup) {
  std::string text;
  for (const model::Vec3& p : soup.vertex) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (const auto& t : soup.triangle)
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace tact::tests
