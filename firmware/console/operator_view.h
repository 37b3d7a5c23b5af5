// SPDX-License-Identifier: Apache-2.0
// operator_view.h - what the person at the PC is told while the loop runs: a live line on a
// terminal, each fault when it latches, and what a device that is not ready waits for.
#pragma once

#include <string>

#include "firmware/telemetry/telemetry_record.h"
#include "hal/device.h"
#include "hal/safety_lines.h"

namespace tact::firmware::console {

class OperatorView {
 public:
  /// `arms_itself`: nobody is asked to arm at the start. `scene_path`: what tactctl is given.
  OperatorView(const hal::Device& device, const hal::SafetyLines& lines, bool arms_itself,
               std::string scene_path = "SCENE");

  /// A few times a second, with the newest frame. Faults go to standard error. True: it has just
  /// told that the device is ready, and may be armed from now on.
  bool show(const telemetry::Frame& newest);
  /// It has been disarmed, and does not arm itself any more.
  void wait_for_person() { arms_itself_ = false; }
  /// Empty where the person may ask for it, by what was told last.
  std::string why_not_arm() const;
  std::string why_not_reset() const;
  /// One message: device, state, force, the fault if there is one, a tool inside the organ, and
  /// how often contact was lost.
  std::string status() const;
  const std::string& device() const { return name_; }
  /// One message to standard error, beside the live line.
  void report(const std::string& message) const;
  /// Ends the live line.
  void end() const;

 private:
  bool waits(loop::State state);
  void report_inside(const telemetry::Frame& newest);

  const hal::Device& device_;
  const hal::SafetyLines& lines_;
  std::string name_, scene_path_;
  bool terminal_, arms_itself_, reported_ready_ = false;
  bool inside_ = false;  // the tool, in the organ, without force
  telemetry::Frame before_;
  std::string waits_for_, notice_;
};

/// The cause of a fault as its own part words it; lines and device know more of their own faults.
std::string trouble_behind(model::Fault fault, const hal::Device& device,
                           const hal::SafetyLines& lines);

}  // namespace tact::firmware::console
