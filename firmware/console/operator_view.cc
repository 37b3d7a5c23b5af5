// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/operator_view.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "firmware/console/say.h"
#include "firmware/loop/supervisor.h"
#include "firmware/watch/call_filter.h"

namespace tact::firmware::console {

using model::Fault;

std::string fault_detail_of(Fault fault, const hal::Device& device, const hal::SafetyLines& lines) {
  if (fault == Fault::kNone) return {};
  if (fault == Fault::kForbiddenCall) return watch::refused_call();
  // By number, 107 to 110 (model/fault.h), and the fault of the grip line.
  const bool of_lines = (fault >= Fault::kEmergencyStop && fault <= Fault::kDeadManReleased) ||
                        fault == Fault::kGripFlaps;
  return of_lines ? lines.fault_detail() : device.fault_detail();
}

OperatorView::OperatorView(const hal::Device& device, const hal::SafetyLines& lines,
                           bool arms_itself, std::string scene_path)
    : device_(device),
      lines_(lines),
      name_(device.info().name),
      scene_path_(std::move(scene_path)),
      terminal_(isatty(STDOUT_FILENO) != 0),
      arms_itself_(arms_itself) {}

bool OperatorView::show(const protocol::Frame& newest) {
  const bool was_reported = reported_ready_;
  if (newest.state == loop::State::kArmed || newest.state == loop::State::kStopped)
    arms_itself_ = false;  // it arms itself only once, at the start
  // Reported again at each change to ready: an earlier report does not allow arming.
  if (newest.state != loop::State::kReady) reported_ready_ = false;
  // Each fault once, when it latches.
  if (newest.fault != before_.fault && newest.fault != 0) {
    const auto number = static_cast<Fault>(newest.fault);
    const model::FaultEntry& fault = model::describe(number);
    const std::string detail = fault_detail_of(number, device_, lines_);
    report(fmt::format("fault {}, {}: {}{}{}; {}", newest.fault, fault.name, fault.cause,
                       detail.empty() ? "" : ": ", detail, fault.remedy));
  } else if (newest.fault == 0 && waits(newest.state)) {
    const std::string now = device_.fault_detail();
    if (!now.empty() && now != waits_for_) report(now);
    waits_for_ = now;
  } else if (newest.state == loop::State::kReady && !reported_ready_ && !arms_itself_) {
    waits_for_.clear();
    reported_ready_ = true;
    report(fmt::format("ready, force is off: hold the device, then arm it (tactctl {} arm)",
                       scene_path_));
  }
  report_inside(newest);
  const std::string noticed = std::exchange(notice_, lines_.notice());
  if (!notice_.empty() && notice_ != noticed) report(notice_);
  if (terminal_) say(stdout, "\r\033[K{}", status_line(newest, before_));
  // The live line has no line end, which would flush it.
  std::fflush(stdout);
  before_ = newest;
  return reported_ready_ && !was_reported;
}

// A device may send positions before its motors have power: it is not ready then.
bool OperatorView::waits(loop::State state) {
  if (state == loop::State::kOff) return true;
  const bool without_power = state == loop::State::kReady && !device_.fault_detail().empty();
  if (without_power) reported_ready_ = false;
  return without_power;
}

// Reported at each entry: otherwise an armed device would give no force without an explanation.
void OperatorView::report_inside(const protocol::Frame& newest) {
  const auto is_inside = [](const protocol::FrameContact& contact) {
    return contact.state == model::ContactState::kInside;
  };
  const bool was_inside = std::exchange(inside_, std::ranges::any_of(newest.contact, is_inside));
  if (!inside_ || was_inside) return;
  const model::FaultEntry& limit = model::describe(Fault::kToolInside);
  report(fmt::format("{}: {}; {}", limit.name, limit.cause, limit.remedy));
}

std::string OperatorView::why_not_arm() const {
  switch (before_.state) {
    case loop::State::kOff:
      return waits_for_.empty() ? "the device is not ready yet" : waits_for_;
    case loop::State::kReady:
      if (!waits_for_.empty()) return waits_for_;
      return reported_ready_ ? "" : "it arms itself as soon as it has power";
    case loop::State::kArmed:
      return "it is armed already";
    case loop::State::kStopped:
      return fmt::format("it has stopped; reset it first (tactctl {} reset)", scene_path_);
  }
  return "its state is not known";
}

std::string OperatorView::why_not_reset() const {
  if (before_.state == loop::State::kStopped) return {};
  return fmt::format("it is {}, not stopped", name_of(before_.state));
}

std::string OperatorView::status() const {
  const auto& f = before_.force_N;
  std::string out =
      fmt::format("{}: {}, {:.3f} N", name_, name_of(before_.state), std::hypot(f[0], f[1], f[2]));
  if (before_.fault != 0)
    out += fmt::format(", fault {}, {}", before_.fault,
                       model::describe(static_cast<Fault>(before_.fault)).name);
  if (inside_) out += ", inside the organ: take the tool out";
  if (!notice_.empty()) out += ", " + notice_;
  if (before_.contact_losses > 0)
    out += fmt::format(", contact lost {} times", before_.contact_losses);
  if (before_.state <= loop::State::kReady && !waits_for_.empty()) out += ": " + waits_for_;
  return out;
}

void OperatorView::report(const std::string& message) const {
  say(stderr, "{}tactd: {}\n", terminal_ ? "\n" : "", message);
}

void OperatorView::end() const {
  if (terminal_) say(stdout, "\n");
}

std::string status_line(const protocol::Frame& frame, const protocol::Frame& before) {
  const double elapsed_s = static_cast<double>(frame.time_ns - before.time_ns) * 1e-9;
  const auto ticks = static_cast<double>(frame.tick - before.tick);
  const double rate_Hz = elapsed_s > 0.0 ? ticks / elapsed_s : 0.0;
  const float force_N = std::hypot(frame.force_N[0], frame.force_N[1], frame.force_N[2]);
  const model::Fault shown =
      static_cast<model::Fault>(frame.fault != 0 ? frame.fault : frame.limit);
  const char* reason = shown == model::Fault::kNone ? "" : model::describe(shown).name;
  std::string losses;
  if (frame.contact_losses > 0) losses = fmt::format("  contact lost {}", frame.contact_losses);
  return fmt::format(
      "{:7.1f} s  {:4.0f} Hz  late {}  skipped {}  tick {:5.1f} us  force {:6.3f} N  {}  {}{}",
      static_cast<double>(frame.time_ns) * 1e-9, rate_Hz, frame.late_ticks, frame.skipped_ticks,
      frame.median_tick_us, force_N, name_of(frame.state), reason, losses);
}

}  // namespace tact::firmware::console
