#include "firmware/telemetry.h"

#include <chrono>

#include "firmware/replay.h"

namespace tact::firmware {

Telemetry::Telemetry(TickRing& ring, FrameBuilder builder, double frame_rate_Hz,
                     std::optional<TelemetrySocket> socket, std::optional<TickLogWriter> log)
    : ring_(ring),
      builder_(std::move(builder)),
      frame_period_s_(1.0 / frame_rate_Hz),
      socket_(std::move(socket)),
      log_(std::move(log)),
      force_hash_(kHashStart) {}

Telemetry::~Telemetry() { stop(); }

void Telemetry::start() { thread_ = std::thread(&Telemetry::run, this); }

std::string Telemetry::stop() {
  ending_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  drain();
  publish();
  return log_ ? log_->close() : std::string();
}

void Telemetry::run() {
  using std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<steady_clock::duration>(
      std::chrono::duration<double>(frame_period_s_));
  auto due = steady_clock::now();
  while (!ending_.load(std::memory_order_relaxed)) {
    drain();
    publish();
    due += period;
    std::this_thread::sleep_until(due);
  }
}

void Telemetry::drain() {
  while (ring_.pop(record_)) {
    builder_.add(record_);
    force_hash_ = hash_wrench(force_hash_, record_.output.written);
    if (log_) log_->add(record_);
  }
}

void Telemetry::publish() {
  if (!builder_.has_news()) return;
  const Frame frame = builder_.take(ring_.dropped());
  if (socket_) {
    socket_->send(frame);
    dropped_frames_.store(socket_->dropped_frames(), std::memory_order_relaxed);
  }
  const std::lock_guard lock(newest_mutex_);
  newest_ = frame;
}

Frame Telemetry::newest_frame() const {
  const std::lock_guard lock(newest_mutex_);
  return newest_;
}

}  // namespace tact::firmware
