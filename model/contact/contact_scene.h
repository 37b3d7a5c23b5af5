// SPDX-License-Identifier: Apache-2.0
// contact_scene.h - the data that contact works on.
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

/// All data referred to must outlive the contact.
struct ContactScene {
  ContactLaw* law = nullptr;  // may have state: one law per contact
  ContactParameters parameters;
  std::span<const ProbeSphere> spheres;  // 1 to kMaxSpheres
  SurfaceView surface;
  TriangleTreeView tree;  // of the surface
  // Not null: the organ bends, and `law` is that of the tip alone. Null: its surface stays at rest.
  const BendingOrgan* organ = nullptr;
  std::optional<Blade> blade;  // cuts the springs that it sweeps
  double period_s = 1e-3;      // of the loop
};

}  // namespace tact::model::contact
