// SPDX-License-Identifier: Apache-2.0
#include "host/figure/figure_json.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace tact::host::figure {
namespace {

/// To a tenth of a millimetre; clamped at 99 m, far outside the view.
void put(std::string& out, const Eigen::Vector3d& at_m) {
  const Eigen::Vector3d p_m = at_m.cwiseMax(-99.0).cwiseMin(99.0);
  fmt::format_to(std::back_inserter(out), "{:.4f},{:.4f},{:.4f}", p_m.x(), p_m.y(), p_m.z());
}

}  // namespace

nlohmann::json skeleton_json(const BodyPlan& plan) {
  nlohmann::json parts = nlohmann::json::array();
  for (const Capsule& part : capsules(plan)) {
    parts.push_back({{"a", static_cast<int>(part.a)},
                     {"b", static_cast<int>(part.b)},
                     {"radius_a_m", part.radius_a_m},
                     {"radius_b_m", part.radius_b_m},
                     {"depth_ratio", part.depth_ratio},
                     {"holds_tool", part.holds_tool}});
  }
  return {{"joints", kFigureJointNames},
          {"capsules", parts},
          {"sides",
           {static_cast<int>(FigureJoint::kLeftHip), static_cast<int>(FigureJoint::kRightHip)}},
          {"hand", static_cast<int>(FigureJoint::kRightFingers)},
          {"head", static_cast<int>(FigureJoint::kHead)}};
}

std::string figure_json(const FigurePose& pose, std::uint64_t tick, bool head_tracked) {
  std::string out;
  // One allocation: every number has a bounded width, and the words come from a table.
  out.reserve(kMaxFigureJsonBytes);
  fmt::format_to(std::back_inserter(out), "{{\"kind\":\"figure\",\"tick\":{},\"joint_m\":[", tick);
  for (std::size_t i = 0; i < kFigureJoints; ++i) {
    if (i > 0) out += ',';
    put(out, pose.joint_m[i]);
  }
  out += "],\"grip_m\":[";
  put(out, pose.grip_m);
  const Eigen::Quaterniond& head = pose.head;
  fmt::format_to(std::back_inserter(out),
                 "],\"head\":[{:.5f},{:.5f},{:.5f},{:.5f}],\"reached\":{},\"error_mm\":{:.3f},"
                 "\"sweeps\":{},\"updates\":{},\"full_chain\":{},\"trouble\":{},\"words\":\"{}\","
                 "\"head_tracked\":{}}}",
                 head.w(), head.x(), head.y(), head.z(), pose.arm.reached,
                 // Bounded, so that the text stays within kMaxFigureJsonBytes.
                 std::min(pose.arm.error_m, 99.0) * 1e3, pose.arm.sweeps, pose.arm.updates,
                 pose.arm.full_chain, static_cast<int>(pose.trouble), pose.words, head_tracked);
  return out;
}

}  // namespace tact::host::figure
