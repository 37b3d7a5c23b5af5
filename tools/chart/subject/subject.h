// SPDX-License-Identifier: Apache-2.0
// subject.h - what the chart measures: something that answers a probe, one tick at a time.
//
// A law of tact or a peer. All see the same sites of the same mesh under the same tip.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "model/contact/site_law.h"
#include "model/result.h"
#include "model/scene/plan_file.h"
#include "model/scene/scene.h"

namespace tact::tools::chart {

class Subject {
 public:
  virtual ~Subject() = default;
  /// One whole tick with the probe there: force on the tool along the normal, N.
  virtual double tick(const model::contact::Indentation& in) = 0;
  /// The probe is gone; a body with inertia comes to rest.
  virtual void release() = 0;
  /// Displacement into the tissue at radius k * pitch_m around the place, as after the last tick.
  virtual void shape(const model::contact::Indentation& in, double pitch_m,
                     std::span<double> ring_m) = 0;
  /// It needs several ticks to reach its force.
  virtual bool is_stepped() const = 0;
  virtual std::size_t memory_bytes() const = 0;
  /// What it was given, for the table; no comma.
  virtual std::string given() const = 0;
};

/// A law of the scene with these sizes; it keeps its own copy of the scene.
model::Result<std::unique_ptr<Subject>> make_law_subject(const model::scene::Scene& scene,
                                                         const model::scene::LawSizes& sizes);

/// Mean over the ring at radius k * pitch_m, k = 0, 1, ..., of a field that is linear over each
/// triangle (dent_m: one entry a vertex), over the same lines as the reference's (ring_means.h).
void ring_means(const model::contact::SurfaceView& surface, const model::contact::Indentation& in,
                double pitch_m, std::span<const double> dent_m, std::span<double> ring_m);

/// The point of the place.
model::Vec3 point_of(const model::contact::SurfaceView& surface,
                     const model::contact::Place& place);

}  // namespace tact::tools::chart
