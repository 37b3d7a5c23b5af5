// SPDX-License-Identifier: Apache-2.0
// operator_view.h - reports to the operator while the loop runs: a live line on a terminal, each
// fault when it latches, and what a device that is not ready waits for.
#pragma once

#include <string>

#include "firmware/protocol/frame.h"
#include "hal/device.h"
#include "hal/safety_lines.h"

namespace tact::firmware::console {

class OperatorView {
 public:
  /// `arms_itself`: at the start no request to arm is shown. `scene_path`: argument of tactctl.
  OperatorView(const hal::Device& device, const hal::SafetyLines& lines, bool arms_itself,
               std::string scene_path = "SCENE");

  /// Called a few times a second with the newest frame. Faults go to standard error. True: this
  /// call has reported that the device is ready and may be armed.
  bool show(const protocol::Frame& newest);
  /// After a disarm: only an operator may arm again.
  void wait_for_person() { arms_itself_ = false; }
  /// The reason to refuse the request, by the frame shown last; empty if it may be made.
  std::string why_not_arm() const;
  std::string why_not_reset() const;
  /// One message: device, state, force, any fault, a tool inside the organ, and how often contact
  /// was lost.
  std::string status() const;
  const std::string& device() const { return name_; }
  /// One message to standard error, on its own line.
  void report(const std::string& message) const;
  /// Ends the live line.
  void end() const;

 private:
  bool waits(loop::State state);
  void report_inside(const protocol::Frame& newest);

  const hal::Device& device_;
  const hal::SafetyLines& lines_;
  std::string name_, scene_path_;
  bool terminal_, arms_itself_, reported_ready_ = false;
  bool inside_ = false;  // the tool is inside the organ and gets no force
  protocol::Frame before_;
  std::string waits_for_, notice_;
};

/// The detail of a fault as device or safety lines report it.
std::string fault_detail_of(model::Fault fault, const hal::Device& device,
                            const hal::SafetyLines& lines);

/// One run in one line, for a terminal: time, rate, late ticks, force, state, the fault or limit
/// that acts, and how often contact was lost. The rate is ticks over time since `before`; 0 when no
/// time has passed.
std::string status_line(const protocol::Frame& frame, const protocol::Frame& before);

}  // namespace tact::firmware::console
