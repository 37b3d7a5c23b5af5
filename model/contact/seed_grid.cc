// SPDX-License-Identifier: Apache-2.0
#include "model/contact/seed_grid.h"

#include <algorithm>
#include <limits>

namespace tact::model::contact {
namespace {

// Along the longest edge: 64^3 cells of two numbers are 2 MB.
constexpr double kMaxCells = 64.0;

// Clamped: a tool far outside still gets the nearest cell.
std::uint32_t axis_cell(double p, double low, double cell, std::uint32_t size) RT_SAFE {
  const double k = (p - low) / cell;
  // NaN, too.
  if (!(k > 0.0)) return 0;
  return k < static_cast<double>(size) ? static_cast<std::uint32_t>(k) : size - 1;
}

struct Extent {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

  void cover(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
};

// Fills a grid from its surface: cells that triangles cross first, the others from their
// neighbours.
class Seeder {
 public:
  Seeder(const SurfaceView& surface, SeedGrid& grid)
      : surface_(surface), grid_(grid), view_(grid.view()) {
    const std::size_t cells = grid.cell.size();
    for (auto& d : distance_m_) d.assign(cells, std::numeric_limits<double>::infinity());
  }

  void fill() {
    // Twice, as the second seed of a cell must face away from the first one that has won.
    for (std::uint32_t t = 0; t < surface_.triangle.size(); ++t) offer_to_crossed_cells(t, 0);
    for (std::uint32_t t = 0; t < surface_.triangle.size(); ++t) offer_to_crossed_cells(t, 1);
    // There and back a seed reaches every cell; the second
    // time mends what the first brought round a corner.
    for (int sweep = 0; sweep < 2; ++sweep) {
      const auto n = static_cast<std::uint32_t>(grid_.cell.size());
      for (std::uint32_t i = 0; i < n; ++i) offer_from_neighbours(i);
      for (std::uint32_t i = n; i-- > 0;) offer_from_neighbours(i);
    }
  }

 private:
  Vec3 centre(std::uint32_t i) const {
    const auto& [nx, ny, nz] = view_.size;
    const std::uint32_t x = i % nx, y = (i / nx) % ny, z = i / (nx * ny);
    return view_.low_m + view_.cell_m * Vec3{x + 0.5, y + 0.5, z + 0.5};
  }

  void offer(std::uint32_t cell, std::uint32_t triangle, std::size_t rank) {
    const TriangleCorners& corner = surface_.triangle[triangle];
    const Vec3 middle = (surface_.vertex_m[corner[0]] + surface_.vertex_m[corner[1]] +
                         surface_.vertex_m[corner[2]]) /
                        3.0;
    // By the middle of the triangle: near enough for a start, the walk does the rest.
    const double d = norm(centre(cell) - middle);
    if (d >= distance_m_[rank][cell]) return;
    distance_m_[rank][cell] = d;
    grid_.cell[cell][rank] = triangle;
  }

  void offer_to_crossed_cells(std::uint32_t t, std::size_t rank) {
    Extent box;
    for (const std::uint32_t v : surface_.triangle[t]) box.cover(surface_.vertex_m[v]);
    const auto& [nx, ny, nz] = view_.size;
    const std::uint32_t from = view_.cell_of(box.low), to = view_.cell_of(box.high);
    for (std::uint32_t z = from / (nx * ny); z <= to / (nx * ny); ++z)
      for (std::uint32_t y = (from / nx) % ny; y <= (to / nx) % ny; ++y)
        for (std::uint32_t x = from % nx; x <= to % nx; ++x) {
          const std::uint32_t cell = x + nx * (y + ny * z);
          if (rank == 0 || faces_away(t, grid_.cell[cell][0])) offer(cell, t, rank);
        }
  }

  bool faces_away(std::uint32_t a, std::uint32_t b) const {
    return dot(surface_.face_normal[a], surface_.face_normal[b]) < 0.0;
  }

  void offer_from_neighbours(std::uint32_t cell) {
    const auto& [nx, ny, nz] = view_.size;
    const std::uint32_t x = cell % nx, y = (cell / nx) % ny, z = cell / (nx * ny);
    const auto take = [&](bool inside, std::uint32_t neighbour) {
      if (!inside) return;
      const std::uint32_t seed = grid_.cell[neighbour][0];
      if (seed != kNoTriangle) offer(cell, seed, 0);
    };
    take(x > 0, cell - 1), take(x + 1 < nx, cell + 1);
    take(y > 0, cell - nx), take(y + 1 < ny, cell + nx);
    take(z > 0, cell - nx * ny), take(z + 1 < nz, cell + nx * ny);
  }

  const SurfaceView& surface_;
  SeedGrid& grid_;
  SeedGridView view_;
  std::array<std::vector<double>, 2> distance_m_;
};

}  // namespace

std::uint32_t SeedGridView::cell_of(const Vec3& p_m) const RT_SAFE {
  return axis_cell(p_m.x, low_m.x, cell_m, size[0]) +
         size[0] * (axis_cell(p_m.y, low_m.y, cell_m, size[1]) +
                    size[1] * axis_cell(p_m.z, low_m.z, cell_m, size[2]));
}

SeedGrid make_seed_grid(const SurfaceView& surface, double margin_m) {
  Extent box;
  for (const Vec3& v : surface.vertex_m) box.cover(v);
  const Vec3 span_m = box.high - box.low + 2.0 * margin_m * Vec3{1.0, 1.0, 1.0};
  const double longest_m = std::max({span_m.x, span_m.y, span_m.z});
  // About two triangles a cell: finer makes longer tables, not shorter walks.
  const double edge_m =
      std::sqrt((span_m.x * span_m.y + span_m.y * span_m.z + span_m.z * span_m.x) /
                static_cast<double>(surface.triangle.size()));
  const double cell_m = std::max(2.0 * edge_m, longest_m / kMaxCells);
  const auto cells = [cell_m](double s) { return static_cast<std::uint32_t>(s / cell_m) + 1; };
  SeedGrid grid;
  grid.shape.low_m = box.low - margin_m * Vec3{1.0, 1.0, 1.0};
  grid.shape.cell_m = cell_m;
  grid.shape.size = {cells(span_m.x), cells(span_m.y), cells(span_m.z)};
  const std::size_t count =
      std::size_t{grid.shape.size[0]} * grid.shape.size[1] * grid.shape.size[2];
  grid.cell.assign(count, Seeds{kNoTriangle, kNoTriangle});
  Seeder(surface, grid).fill();
  return grid;
}

}  // namespace tact::model::contact
