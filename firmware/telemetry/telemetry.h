// SPDX-License-Identifier: Apache-2.0
// telemetry.h - the ordinary thread that reads the loop's ring buffer and feeds viewers, the tick
// log, a recorder and the status line.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>

#include "firmware/loop/ring.h"
#include "firmware/protocol/run_file.h"
#include "firmware/telemetry/frame_builder.h"
#include "firmware/telemetry/telemetry_socket.h"
#include "firmware/telemetry/year_history.h"
#include "hal/threads/thread.h"

namespace tact::firmware::telemetry {

/// An additional sink for every tick and frame, called in the telemetry thread: the black box.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void add(const LoggedTick& tick) = 0;
  virtual void add(const Frame& frame) = 0;
  /// Other numbers of the law from the next tick on, as a chunk.
  virtual void add_variant(const std::string& chunk) = 0;
  /// A fault that no tick can report, because the loop no longer ticks. kNone: no fault.
  virtual void report_fault(model::Fault fault) = 0;
  /// work(): called at each frame time. finish(): called at the end; returns when all is on disk.
  virtual void work() = 0;
  virtual void finish() = 0;
};

/// Sinks of ticks and frames; absent ones are skipped.
struct Sinks {
  std::optional<TelemetrySocket> socket{};
  protocol::FieldTable frame_fields = Frame::fields();
  protocol::FieldTable tick_fields = LoggedTick::fields();
  std::optional<protocol::RunWriter> log{};
  Recorder* recorder = nullptr;  // outlives the telemetry
  std::optional<YearHistory> history{};
};

/// Frame rate, and the period of the loop between whose ticks frames are sent (release_schedule.h).
struct FramePace {
  double frame_rate_Hz = 60.0;
  std::int64_t loop_period_ns = 1'000'000;
};

class Telemetry {
 public:
  /// Without sinks it only drains the ring for the status line. `watch_fault` is set by the watch,
  /// because a loop that no longer ticks cannot report its fault.
  Telemetry(loop::TickRing& ring, FrameBuilder builder, const FramePace& pace, Sinks sinks,
            const std::atomic<model::Fault>* watch_fault = nullptr);
  ~Telemetry();
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  [[nodiscard]] std::optional<model::Error> start();
  /// Drains the ring, writes the pending file of the black box, and ends the thread. Returns the
  /// error of the log or the history, if any.
  std::optional<model::Error> stop();

  /// Called by hand in runs without real time: drain() empties the ring, publish() sends a frame.
  void drain();
  void publish();

  /// Call before the loop is offered the tissue with these numbers, each KEY=VALUE. `indentations`
  /// must stay until variant() is a later one.
  void expect_variant(std::uint32_t variant, const std::vector<std::string>& set,
                      const model::contact::IndentationView& indentations);
  /// The variant of the last record that was read.
  std::uint32_t variant() const { return variant_.load(std::memory_order_acquire); }

  Frame newest_frame() const;
  /// What the tick log has lost or dropped, once each. Any thread.
  std::optional<std::string> record_news();
  std::uint64_t dropped_frames() const { return dropped_frames_.load(std::memory_order_relaxed); }
  /// Over all forces of the run, after stop(); 0 if the ring dropped any.
  std::uint64_t force_hash() const { return ring_.dropped() == 0 ? force_hash_ : 0; }

 private:
  void run();
  void change_variant();
  void set_utc(std::int64_t now_ns);
  void report(std::optional<std::string> news);
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
  mutable std::mutex newest_mutex_;  // the loop never takes it
  Frame newest_;
  std::optional<std::string> record_news_;  // guarded by newest_mutex_
  struct Expected {
    std::uint32_t variant;
    std::string chunk;
    const model::contact::IndentationView* indentations;
  };
  std::vector<Expected> expected_;  // guarded by newest_mutex_
  std::atomic<std::uint32_t> variant_{0};
  loop::TickRecord record_;
  std::uint64_t force_hash_;
  hal::threads::Thread thread_;
};

}  // namespace tact::firmware::telemetry
