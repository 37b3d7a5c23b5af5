// SPDX-License-Identifier: Apache-2.0
#include "tools/tracking_bench/figure_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "hal/registry/open_device.h"
#include "host/tracking/observation_player.h"
#include "host/tracking/operator_tracker.h"
#include "model/scene/tissue.h"
#include "tools/program/simulated_loop.h"

namespace tact::tools::tracking_bench {
namespace {

using host::pose::Pose;
using host::tracking::TrackedOperator;
using model::Error;
using model::Result;

Pose pose_of(const model::Tool& tool) {
  const auto& [w, x, y, z] = tool.orientation;
  const auto& p_m = tool.position_m;
  return {.rotation = {w, x, y, z}, .position_m = {p_m.x, p_m.y, p_m.z}};
}

/// The tool at each frame: the loop's own thread of events, without its clock.
Result<std::vector<Pose>> tool_motion(const model::scene::Scene& scene, int frames,
                                      double frames_Hz) {
  const auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return tissue.error();
  const auto device = hal::registry::open_device(scene);
  if (!device) return device.error();
  program::SimulatedLoop loop((*tissue)->contact_scene(), scene.limits, scene.rate_Hz, **device);
  std::vector<Pose> out;
  for (std::int64_t tick = 0; static_cast<int>(out.size()) < frames; ++tick) {
    const firmware::loop::TickRecord& record = loop.step();
    const double due = static_cast<double>(out.size()) / frames_Hz * scene.rate_Hz;
    if (static_cast<double>(tick) >= due) out.push_back(pose_of(record.input.sample.tool));
  }
  return out;
}

double share_of(std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

Result<FigureInput> load_figure_input(const std::string& tracking_path) {
  Result<host::tracking::TrackingSetup> setup = host::tracking::load_tracking_setup(tracking_path);
  if (!setup) return setup.error();
  if (setup->recording.empty())
    return Error{tracking_path + ": it names no recording; write [input] recording = \"FILE\""};
  Result<host::tracking::ObservationFile> file =
      host::tracking::read_observation_file(setup->recording);
  if (!file) return file.error();
  return FigureInput{.setup = std::move(*setup), .seen = std::move(file->seen)};
}

Result<std::vector<MotionFrame>> figure_motion(const model::scene::Scene& scene,
                                               const FigureInput& input, double seconds,
                                               double frames_Hz) {
  if (!hal::registry::is_simulated(scene.device)) {
    return Error{scene.path +
                 ": device.kind is hardware; only a simulated hand makes a motion here"};
  }
  const int frames = static_cast<int>(std::lround(seconds * frames_Hz));
  const auto tools = tool_motion(scene, frames, frames_Hz);
  if (!tools) return tools.error();
  host::tracking::OperatorTracker tracker(input.setup);
  std::vector<MotionFrame> out;
  std::size_t next = 0;
  for (int i = 0; i < frames; ++i) {
    const double time_s = i / frames_Hz;
    for (; next < input.seen.size() && input.seen[next].time_s <= time_s; ++next)
      if (const std::optional<Error> error = tracker.take(input.seen[next], time_s)) return *error;
    out.push_back({time_s, (*tools)[static_cast<std::size_t>(i)], tracker.at(time_s)});
  }
  return out;
}

std::vector<MotionFrame> made_up_motion(Pose (*tool_at)(double t_s), double seconds,
                                        double frames_Hz) {
  std::vector<MotionFrame> out(static_cast<std::size_t>(std::lround(seconds * frames_Hz)));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double time_s = static_cast<double>(i) / frames_Hz;
    out[i] = {.time_s = time_s, .tool = tool_at(time_s), .bodies = {}};
  }
  return out;
}

FigureWork measure_figure(const std::vector<MotionFrame>& motion, const Eigen::Vector3d& grip_m,
                          host::figure::RootRule rule) {
  FigureWork out;
  host::figure::Figure figure({.grip_m = grip_m, .root_rule = rule});
  std::vector<double> took_us;
  double sum_m2 = 0.0;
  for (const MotionFrame& frame : motion) {
    const auto start = std::chrono::steady_clock::now();
    const host::figure::FigurePose& pose = figure.update(frame.time_s, frame.tool, frame.bodies);
    took_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
    ++out.frames;
    out.updates += pose.arm.updates;
    out.sweeps += pose.arm.sweeps;
    out.full_chain += pose.arm.full_chain;
    out.unreached += !pose.arm.reached;
    const double error_m = (pose[host::figure::FigureJoint::kRightFingers] - pose.grip_m).norm();
    sum_m2 += error_m * error_m;
    out.worst_error_m = std::max(out.worst_error_m, error_m);
  }
  if (out.frames == 0) return out;
  out.rms_error_m = std::sqrt(sum_m2 / out.frames);
  std::ranges::sort(took_us);
  out.median_us = share_of(took_us, 0.5);
  out.p99_us = share_of(took_us, 0.99);
  return out;
}

}  // namespace tact::tools::tracking_bench
