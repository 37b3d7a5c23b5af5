// telemetry.h - the ordinary thread behind the ring: feeds viewers, the tick log and the status
// line.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "firmware/ring.h"
#include "firmware/telemetry_frame.h"
#include "firmware/telemetry_socket.h"
#include "firmware/tick_log.h"

namespace tact::firmware {

class Telemetry {
 public:
  /// Without a socket or a log it only drains the ring for the status line.
  Telemetry(TickRing& ring, FrameBuilder builder, double frame_rate_Hz,
            std::optional<TelemetrySocket> socket, std::optional<TickLogWriter> log);
  ~Telemetry();
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  void start();
  /// Takes what is left in the ring and ends the thread. Returns the log's trouble, empty if none.
  std::string stop();

  /// By hand, for runs without real time: empties the ring, shows the newest.
  void drain();
  void publish();

  Frame newest_frame() const;
  std::uint64_t dropped_frames() const { return dropped_frames_.load(std::memory_order_relaxed); }
  /// Over all forces of the run, after stop(); 0 if the ring dropped any.
  std::uint64_t force_hash() const { return ring_.dropped() == 0 ? force_hash_ : 0; }

 private:
  void run();

  TickRing& ring_;
  FrameBuilder builder_;
  double frame_period_s_;
  std::optional<TelemetrySocket> socket_;
  std::optional<TickLogWriter> log_;
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> dropped_frames_{0};
  mutable std::mutex newest_mutex_;  // never met by the loop
  Frame newest_;
  TickRecord record_;
  std::uint64_t force_hash_;
  std::thread thread_;
};

}  // namespace tact::firmware
