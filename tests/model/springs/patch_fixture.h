// SPDX-License-Identifier: Apache-2.0
// patch_fixture.h - a spring patch on a plate, pressed by a tool that adds up its work.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "model/contact/contact_point.h"
#include "model/springs/spring_patch.h"
#include "tests/support/shapes.h"

namespace tact::tests {

/// 100 x 100 mm, 5 mm triangles; the fastest mode is at 0.6 of what a tick of 1 ms allows.
inline model::springs::SpringPatchParameters soft_patch() {
  return {.tissue = {.surface_stiffness_N_per_m = 50.0,
                     .body_stiffness_N_per_m = 5.0,
                     .damping_time_s = 0.0008,
                     .body_damping_time_s = 0.03},
          .coupling_stiffness_N_per_m = 300.0,
          .node_mass_kg = 0.002,
          .working_depth_m = 0.01,
          .nodes = 120};
}

/// One sphere on z = 0 whose place and depth are given tick by tick.
class PressedPatch {
 public:
  explicit PressedPatch(const model::springs::SpringPatchParameters& parameters,
                        std::uint32_t cells = 20)
      : mesh_(make_plate(0.1, cells)) {
    auto made = make_spring_patch(mesh_.view(), parameters);
    if (!made) ADD_FAILURE() << made.error().message;
    if (made) patch_ = std::move(*made);
  }

  /// Asks at a place and counts the work since the last question, with the nodes as they are: W is
  /// quadratic within a triangle, so the trapezoid rule is exact there.
  model::contact::ContactLawResponse move_to(double x_m, double y_m, double depth_m,
                                             bool held = false) {
    const model::contact::ContactPoint law = follow(mesh_.view(), triangle_, {x_m, y_m, 0.01});
    triangle_ = law.surface_point.triangle;
    const model::Vec3 at_m = law.point_m;
    const auto before = ask(last_m_, last_depth_m_, held);
    const auto now = ask(at_m, depth_m, held);
    work_J_ += 0.5 * (before.law.force_N + now.law.force_N) * (depth_m - last_depth_m_) +
               0.5 * dot(before.slope_N + now.slope_N, at_m - last_m_);
    last_m_ = at_m;
    last_depth_m_ = depth_m;
    return now;
  }
  void advance(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) patch_->advance();
  }
  model::springs::SpringPatch& patch() { return *patch_; }
  const model::mesh::SurfaceMesh& mesh() const { return mesh_; }
  /// By the hand on the tissue.
  double work_J() const { return work_J_; }

 private:
  model::contact::ContactLawResponse ask(const model::Vec3& at_m, double depth_m, bool held) {
    const model::contact::ContactPoint law =
        follow(mesh_.view(), triangle_, at_m + model::Vec3{0, 0, 0.01});
    return patch_->respond({.sphere = 0,
                            .surface_point = law.surface_point,
                            .normal = {0, 0, 1},
                            .indentation_m = depth_m,
                            .held = held});
  }

  model::mesh::SurfaceMesh mesh_;
  std::unique_ptr<model::springs::SpringPatch> patch_;
  std::uint32_t triangle_ = 420;
  model::Vec3 last_m_{};
  double last_depth_m_ = 0.0;
  double work_J_ = 0.0;
};

}  // namespace tact::tests
