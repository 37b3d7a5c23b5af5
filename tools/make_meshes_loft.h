// make_meshes_loft.h - a closed tool as a stack of rings with a point at each end.
#pragma once

#include "tools/make_meshes.h"

namespace tact::tools {

/// Rings of equally many points, counter-clockwise seen from `top`, from `bottom` to `top`:
/// n rings of m points give n m + 2 vertices and 2 n m triangles.
Shape make_loft(const model::Vec3& bottom_mm, const std::vector<std::vector<model::Vec3>>& ring_mm,
                const model::Vec3& top_mm);

}  // namespace tact::tools
