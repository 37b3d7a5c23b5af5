// SPDX-License-Identifier: Apache-2.0
// measure.h - runs a subject over the reference's sites and depths, and times its tick.
//
// Errors are quasi-static: a stepped subject ticks at one depth until its force stays within
// 0.1 % over 50 ticks, or for kMaxSettleTicks. Relaxation is not asked: the reference is elastic.
// Time is that of warm ticks, each on its own, less what reading the clock costs; the median of
// very short ticks is that of the mean of a few. What is asked is the law, not the load of the
// machine: ticks in which the system ran another program are counted and left out, and of some
// rounds the least median and the least p99.9 count. The loop itself runs where nothing else does.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "model/contact/contact_law.h"
#include "model/result.h"
#include "model/scene/plan_file.h"
#include "model/scene/scene.h"
#include "model/scene/tissue_law.h"
#include "tools/ground_truth/reference_data.h"

namespace tact::tools::chart {

/// What the chart evaluates: a law of a scene that answers one sphere, one tick at a time.
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

inline constexpr int kMaxSettleTicks = 4000;

/// One depth at one site of the scene's mesh.
struct ProbeCase {
  std::size_t site = 0;
  bool held_out = false;
  model::contact::Indentation in;
  double reference_N = 0.0;
  std::vector<double> reference_ring_m;
};

/// The linear cases of the reference on the scene's mesh. An error if they are of another mesh or
/// another tip.
model::Result<std::vector<ProbeCase>> cases_of(const model::scene::Scene& scene,
                                               const ground_truth::ReferenceData& reference);

struct SettledForce {
  double force_N = 0.0;
  int ticks = 0;
};
SettledForce settle(bool is_stepped, const std::function<double()>& tick_force_N);

/// One depth at one site.
struct Sample {
  std::size_t site = 0;
  bool held_out = false;  // no law was fitted to this site
  double depth_m = 0.0;   // press above 0
  double force_N = 0.0, reference_N = 0.0;
  std::vector<double> ring_m, reference_ring_m;  // NaN: not known, not compared
};
struct Answers {
  std::vector<Sample> samples;
  int settle_ticks = 0;  // the longest; 1 of a law without inertia
};
Answers measure_answers(Subject& subject, const std::vector<ProbeCase>& cases, double pitch_m);

struct TimingSettings {
  std::size_t ticks = 20000;  // a round
  int rounds = 3;
  double limit_s = 12.0;  // a slow law: fewer ticks
  bool instructions = true;
};

struct Timing {
  double median_us = 0.0, p999_us = 0.0;  // of fewer than 1000 ticks the worst is the p99.9
  double instructions = 0.0;              // per tick; NaN where they are too many to count
  std::size_t ticks = 0;                  // a round
  std::size_t paused = 0;                 // of these, left out of the p99.9
};
Timing measure_time(const std::function<void()>& tick, const TimingSettings& settings);

}  // namespace tact::tools::chart
