// SPDX-License-Identifier: Apache-2.0
#include "host/ros/servo_hand.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "model/io/socket_file.h"

namespace tact::host::ros {
namespace {

using model::Error;

constexpr double kMaxPosition_m = 1.0;  // as far as hal/sim takes a hand
constexpr double kMaxNormError = 1e-3;  // of a quaternion: rounded to float at some place

/// Of a unit quaternion, within pi.
void set_rotation(const double (&wxyz)[4], double (&rotation_rad)[3]) {
  const double sign = wxyz[0] < 0.0 ? -1.0 : 1.0;
  const double sine = std::hypot(wxyz[1], wxyz[2], wxyz[3]);
  const double angle_rad = 2.0 * std::atan2(sine, sign * wxyz[0]);
  const double factor = sine > 0.0 ? sign * angle_rad / sine : 0.0;
  for (std::size_t i = 0; i < 3; ++i) rotation_rad[i] = factor * wxyz[i + 1];
}

}  // namespace

model::Result<hal::sim::HandTarget> target_of(const ServoPose& pose, const std::string& frame,
                                              double grip_ratio) {
  if (pose.frame_id != frame)
    return Error{fmt::format("its frame is not {}: transform it", frame)};
  hal::sim::HandTarget target;
  for (std::size_t i = 0; i < 3; ++i) {
    target.position_m[i] = pose.position_m[i];
    if (!(std::abs(pose.position_m[i]) <= kMaxPosition_m))
      return Error{fmt::format("its position is beyond {} m, or no number", kMaxPosition_m)};
  }
  const auto& q = pose.orientation_wxyz;
  if (!(std::abs(std::hypot(std::hypot(q[0], q[1], q[2]), q[3]) - 1.0) <= kMaxNormError))
    return Error{"its orientation is no unit quaternion"};
  set_rotation(q, target.rotation_rad);
  target.grip_ratio = grip_ratio;
  return target;
}

ServoHand::ServoHand() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}

ServoHand::~ServoHand() {
  if (socket_ >= 0) ::close(socket_);
}

void ServoHand::use(const firmware::protocol::RunHeader& run) {
  path_ = run.hand_socket;
  closed_.clear();
  if (!run.simulated)
    closed_ = "the device is real: its hand is a person's";
  else if (const auto shared = model::io::check_socket_folder(path_))
    closed_ = shared->message;
}

void ServoHand::move(const ServoPose& pose, const std::string& frame, double grip_ratio) {
  const auto target =
      closed_.empty() ? target_of(pose, frame, grip_ratio) : Error{closed_};
  const auto address = model::io::socket_address(path_);
  if (!target || !address) {
    ++refused_;
    why_ = target ? address.error().message : target.error().message;
    return;
  }
  // A full or missing socket drops the target: the next pose follows.
  static_cast<void>(::sendto(socket_, &*target, sizeof *target, MSG_DONTWAIT | MSG_NOSIGNAL,
                             model::io::plain(*address), sizeof *address));
  ++moved_;
}

}  // namespace tact::host::ros
