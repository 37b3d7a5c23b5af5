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

#include "model/contact/fair_surface.h"
#include "model/contact/moved_contact.h"
#include "model/contact/triangle_tree.h"
#include "model/indent/compliance_law.h"
#include "model/law/law_bounds.h"
#include "model/mesh/turn.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/scene/tissue_map.h"
#include "model/tissue/vertex_compliance.h"
#include "model/units.h"

namespace tact::model::scene::moved_liver {

inline constexpr double kStep_m = 0.02_mm;   // a tick
inline constexpr double kBefore_m = 0.5_mm;  // above the first touch
inline constexpr double kDeep_m = 10_mm;

/// The liver with its rhombus law, its whole tool, and what a moved contact needs of it.
struct Liver {
  Liver() {
    const std::string path = TACT_SOURCE_DIR "/model/scenes/liver.toml";
    scene = *load_scene(path, {"law=\"rhombus\""});
    same_everywhere = *load_scene(path, {"law=\"rhombus\"", "varies_by_place=false"});
    tissue = std::move(*make_tissue(scene));
    tip_tissue = std::move(*make_tissue(same_everywhere));
    tree = contact::make_triangle_tree(mesh());
    const law::Law& tip = *tip_tissue->law().curve();
    const ElasticSettings& e = *scene.elastic;
    const indent::ElasticTip ball{.youngs_modulus_Pa = e.youngs_modulus_Pa,
                                  .poisson_ratio = e.poisson_ratio,
                                  .radius_m = scene.tool.spheres[0].radius_m};
    const double stiffest_N_per_m = law::stiffest_N_per_m(tip, 0.0, tip.range().press_m);
    const double E = e.youngs_modulus_Pa;
    corner = contact::fair_corners(mesh());
    compliance = tissue::vertex_compliance(
        *read_scene_map(scene), mesh(), corner,
        {.min_normal_times_E_per_m = (1.0 / 1.5 - 1.0) * E / stiffest_N_per_m,
         .min_sideways_times_E_per_m =
             (1.0 / contact::kStiffestPlace - 1.0) * E / ball.sideways_stiffness_N_per_m()});
    contact_scene = {.surface = {mesh(), corner, compliance, E},
                     .tip = &tip,
                     .coupling = &tissue->law().site_law(),
                     .contact_modulus_Pa = E / (1.0 - e.poisson_ratio * e.poisson_ratio),
                     .poisson_ratio = e.poisson_ratio,
                     .friction_ratio = 0.0,
                     .held_N_per_m = ball.sideways_stiffness_N_per_m(),
                     .spheres = scene.tool.spheres};
  }
  contact::SurfaceView mesh() const { return scene.organ_mesh.view(); }
  contact::MovedContactScene with_friction(double ratio) const {
    contact::MovedContactScene out = contact_scene;
    out.friction_ratio = ratio;
    return out;
  }

  Scene scene, same_everywhere;
  std::unique_ptr<Tissue> tissue, tip_tissue;
  contact::TriangleTree tree;
  std::vector<contact::SurfaceCorner> corner;
  std::vector<contact::VertexCompliance> compliance;
  contact::MovedContactScene contact_scene;
};

inline const Liver& liver() {
  static const Liver instance;
  return instance;
}

/// A straight press: where the tool first touches, and the way from there.
struct Press {
  Vec3 touch_m, inward;  // unit
  Quat orientation;

  Tool at(double depth_m) const {
    return {.position_m = touch_m + depth_m * inward, .orientation = orientation};
  }
};

inline std::vector<contact::Site> nearest(const Tool& tool) {
  std::vector<contact::Site> out;
  for (const contact::ProbeSphere& s : liver().scene.tool.spheres)
    out.push_back(contact::nearest_site(liver().tree.view(), liver().mesh(),
                                        tool.position_m + rotate(tool.orientation, s.offset_m), 1.0,
                                        contact::kNoTriangle));
  return out;
}

inline double gap_m(const Tool& tool) {
  double least_m = 1.0;
  const std::vector<contact::Site> sites = nearest(tool);
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
  press.touch_m += low_m * inward;
  return press;
}

inline Press press_at_vertex(std::size_t v, double about_deg = 0.0) {
  const mesh::SurfaceMesh& m = liver().scene.organ_mesh;
  return press_at(m.vertex_m[v], -m.vertex_normal[v], about_deg);
}

inline contact::MovedContact started(const contact::MovedContactScene& scene, const Tool& tool) {
  contact::MovedContact out(scene);
  std::vector<std::uint32_t> triangle;
  for (const contact::Site& site : nearest(tool)) triangle.push_back(site.place.triangle);
  out.start(tool, triangle);
  return out;
}

/// Force and work of the tool, tick by tick.
struct Stroke {
  Stroke(const contact::MovedContactScene& scene, const Tool& tool)
      : contact(started(scene, tool)), before(tool) {}

  void go(const Tool& tool) {
    const Wrench now = contact.respond(tool);
    const Quat turn = tool.orientation * conjugate(before.orientation);
    const Vec3 way_m = tool.position_m - before.position_m;
    const Vec3 turn_rad = 2.0 * Vec3{turn.x, turn.y, turn.z};
    const double work_of_tick_J =
        -0.5 * (dot(now.force_N + force_N, way_m) + dot(now.torque_Nm + torque_Nm, turn_rad));
    work_J += work_of_tick_J;
    max_tick_J = std::max(max_tick_J, std::abs(work_of_tick_J));
    max_change_N = std::max(max_change_N, norm(now.force_N - force_N));
    max_steps = std::max(max_steps, contact.status().steps);
    if (!contact.status().is_solved) ++unsolved;
    before = tool, force_N = now.force_N, torque_Nm = now.torque_Nm;
  }
  double stored_ratio() const { return stored_energy_J(contact.organ()) / work_J; }

  contact::MovedContact contact;
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
