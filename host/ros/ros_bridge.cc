// SPDX-License-Identifier: Apache-2.0
#include "host/ros/ros_bridge.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>

#include "hal/sim/hand_target.h"
#include "host/ros/joint_angles.h"
#include "model/io/socket_file.h"

namespace tact::host::ros {
namespace {

using firmware::protocol::LoggedTick;

constexpr std::chrono::seconds kSilent{1};  // then tactd has ended, or hangs
constexpr std::chrono::seconds kReport{1};
constexpr double kMaxPosition_m = 1.0;  // as far as hal/sim takes a hand
constexpr double kMaxNormError = 1e-3;  // of a quaternion: rounded to float at some place

void say(const std::string& line) { fmt::print(stderr, "tact-ros: {}\n", line); }

const char* name_of(model::Fault fault) {
  return firmware::protocol::fault_name(static_cast<std::uint64_t>(fault));
}

/// Of a unit quaternion, within pi.
void set_rotation(const double (&wxyz)[4], double (&rotation_rad)[3]) {
  const double sign = wxyz[0] < 0.0 ? -1.0 : 1.0;
  const double sine = std::hypot(wxyz[1], wxyz[2], wxyz[3]);
  const double angle_rad = 2.0 * std::atan2(sine, sign * wxyz[0]);
  const double factor = sine > 0.0 ? sign * angle_rad / sine : 0.0;
  for (std::size_t i = 0; i < 3; ++i) rotation_rad[i] = factor * wxyz[i + 1];
}

}  // namespace

RosBridge::RosBridge(const std::string& log)
    : log_(log, {.start = [this](const auto& run) { begin(run); },
                 .tick = [this](const LoggedTick& tick) { add(tick); }}),
      hand_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}

RosBridge::~RosBridge() {
  if (hand_ >= 0) ::close(hand_);
}

void RosBridge::begin(const firmware::protocol::RunHeader& run) {
  run_ = run;
  ticks_ = 0;
  say(fmt::format("{} on {}, {:g} ticks/s in groups, {:g} of them a second", run.scene_name,
                  run.device_name, run.rate_Hz, run.frame_rate_Hz));
}

void RosBridge::add(const LoggedTick& tick) {
  if (ticks_++ > 0 && tick.tick > newest_.tick) missed_ += tick.tick - newest_.tick - 1;
  newest_ = tick;
  came_ = Clock::now();
  topics_.write(tick);
  if (const auto joints = joints_in(run_, tick)) topics_.write(tick, *joints);
}

std::string RosBridge::move(const ServoPose& pose) const {
  if (!run_.simulated) return "the device is real, or not yet known";
  if (pose.frame_id != topics_.frame()) return "its frame is not " + topics_.frame();
  hal::sim::HandTarget target;
  for (std::size_t i = 0; i < 3; ++i) {
    target.position_m[i] = pose.position_m[i];
    if (!(std::abs(pose.position_m[i]) <= kMaxPosition_m))
      return fmt::format("its position is beyond {} m, or no number", kMaxPosition_m);
  }
  const auto& q = pose.orientation_wxyz;
  if (!(std::abs(std::hypot(std::hypot(q[0], q[1], q[2]), q[3]) - 1.0) <= kMaxNormError))
    return "its orientation is no unit quaternion";
  set_rotation(q, target.rotation_rad);
  target.grip_ratio = newest_.input.sample.tool.grip_ratio;
  const auto address = model::io::socket_address(run_.hand_socket);
  if (!address) return address.error().message;
  if (const auto shared = model::io::check_socket_folder(run_.hand_socket)) return shared->message;
  // A full or missing socket drops the target: the next pose follows.
  static_cast<void>(::sendto(hand_, &target, sizeof target, MSG_DONTWAIT | MSG_NOSIGNAL,
                             model::io::plain(*address), sizeof *address));
  return {};
}

std::optional<model::Error> RosBridge::work() {
  if (auto error = log_.read()) return error;
  topics_.read_servo([this](const ServoPose& pose) {
    const std::string why = move(pose);
    ++(why.empty() ? moved_ : refused_);
    if (!why.empty()) why_ = why;
  });
  const Diagnostic now = diagnostic();
  // A change at once, and all once a second.
  if (now.message != reported_message_ || Clock::now() - reported_ >= kReport) report(now);
  return std::nullopt;
}

Diagnostic RosBridge::diagnostic() const {
  const auto& output = newest_.output;
  const char* state = firmware::protocol::state_name(static_cast<std::uint64_t>(output.state));
  Diagnostic out{.level = newest_.non_rt ? Diagnostic::kWarn : Diagnostic::kOk,
                 .message = state,
                 .device = run_.device_name,
                 .values = {}};
  if (ticks_ == 0 || Clock::now() - came_ >= kSilent) {
    out.level = Diagnostic::kStale;
    out.message = "no ticks: tactd has ended, hangs, or has no --record";
  } else if (output.fault != model::Fault::kNone) {
    out.level = Diagnostic::kError;
    out.message = fmt::format("fault: {}", name_of(output.fault));
  }
  out.values = {{"scene", run_.scene_name},
                {"state", state},
                {"fault", name_of(output.fault)},
                {"limit", name_of(output.limit)},
                {"hard_real_time", newest_.non_rt ? "no" : "yes"},
                {"tick", std::to_string(newest_.tick)},
                {"missed_ticks", std::to_string(missed_)},
                {"utc_max_error_us", std::to_string(newest_.utc.max_error_us)},
                {"servo_cp_moved", std::to_string(moved_)},
                {"servo_cp_refused", std::to_string(refused_)}};
  return out;
}

void RosBridge::report(const Diagnostic& now) {
  topics_.write(now);
  if (now.message != reported_message_) say(now.message);
  if (refused_ != reported_refused_)
    say(fmt::format("servo_cp: {} poses refused so far, the newest as {}", refused_, why_));
  reported_refused_ = refused_;
  reported_message_ = now.message;
  reported_ = Clock::now();
}

}  // namespace tact::host::ros
