// SPDX-License-Identifier: Apache-2.0
// contact_scene.h - what contact is made of.
#pragma once

#include <optional>
#include <span>

#include "model/contact/blade.h"
#include "model/contact/contact_law.h"
#include "model/contact/contact_settings.h"
#include "model/contact/sphere.h"
#include "model/contact/triangle_tree.h"

namespace tact::model::contact {

struct BendingOrgan;  // moved_contact.h

/// Everything outlives the contact.
struct ContactScene {
  ContactLaw* law = nullptr;  // may remember: one contact each
  ContactParameters parameters;
  std::span<const ProbeSphere> spheres;  // 1 to kMaxSpheres
  SurfaceView surface;
  TriangleTreeView tree;  // of the surface
  // Not null: the organ bends, and `law` is that of the tip alone. Null: it stays as drawn.
  const BendingOrgan* organ = nullptr;
  std::optional<Blade> blade;  // cuts what it passes through
  double period_s = 1e-3;      // of the loop
};

}  // namespace tact::model::contact
