// SPDX-License-Identifier: Apache-2.0
// tool_check.h - a scene's law with its whole tool, as rendered, at the places of the reference.
//
// At each place the tool comes from above, as a press stroke brings it, 20 mm/s, through
// model::contact::Contact (detect, then render), all spheres; at each depth it waits until the
// force is constant (measure.h). What is compared is the force against the way. The reference is
// linear elastic and frictionless, so relaxation, friction and large strain are off for the forces;
// times are those of the scene as it is: detect, render and limit of the loop's controller, one
// tick after the other, the gate armed.
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "tools/chart/measure/measure.h"
#include "tools/ground_truth/tool_reference.h"

namespace tact::tools::chart {

/// The scene's own law: its forces, N, by place and then by depth. An error is Ctrl-C's, or says
/// that the law cannot be made or that scene and reference do not fit.
model::Result<std::vector<double>> press_tool(const model::scene::Scene& scene,
                                              const ground_truth::ToolReference& reference);
/// The scene as it is, over the site of its hand. An error: the law cannot be made.
model::Result<Timing> time_tool(const model::scene::Scene& scene, const TimingSettings& settings);

}  // namespace tact::tools::chart
