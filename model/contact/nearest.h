// SPDX-License-Identifier: Apache-2.0
// nearest.h - the nearest point of one triangle, and what it is on: a face, an edge or a corner.
//
// For the two searches of this room: from triangle to triangle (contact_point.h), over all of them
// (triangle_tree.h).
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
/// The point with its sign and its normal, seen from p. On the boundary of an open surface p is
/// outside.
ContactPoint contact_point_of(const SurfaceView& surface, const Nearest& nearest,
                              const Vec3& p_m) RT_SAFE;

}  // namespace tact::model::contact
