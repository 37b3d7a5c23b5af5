// SPDX-License-Identifier: Apache-2.0
// tool_check.h - a scene's laws with its whole tool, as rendered, against the reference.
//
// At each place the tool comes from above, as a press stroke brings it, 20 mm/s, through
// model::contact::Contact (detect, then render), all spheres; at each depth it waits until the
// force is constant (measure.h). What is compared is the force against the way. The reference is
// linear elastic and frictionless, so relaxation, friction and large strain are off for the errors;
// times are those of the scene as it is: detect, render and limit of the loop's controller, one
// tick after the other, the gate armed.
//
//     peak   e = F - F_ref, over the largest |F_ref| of all places;  RMS and worst
//     own    e over |F_ref| of the same place and depth
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "tools/chart/measure/measure.h"
#include "tools/ground_truth/tool_reference.h"

namespace tact::tools::chart {

struct ToolSample {
  std::size_t place = 0, depth = 0;  // of the reference
  double force_N = 0.0;
  double reference_N = 0.0;

  double own_ratio() const { return force_N / reference_N - 1.0; }
};

struct ToolErrors {
  double rms_ratio = 0.0, worst_ratio = 0.0;  // of the peak
  double unseen_rms_ratio = 0.0;        // of the peak, without the hand's site; NaN: no other place
  double within_jnd_ratio = 0.0;        // share of the samples, by the own force
  std::vector<double> own_worst_ratio;  // of each depth: the largest in size, with its sign
  double own_largest_ratio = 0.0;       // of all depths, its size
  std::vector<double> place_rms_ratio;  // of each place's own peak
};
/// `unseen`: of each place, that it is not the hand's own site.
ToolErrors summarize_tool(const std::vector<ToolSample>& samples, const std::vector<bool>& unseen);

struct ToolRow {
  std::string law{};
  std::string failure{};            // empty: it was measured
  std::vector<ToolSample> samples;  // by place, then by depth
  ToolErrors errors{};
  Timing timing{};
};

/// The scene's own law: its errors, without a time. An error is Ctrl-C's or says that scene and
/// reference do not fit.
model::Result<ToolRow> check_errors(const model::scene::Scene& scene,
                                    const ground_truth::ToolReference& reference);
/// The scene as it is, over the site of its hand. An error: the law cannot be made.
model::Result<Timing> time_tool(const model::scene::Scene& scene, const TimingSettings& settings);

/// Both, of one law of the scene.
model::Result<ToolRow> check_tool(const model::scene::Scene& scene, const std::string& law,
                                  const ground_truth::ToolReference& reference,
                                  const TimingSettings& timing);

}  // namespace tact::tools::chart
