// SPDX-License-Identifier: Apache-2.0
// figure_work.h - what the figure's arm costs on a scene's own motion, with its two rules of CCD.
//
//     motion   the tool as the scene's simulated hand moves it, by the controller's loop in
//              simulated time; the bodies as the scene's recorded tracker sees them
//              (SCENE.tracking.toml)
//     updates  joints turned by CCD in all frames; equal error: both rules end at one tolerance
//
// A rule of CCD: the shoulder first and the whole chain only if it must, or always the whole chain;
// or none, which shows where CCD must help.
#pragma once

#include <vector>

#include "host/figure/figure.h"
#include "host/tracking/observation.h"
#include "host/tracking/tracking_setup.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::tools::tracking_bench {

struct MotionFrame {
  double time_s = 0.0;
  host::pose::Pose tool;
  host::tracking::TrackedOperator bodies;
};

struct FigureInput {
  host::tracking::TrackingSetup setup;
  std::vector<host::tracking::Observation> seen;  // in the order of the file
};

/// The tracking description and its recording; an error says file, line and cure.
model::Result<FigureInput> load_figure_input(const std::string& tracking_path);

/// `frames_Hz` frames a second. Runs the scene's own device, which must be simulated.
model::Result<std::vector<MotionFrame>> figure_motion(const model::scene::Scene& scene,
                                                      const FigureInput& input, double seconds,
                                                      double frames_Hz);

/// A made-up tool (tool_motion.h) and no tracker.
std::vector<MotionFrame> made_up_motion(host::pose::Pose (*tool_at)(double t_s), double seconds,
                                        double frames_Hz);

struct FigureWork {
  int frames = 0;
  long updates = 0, sweeps = 0;
  int full_chain = 0;                             // frames in which the whole chain moved
  int unreached = 0;                              // frames in which the fingers are not at the grip
  double rms_error_m = 0.0, worst_error_m = 0.0;  // of the finger tips
  double median_us = 0.0, p99_us = 0.0;           // of the whole figure in a frame
};

/// `grip_m` of the tool's handle, in its own axes.
FigureWork measure_figure(const std::vector<MotionFrame>& motion, const Eigen::Vector3d& grip_m,
                          host::figure::RootRule rule);

}  // namespace tact::tools::tracking_bench
