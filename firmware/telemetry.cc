#include "firmware/telemetry.h"

#include <cmath>

#include "firmware/clock.h"
#include "firmware/grid.h"
#include "firmware/replay.h"

namespace tact::firmware {

Telemetry::Telemetry(TickRing& ring, FrameBuilder builder, const FramePace& pace, Sinks sinks,
                     const std::atomic<Fault>* watch_fault)
    : ring_(ring),
      builder_(std::move(builder)),
      pace_(pace),
      sinks_(std::move(sinks)),
      watch_fault_(watch_fault),
      force_hash_(kHashStart) {}

Telemetry::~Telemetry() { stop(); }

void Telemetry::start() { thread_ = std::thread(&Telemetry::run, this); }

std::string Telemetry::stop() {
  ending_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  drain();
  publish();
  if (sinks_.black_box) {
    sinks_.black_box->stands(watch_fault());  // of a loop that ended before it could tell
    sinks_.black_box->finish();
  }
  return sinks_.log ? sinks_.log->close() : std::string();
}

void Telemetry::run() {
  MonotonicClock clock;
  const std::int64_t frame_ns = std::llround(1e9 / pace_.frame_rate_Hz);
  std::int64_t due_ns = clock.now_ns();
  while (!ending_.load(std::memory_order_relaxed)) {
    drain();
    publish();
    due_ns += frame_ns;
    clock.sleep_until_ns(next_half_way_ns(due_ns, pace_.loop_period_ns));
  }
}

void Telemetry::drain() {
  while (ring_.pop(record_)) {
    builder_.add(record_);
    force_hash_ = hash_wrench(force_hash_, record_.output.written);
    if (sinks_.log) sinks_.log->add(record_);
    if (sinks_.black_box) sinks_.black_box->add(record_);
  }
}

// What the watch found goes into the next frame, and into the last one again when the loop stands
// still and sends nothing.
std::optional<Frame> Telemetry::next_frame() {
  const Fault found = watch_fault();
  std::optional<Frame> frame;
  if (builder_.has_news()) {
    frame = builder_.take(ring_.dropped());
  } else {
    if (sinks_.black_box) sinks_.black_box->stands(found);
    if (found != Fault::kNone && newest_.fault == 0) frame = newest_;
  }
  if (frame && frame->fault == 0 && found != Fault::kNone) {
    frame->fault = static_cast<std::uint16_t>(found);
    frame->state = State::kStopped;
  }
  return frame;
}

void Telemetry::publish() {
  if (const std::optional<Frame> frame = next_frame()) {
    if (sinks_.black_box) sinks_.black_box->add(*frame);
    if (sinks_.socket) {
      sinks_.socket->send(*frame);
      dropped_frames_.store(sinks_.socket->dropped_frames(), std::memory_order_relaxed);
    }
    const std::lock_guard lock(newest_mutex_);
    newest_ = *frame;
  }
  if (sinks_.black_box) sinks_.black_box->work();
}

Frame Telemetry::newest_frame() const {
  const std::lock_guard lock(newest_mutex_);
  return newest_;
}

}  // namespace tact::firmware
