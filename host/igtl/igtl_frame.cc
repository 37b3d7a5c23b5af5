// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tact::host::igtl {

using Eigen::Quaterniond;
using Eigen::Vector3d;

std::string frame_messages(const record::Frame& frame, double time_s) {
  std::array<double, 4> wxyz{};
  std::copy(std::begin(frame.tool_orientation), std::end(frame.tool_orientation), wxyz.begin());
  const auto rotation = pose::rotation_from(wxyz);
  const Vector3d position_m = Eigen::Vector3f(frame.tool_position_m).cast<double>();
  const Vector3d force_N = Eigen::Vector3f(frame.force_N).cast<double>();
  const double parts_N[3] = {force_N.x(), force_N.y(), force_N.z()};
  if (!rotation || !position_m.allFinite() || !force_N.allFinite()) return {};
  // Without a force there is no direction: the arrow is then kMinForce_N long along +z.
  const bool has_way = force_N.norm() > 0.0;
  const pose::Pose arrow{.rotation = has_way
                                         ? Quaterniond::FromTwoVectors(Vector3d::UnitZ(), force_N)
                                         : Quaterniond::Identity(),
                         .position_m = position_m};
  return transform("ToolToDevice", time_s, {.rotation = *rotation, .position_m = position_m}) +
         transform("ForceToDevice", time_s, arrow, std::max(force_N.norm(), kMinForce_N)) +
         force_sensor("Force", time_s, parts_N);
}

Status status_of(const record::Frame& frame) {
  using State = decltype(frame.state);
  // Codes of the protocol's table (README.md): 1 good, 7 time out, 13 not ready, 15 disabled.
  Status out{.code = 1, .subcode = frame.fault, .name = {}, .words = name_of(frame.state)};
  if (frame.state == State::kOff) out.code = 13;
  if (frame.state == State::kStopped) out.code = 15;
  if (frame.fault != 0) out.name = fmt::format("fault {}", frame.fault);
  return out;
}

Status lost_status() {
  return {.code = 7, .subcode = 0, .name = "no tactd", .words = "no news from tactd"};
}

}  // namespace tact::host::igtl
