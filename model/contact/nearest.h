// SPDX-License-Identifier: Apache-2.0
// nearest.h - the nearest point of one triangle, and whether it is on the face, an edge or corner.
//
// Used by the local search (contact_point.h) and the search over all triangles (triangle_tree.h).
#pragma once

#include <cstdint>

#include "model/contact/contact_point.h"

namespace tact::model::contact {

enum class Feature : std::uint8_t { kFace, kEdge, kCorner };

struct Nearest {
  Vec3 point_m;
  double squared_m2 = 0.0;  // of its distance
  SurfacePoint surface_point;
  Feature feature = Feature::kFace;
  std::uint32_t index = 0;  // of the edge or corner
};

Nearest nearest_on(const SurfaceView& surface, std::uint32_t triangle, const Vec3& p_m) RT_SAFE;
/// Contact point with signed distance and normal for p. If it is on the boundary of an open
/// surface, p counts as outside.
ContactPoint contact_point_of(const SurfaceView& surface, const Nearest& nearest,
                              const Vec3& p_m) RT_SAFE;

}  // namespace tact::model::contact
