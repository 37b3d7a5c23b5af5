// SPDX-License-Identifier: Apache-2.0
// player.h - plays a case to the loop: its command as a law, its faults between loop and device.
//
// The loop is the real one (firmware/loop/rt_loop.h). What is played comes from the place of
// the real parts, so the commanded force takes the way of every force: law, contact, gate, device.
// The device and the lines of the bench are behind PlayedDevice and PlayedLines, which see what is
// written last.
#pragma once

#include <cmath>

#include "firmware/loop/clock.h"
#include "hal/device.h"
#include "hal/safety_lines.h"
#include "hal/sim/sim_lines.h"
#include "model/contact/contact_law.h"
#include "tools/limits/cases/plan.h"

namespace tact::tools::limits {

using model::Fault;
using model::Vec3;
using model::Wrench;

/// The progress of a case, in the tick that runs.
struct Moment {
  double period_s = 0.001;
  bool playing = false;  // the gate is open and the case has begun
  int ticks = 0;         // since then

  double t_s() const RT_SAFE { return ticks * period_s; }
  /// From the tick in which the cause of the case comes.
  bool after_cause() const RT_SAFE { return ticks >= cause_tick(); }
  int cause_tick() const RT_SAFE { return static_cast<int>(std::lround(kCause_s / period_s)); }
};

/// What a case commands: force on the tool, by shape. Forces are shares of `limit_N`.
Vec3 command_at(const Case& c, const Moment& now, const model::Tool& tool, double limit_N) RT_SAFE;
/// True in the ticks in which the case injects its fault.
bool is_injected(const Case& c, const Moment& now) RT_SAFE;

/// One spring, always in contact, that pushes as commanded.
class CommandLaw final : public model::contact::ContactLaw {
 public:
  CommandLaw(const Case& c, double limit_N, const Moment& now, const model::Tool& tool)
      : case_(c), limit_N_(limit_N), now_(now), tool_(tool) {}

  model::contact::ContactLawResponse respond(
      const model::contact::Indentation& in) RT_SAFE override;
  void leave(std::size_t) RT_SAFE override {}
  void advance() RT_SAFE override {}
  std::size_t profile(const model::contact::Indentation&,
                      std::span<double>) const RT_SAFE override {
    return 0;
  }
  double ring_pitch_m() const RT_SAFE override { return 0.001; }

 private:
  const Case& case_;
  double limit_N_;
  const Moment& now_;
  const model::Tool& tool_;
};

/// The device of the bench, with the case's injected faults and a witness of what is written.
class PlayedDevice final : public hal::Device {
 public:
  PlayedDevice(const Case& c, const Moment& now, hal::Device& device, firmware::loop::Clock& clock)
      : case_(c), now_(now), device_(device), clock_(clock) {}

  hal::DeviceInfo info() const override { return device_.info(); }
  Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override;
  void permit(bool powered) RT_SAFE override { device_.permit(powered); }
  bool ready() const RT_SAFE override { return device_.ready(); }
  Fault write(const Wrench& wrench) RT_SAFE override {
    written_ = wrench;
    return device_.write(wrench);
  }
  void set_grip_force(double opening_N) RT_SAFE override {
    written_grip_N_ = opening_N;
    device_.set_grip_force(opening_N);
  }
  void between_ticks(double elapsed_s) RT_SAFE override { device_.between_ticks(elapsed_s); }
  std::string fault_detail() const override { return device_.fault_detail(); }
  void stop() override { device_.stop(); }

  const model::Tool& tool() const { return tool_; }
  const Wrench& written() const { return written_; }
  double written_grip_N() const { return written_grip_N_; }

 private:
  const Case& case_;
  const Moment& now_;
  hal::Device& device_;
  firmware::loop::Clock& clock_;
  model::Tool tool_;
  Wrench written_;
  double written_grip_N_ = 0.0;
};

/// The lines of the bench: levels of the simulated ones are set; before real ones the fault is set
/// in their place, as no person can press an e-stop within a given tick.
class PlayedLines final : public hal::SafetyLines {
 public:
  PlayedLines(const Case& c, const Moment& now, hal::SafetyLines& lines,
              hal::sim::SimLines* simulated)
      : case_(c), now_(now), lines_(lines), simulated_(simulated) {}

  Fault read(std::int64_t now_ns) RT_SAFE override;
  Fault write(const hal::LinesTick& tick) RT_SAFE override { return lines_.write(tick); }
  bool enabled() const RT_SAFE override { return lines_.enabled(); }
  void scope(bool up) RT_SAFE override { lines_.scope(up); }
  void drop() RT_SAFE override { lines_.drop(); }
  std::string fault_detail() const override { return lines_.fault_detail(); }
  void stop() override { lines_.stop(); }

 private:
  const Case& case_;
  const Moment& now_;
  hal::SafetyLines& lines_;
  hal::sim::SimLines* simulated_;
};

}  // namespace tact::tools::limits
