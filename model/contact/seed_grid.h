// SPDX-License-Identifier: Apache-2.0
// seed_grid.h - where to start looking: for every cell of a coarse grid around a surface, the
// triangle nearest to the cell's centre, and the nearest one that faces the other way.
//
// With it a global query is one look-up and two bounded walks (site.h), whatever the mesh size. The
// second seed keeps two sheets of a thin lobe apart that share a cell. Points outside the grid use
// the nearest cell.
#pragma once

#include <array>
#include <vector>

#include "model/contact/site.h"

namespace tact::model::contact {

using Seeds = std::array<std::uint32_t, 2>;  // second is kNoTriangle when one sheet is near

struct SeedGridView {
  Vec3 low_m;
  double cell_m = 1.0;
  std::array<std::uint32_t, 3> size{1, 1, 1};
  std::span<const Seeds> cell;  // size[0] * size[1] * size[2], x fastest

  /// Index of the cell that holds p, or of the nearest one.
  std::uint32_t cell_of(const Vec3& p_m) const RT_SAFE;
};

struct SeedGrid {
  SeedGridView shape;  // without cells
  std::vector<Seeds> cell;

  SeedGridView view() const {
    SeedGridView out = shape;
    out.cell = cell;
    return out;
  }
};

/// Grid that covers the surface and `margin_m` around it, at most 64 cells along an edge.
SeedGrid make_seed_grid(const SurfaceView& surface, double margin_m);

}  // namespace tact::model::contact
