// SPDX-License-Identifier: Apache-2.0
// telemetry.h - the ordinary thread behind the ring: feeds viewers, the tick log, a
// recorder and the status line.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "firmware/loop/ring.h"
#include "firmware/telemetry/telemetry_frame.h"
#include "firmware/telemetry/telemetry_socket.h"
#include "firmware/telemetry/tick_log.h"

namespace tact::firmware::telemetry {

/// What else is told every tick and frame, in the telemetry thread: the black box is one.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void add(const loop::TickRecord& record) = 0;
  virtual void add(const Frame& frame) = 0;
  /// A fault of a loop that gives no ticks which could tell it; kNone is none.
  virtual void stands(model::Fault fault) = 0;
  /// Now and then, and once at the end; finish() returns when all is on the disk.
  virtual void work() = 0;
  virtual void finish() = 0;
};

/// Where ticks and frames go; what is missing gets none.
struct Sinks {
  std::optional<TelemetrySocket> socket{};
  std::optional<TickLogWriter> log{};
  Recorder* recorder = nullptr;  // outlives the telemetry
};

/// How often frames leave, and the loop between whose ticks they do (release_schedule.h).
struct FramePace {
  double frame_rate_Hz = 60.0;
  std::int64_t loop_period_ns = 1'000'000;
};

class Telemetry {
 public:
  /// Without any sink it only drains the ring for the status line. `watch_fault` is what the watch
  /// has found: a loop that gives no ticks any more cannot tell it.
  Telemetry(loop::TickRing& ring, FrameBuilder builder, const FramePace& pace, Sinks sinks,
            const std::atomic<model::Fault>* watch_fault = nullptr);
  ~Telemetry();
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  void start();
  /// Takes what is left in the ring, writes what the black box still keeps, and ends the thread.
  /// Returns the log's error, if any.
  std::optional<model::Error> stop();

  /// By hand, for runs without real time: empties the ring, shows the newest.
  void drain();
  void publish();

  Frame newest_frame() const;
  /// Once, as soon as the tick log has lost something: what. Any thread.
  std::optional<model::Error> lost_record();
  std::uint64_t dropped_frames() const { return dropped_frames_.load(std::memory_order_relaxed); }
  /// Over all forces of the run, after stop(); 0 if the ring dropped any.
  std::uint64_t force_hash() const { return ring_.dropped() == 0 ? force_hash_ : 0; }

 private:
  void run();
  std::optional<Frame> next_frame();
  model::Fault watch_fault() const {
    return watch_fault_ == nullptr ? model::Fault::kNone : watch_fault_->load();
  }

  loop::TickRing& ring_;
  FrameBuilder builder_;
  FramePace pace_;
  Sinks sinks_;
  const std::atomic<model::Fault>* watch_fault_;
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> dropped_frames_{0};
  mutable std::mutex newest_mutex_;  // never met by the loop
  Frame newest_;
  std::optional<model::Error> lost_;  // with the newest frame's lock
  bool reported_lost_ = false;
  loop::TickRecord record_;
  std::uint64_t force_hash_;
  std::thread thread_;
};

}  // namespace tact::firmware::telemetry
