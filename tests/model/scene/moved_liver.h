// SPDX-License-Identifier: Apache-2.0
// moved_liver.h - the shipped liver as a moved organ, straight presses into it, and what a stroke
// comes to.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "model/contact/contact.h"
#include "model/contact/triangle_tree.h"
#include "model/mesh/turn.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/units.h"

namespace tact::model::scene::moved_liver {

inline constexpr double kStep_m = 0.02_mm;   // a tick
inline constexpr double kBefore_m = 0.5_mm;  // above the first touch
inline constexpr double kDeep_m = 10_mm;

/// The shipped liver, with the friction that a test wants.
struct Liver {
  explicit Liver(double friction_ratio) {
    const std::string path = TACT_SOURCE_DIR "/model/scenes/liver.toml";
    scene = *load_scene(path, {"contact.friction_ratio=" + std::to_string(friction_ratio)});
    tissue = std::move(*make_tissue(scene));
  }
  contact::SurfaceView mesh() const { return scene.organ_mesh.view(); }
  contact::TriangleTreeView tree() const { return tissue->contact_scene().tree; }

  Scene scene;
  std::unique_ptr<Tissue> tissue;
};

inline const Liver& liver() {
  static const Liver instance(0.0);
  return instance;
}
inline const Liver& rough_liver() {
  static const Liver instance(0.4);
  return instance;
}

/// A straight press: the point of first contact, and the way from there.
struct Press {
  Vec3 contact_m, inward;  // unit
  Quat orientation;

  Tool at(double depth_m) const {
    return {.position_m = contact_m + depth_m * inward, .orientation = orientation};
  }
};

inline std::vector<contact::ContactPoint> nearest(const Tool& tool) {
  std::vector<contact::ContactPoint> out;
  for (const contact::ProbeSphere& s : liver().scene.tool.spheres)
    out.push_back(contact::nearest_contact_point(
        liver().tree(), liver().mesh(), tool.position_m + rotate(tool.orientation, s.offset_m), 1.0,
        contact::kNoTriangle));
  return out;
}

inline double gap_m(const Tool& tool) {
  double least_m = 1.0;
  const std::vector<contact::ContactPoint> sites = nearest(tool);
  for (std::size_t i = 0; i < sites.size(); ++i)
    least_m = std::min(least_m, sites[i].distance_m - liver().scene.tool.spheres[i].radius_m);
  return least_m;
}

/// Over a point of the liver, the tool square to its way after a turn about its own axis.
inline Press press_at(const Vec3& point_m, const Vec3& inward, double about_deg = 0.0) {
  constexpr double kOff_m = 30_mm, kMarch_m = 1.5_mm;
  Press press{point_m, inward,
              mesh::turn_between({0, 0, -1}, inward) *
                  quat_from_rotation_vector({0, 0, about_deg * std::numbers::pi / 180.0})};
  double high_m = -kOff_m;
  while (high_m < kOff_m && gap_m(press.at(high_m)) > 0.0) high_m += kMarch_m;
  double low_m = high_m - kMarch_m;
  for (int i = 0; i < 40; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (gap_m(press.at(middle_m)) > 0.0 ? low_m : high_m) = middle_m;
  }
  press.contact_m += low_m * inward;
  return press;
}

inline Press press_at_vertex(std::size_t v, double about_deg = 0.0) {
  const mesh::SurfaceMesh& m = liver().scene.organ_mesh;
  return press_at(m.vertex_m[v], -m.vertex_normal[v], about_deg);
}

/// Force and work of the tool, tick by tick.
struct Stroke {
  Stroke(const Liver& on, const Tool& tool) : contact(on.tissue->contact_scene()), before(tool) {}

  void go(const Tool& tool) {
    contact.detect_contact(tool);
    const Wrench now = contact.render_force(tool, false).wrench;
    const Quat turn = tool.orientation * conjugate(before.orientation);
    const Vec3 way_m = tool.position_m - before.position_m;
    const Vec3 turn_rad = 2.0 * Vec3{turn.x, turn.y, turn.z};
    const double work_of_tick_J =
        -0.5 * (dot(now.force_N + force_N, way_m) + dot(now.torque_Nm + torque_Nm, turn_rad));
    work_J += work_of_tick_J;
    max_tick_J = std::max(max_tick_J, std::abs(work_of_tick_J));
    max_change_N = std::max(max_change_N, norm(now.force_N - force_N));
    max_steps = std::max(max_steps, moved().status().steps);
    if (!moved().status().is_solved) ++unsolved;
    before = tool, force_N = now.force_N, torque_Nm = now.torque_Nm;
  }
  const contact::MovedContact& moved() const { return contact.moved(); }
  double stored_ratio() const { return stored_energy_J(moved().organ()) / work_J; }
  Vec3 force_of_N(std::size_t sphere) const { return contact.contacts()[sphere].force_N; }

  contact::Contact contact;
  Tool before;
  Vec3 force_N, torque_Nm;
  double work_J = 0.0, max_tick_J = 0.0, max_change_N = 0.0;
  int max_steps = 0, unsolved = 0;
};

inline int ticks_to(double depth_m) {
  return static_cast<int>(std::lround((depth_m + kBefore_m) / kStep_m));
}
inline double depth_at(int tick) { return tick * kStep_m - kBefore_m; }

}  // namespace tact::model::scene::moved_liver
