// SPDX-License-Identifier: Apache-2.0
// subject.h - what the chart judges: a law of a scene that answers one sphere, one tick at a time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/contact/contact_law.h"
#include "model/result.h"
#include "model/scene/plan_file.h"
#include "model/scene/scene.h"
#include "model/scene/tissue_law.h"

namespace tact::tools::chart {

class Subject {
 public:
  Subject(std::unique_ptr<model::scene::Scene> scene, std::unique_ptr<model::scene::TissueLaw> law);
  /// One whole tick with the probe there: force on the tool along the normal, N.
  double tick(const model::contact::Indentation& in);
  /// The probe is gone; a body with inertia comes to rest.
  void release();
  /// Displacement into the tissue at radius k * pitch_m around the place, as after the last tick:
  /// of a body with inertia over the same lines as the reference's (ring_means.h).
  void shape(const model::contact::Indentation& in, double pitch_m, std::span<double> ring_m);
  /// It needs several ticks to reach its force.
  bool is_stepped() const { return law_->curve() == nullptr; }
  std::size_t memory_bytes() const { return law_->memory_bytes(); }

 private:
  void fill_indentations(const model::Vec3& normal);
  void wait_for_rest();

  std::unique_ptr<model::scene::Scene> scene_;
  std::unique_ptr<model::scene::TissueLaw> law_;
  model::contact::PatchShape shape_{};
  std::vector<double> indentation_m_;  // of each vertex
};

/// A law of the scene with these sizes; it keeps its own copy of the scene.
model::Result<std::unique_ptr<Subject>> make_subject(const model::scene::Scene& scene,
                                                     const model::scene::LawSizes& sizes);

}  // namespace tact::tools::chart
