// SPDX-License-Identifier: Apache-2.0
// tool_motion.h - thirty seconds of a made-up tool, for benches and tests of the operator's arm.
// Own work; every number is chosen, none is measured.
#pragma once

#include <algorithm>
#include <cmath>

#include "host/pose/coordinate_chain.h"

namespace tact::test {

inline constexpr double kMotion_s = 30.0, kMotionFrame_s = 1.0 / 60.0;

/// Presses, slides and wanders, now and then farther than the arm alone spans.
inline host::pose::Pose tool_at(double t_s) {
  const double far = std::pow(std::max(0.0, std::sin(2.0 * M_PI * t_s / 10.0)), 3);
  host::pose::Pose tool;
  tool.position_m = {0.04 * std::sin(1.1 * t_s) - 0.20 * far,
                     0.08 * std::sin(0.7 * t_s + 1.0) - 0.10 * far,
                     0.03 + 0.03 * std::sin(1.9 * t_s)};
  tool.rotation = Eigen::AngleAxisd(0.25 * std::sin(0.9 * t_s), Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(0.20 * std::sin(1.3 * t_s), Eigen::Vector3d::UnitZ());
  return tool;
}

inline constexpr double kReach_s = 10.0;

/// Out and back, 0 to 1.
inline double reach_share(double t_s) { return std::pow(std::sin(M_PI * t_s / kReach_s), 2); }

/// Goes 0.4 m away from the operator: beyond what the arm spans, so that the trunk must bend.
inline host::pose::Pose far_tool_at(double t_s) {
  return {.position_m = {-0.4 * reach_share(t_s), 0.0, 0.05}};
}

/// Turns about its own handle until the wrist's cone is in the way: near enough all the time.
inline host::pose::Pose turned_tool_at(double t_s) {
  const Eigen::AngleAxisd turn(0.9 * reach_share(t_s), Eigen::Vector3d::UnitZ());
  return {.rotation = Eigen::Quaterniond(turn), .position_m = {0.0, 0.0, 0.05}};
}

}  // namespace tact::test
