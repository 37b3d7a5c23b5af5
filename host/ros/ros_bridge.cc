// SPDX-License-Identifier: Apache-2.0
#include "host/ros/ros_bridge.h"

#include <fmt/format.h>

#include <utility>

namespace tact::host::ros {
namespace {

using firmware::protocol::LoggedTick;
namespace loop = firmware::loop;  // types of a logged tick

constexpr std::chrono::seconds kSilent{1};  // then tactd has ended, or hangs
constexpr std::chrono::seconds kReport{1};

void say(const std::string& line) { fmt::print(stderr, "tact-ros: {}\n", line); }

std::string name_of(model::Fault fault) {
  return firmware::protocol::fault_name(static_cast<std::uint64_t>(fault));
}

}  // namespace

RosBridge::RosBridge(const std::string& log, RosTopics topics, bool servo)
    : topics_(std::move(topics)),
      log_(log, {.start = [this](const auto& run) { begin(run); },
                 .tick = [this](const LoggedTick& tick) { add(tick); }}),
      servo_(servo) {}

void RosBridge::begin(const firmware::protocol::RunHeader& run) {
  hand_.use(run);
  device_ = run.device_name;
  scene_ = run.scene_name;
  ticks_ = 0;
  say(fmt::format("{} on {}, {:g} ticks/s in groups, {:g} of them a second{}", scene_, device_,
                  run.rate_Hz, run.frame_rate_Hz,
                  servo_ && !run.simulated ? "; servo_cp is refused, the device is real" : ""));
}

void RosBridge::add(const LoggedTick& tick) {
  if (ticks_++ > 0 && tick.tick > newest_.tick) missed_ += tick.tick - newest_.tick - 1;
  newest_ = tick;
  came_ = Clock::now();
  topics_.write(tick);
}

void RosBridge::take_servo() {
  topics_.read_servo([this](const ServoPose& pose) {
    hand_.move(pose, topics_.frame(), newest_.input.sample.tool.grip_ratio);
  });
}

std::optional<model::Error> RosBridge::work() {
  if (auto error = log_.read()) return error;
  take_servo();
  const Clock::time_point now = Clock::now();
  const Diagnostic next = diagnostic(now);
  // A change at once, and all once a second.
  if (next.message != last_.message || now - reported_ >= kReport) report(now);
  return std::nullopt;
}

Diagnostic RosBridge::diagnostic(Clock::time_point now) const {
  const auto& output = newest_.output;
  Diagnostic out;
  out.device = device_;
  if (ticks_ == 0 || now - came_ >= kSilent) {
    out.message = "no ticks: tactd has ended, hangs, or has no --record";
  } else if (output.fault != model::Fault::kNone) {
    out.level = Diagnostic::kError;
    out.message = "fault: " + name_of(output.fault);
  } else {
    out.level = output.state == loop::State::kStopped ? Diagnostic::kError
                : newest_.non_rt                ? Diagnostic::kWarn
                                                : Diagnostic::kOk;
    out.message = loop::name_of(output.state);
  }
  out.values = {{"scene", scene_},
                {"state", loop::name_of(output.state)},
                {"fault", name_of(output.fault)},
                {"limit", name_of(output.limit)},
                {"hard_real_time", newest_.non_rt ? "no" : "yes"},
                {"tick", std::to_string(newest_.tick)},
                {"missed_ticks", std::to_string(missed_)},
                {"utc_max_error_us", std::to_string(newest_.utc.max_error_us)},
                {"servo_cp_moved", std::to_string(hand_.moved())},
                {"servo_cp_refused", std::to_string(hand_.refused())}};
  return out;
}

void RosBridge::report(Clock::time_point now) {
  Diagnostic next = diagnostic(now);
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  topics_.write(next, std::chrono::duration_cast<std::chrono::nanoseconds>(utc).count());
  if (next.message != last_.message) say(next.message);
  if (hand_.refused() != refused_before_)
    say(fmt::format("servo_cp: {} poses refused so far, the newest as {}", hand_.refused(),
                    hand_.why()));
  refused_before_ = hand_.refused();
  reported_ = now;
  last_ = std::move(next);
}

}  // namespace tact::host::ros
