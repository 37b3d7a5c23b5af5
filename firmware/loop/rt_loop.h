// SPDX-License-Identifier: Apache-2.0
// rt_loop.h - the haptic loop: read, detect, render, limit, write, publish, at fixed deadlines.
//
// Deadlines are absolute (release_schedule.h). A tick that ends after its own period is late; the
// periods it has eaten are skipped and counted, the release schedule never shifts (RT-14). Whatever
// ends the loop, zero force is written last; a fault of that write is told, too.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/loop/clock.h"
#include "firmware/loop/clutch.h"
#include "firmware/loop/controller.h"
#include "firmware/loop/grip_input.h"
#include "firmware/loop/latency_histogram.h"
#include "firmware/loop/progress.h"
#include "firmware/loop/requests.h"
#include "firmware/loop/ring.h"
#include "firmware/loop/stop_timer.h"
#include "firmware/loop/tick_record.h"
#include "hal/device.h"
#include "hal/safety_lines.h"

namespace tact::firmware::loop {

/// What a run leaves behind. Read it after run() has returned.
struct LoopStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;     // ended after their own period
  std::uint64_t skipped_ticks = 0;  // releases that had no tick
  std::uint64_t contact_losses = 0;
  std::uint32_t clutches = 0;       // times that the clutch has opened
  std::uint64_t inside_ticks = 0;   // a sphere was inside the organ and felt nothing
  double max_force_N = 0.0;         // written
  double max_torque_Nm = 0.0;       // written
  double max_grip_force_N = 0.0;    // written, on the fingers
  double max_rms_force_N = 0.0;     // written, over limits.thermal_time_s
  double max_given_energy_J = 0.0;  // since arming, more than was taken
  StopTimes stop;
  std::array<LatencyHistogram, kPhaseCount> phase;
};

struct LoopSettings {
  std::int64_t period_ns = 1'000'000;
  std::uint64_t max_ticks = 0;        // 0: until a stop request
  std::uint64_t max_periods = 0;      // ticks and skipped periods together; 0: no limit
  std::uint64_t ticks_per_shape = 0;  // 0: never
  GripSettings grip{};
};

class RtLoop {
 public:
  RtLoop(const LoopSettings& settings, hal::Device& device, hal::SafetyLines& lines,
         Controller& controller, Clock& clock, Requests& requests, TickRing& ring)
      : settings_(settings),
        device_(device),
        lines_(lines),
        controller_(controller),
        clock_(clock),
        requests_(requests),
        ring_(ring),
        grip_(settings.grip) {
    record_.margin_ns = settings.period_ns;  // before the first tick nothing is used up
  }

  /// Steps until a stop request, max_ticks or max_periods, then lets go.
  void run() RT_SAFE;
  /// Sleeps to the next deadline and does one tick.
  void step() RT_SAFE;
  bool may_run() const RT_SAFE;
  /// Power permission away and zero force to the device: the last thing that any loop does.
  void release_device() RT_SAFE;
  const LoopStatistics& statistics() const { return statistics_; }
  /// For the watch, at any time.
  const Progress& progress() const { return progress_; }

 private:
  void cycle(std::int64_t due_ns) RT_SAFE;
  /// What others ask goes into this tick.
  void hear_requests() RT_SAFE;
  void answer_requests() RT_SAFE;
  bool arms_at_start() const RT_SAFE;
  Fault read(std::int64_t now_ns) RT_SAFE;
  void use_clutch(bool pressed) RT_SAFE;
  void write() RT_SAFE;
  void publish() RT_SAFE;
  /// Reads the clock; marked_ns() the time since then by marks, for phases alone.
  std::int64_t now_ns() RT_SAFE;
  std::int64_t marked_ns() RT_SAFE { return marked_.at_ns(clock_.mark()); }
  /// The phase ends now, and began then; returns now, by marks.
  std::int64_t end_phase(Phase phase, std::int64_t since_ns) RT_SAFE;
  void record_phase(Phase phase, std::int64_t duration_ns) RT_SAFE;

  LoopSettings settings_;
  hal::Device& device_;
  hal::SafetyLines& lines_;
  Controller& controller_;
  Clock& clock_;
  Requests& requests_;
  TickRing& ring_;
  GripInput grip_;
  Clutch clutch_;
  double device_grip_ratio_ = 0.0;  // of its last sample
  LoopStatistics statistics_;
  TickRecord record_;
  MarkedTime marked_;
  std::int64_t due_ns_ = 0;
  std::uint32_t heard_ = 0;           // the newest request of a person that a tick has taken
  bool answers_ = false;              // this tick has taken it
  Fault write_fault_ = Fault::kNone;  // judged in the next tick
  StopTimer stop_timer_;
  Progress progress_;
};

}  // namespace tact::firmware::loop
