// SPDX-License-Identifier: Apache-2.0
// rt_loop.h - the haptic loop: read, detect, render, limit, write, publish, at fixed deadlines.
//
// Deadlines are absolute (release_schedule.h). A tick that ends after the next deadline is late;
// the deadlines that have passed are skipped and counted, the release schedule never shifts
// (RT-14). At the end of the loop zero force is written; a fault of that write is reported.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/loop/clock.h"
#include "firmware/loop/clutch.h"
#include "firmware/loop/contact_exchange.h"
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

/// Statistics of a run. Read them after run() has returned.
struct LoopStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;     // ended after the next deadline
  std::uint64_t skipped_ticks = 0;  // releases that had no tick
  std::uint64_t contact_losses = 0;
  std::uint32_t clutches = 0;       // times that the clutch has opened
  std::uint64_t inside_ticks = 0;   // with a sphere inside the organ, without force
  double max_force_N = 0.0;         // written
  double max_torque_Nm = 0.0;       // written
  double max_grip_force_N = 0.0;    // written, on the fingers
  double max_rms_force_N = 0.0;     // written, over limits.thermal_time_s
  double max_given_energy_J = 0.0;  // given minus taken since arming
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
    record_.margin_ns = settings.period_ns;  // before the first tick: a full period
  }

  /// Steps until a stop request, max_ticks or max_periods, then calls release_device().
  void run() RT_SAFE;
  /// Sleeps to the next deadline and does one tick.
  void step() RT_SAFE;
  bool may_run() const RT_SAFE;
  /// Removes power permission and writes zero force: the last call of every loop.
  void release_device() RT_SAFE;
  /// Offers of other numbers of the law.
  ContactExchange& contacts() { return contacts_; }
  const LoopStatistics& statistics() const { return statistics_; }
  /// For the watch; callable at any time.
  const Progress& progress() const { return progress_; }

 private:
  /// Phases in this order: read, detect, render, limit, write; then publish.
  void tick(std::int64_t due_ns) RT_SAFE;
  /// Copies the pending request into this tick's input.
  void hear_requests() RT_SAFE;
  void answer_requests() RT_SAFE;
  bool arms_at_start() const RT_SAFE;
  Fault read(std::int64_t now_ns) RT_SAFE;
  void use_clutch(bool pressed) RT_SAFE;
  void write() RT_SAFE;
  void publish() RT_SAFE;
  /// Reads the clock. marked_ns() extrapolates it by the counter, only to time the phases.
  std::int64_t now_ns() RT_SAFE;
  std::int64_t marked_ns() RT_SAFE { return marked_.at_ns(clock_.mark()); }
  /// Ends a phase that began at `since_ns`; returns marked_ns().
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
  std::uint32_t heard_ = 0;           // newest request of a person that a tick has taken
  bool answers_ = false;              // this tick has taken a request
  Fault write_fault_ = Fault::kNone;  // latches in the next tick
  StopTimer stop_timer_;
  ContactExchange contacts_;
  Progress progress_;
};

}  // namespace tact::firmware::loop
