// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "firmware/loop/clock.h"
#include "firmware/loop/release_schedule.h"
#include "firmware/telemetry/force_hash.h"
#include "firmware/telemetry/utc_clock.h"
#include "model/io/json.h"
#include "model/time_ns.h"

namespace tact::firmware::telemetry {

Telemetry::Telemetry(loop::TickRing& ring, FrameBuilder builder, const FramePace& pace, Sinks sinks,
                     const std::atomic<model::Fault>* watch_fault)
    : ring_(ring),
      builder_(std::move(builder)),
      pace_(pace),
      sinks_(std::move(sinks)),
      watch_fault_(watch_fault),
      force_hash_(model::kFnvStart) {}

// An error of the log is lost here: call stop() first to get it.
Telemetry::~Telemetry() { static_cast<void>(stop()); }

std::optional<model::Error> Telemetry::start() {
  auto thread = hal::threads::start_thread("tact-telemetry", [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(*thread);
  return std::nullopt;
}

std::optional<model::Error> Telemetry::stop() {
  ending_.store(true, std::memory_order_relaxed);
  // The thread first: from here on this one is the only reader of the ring.
  thread_.join();
  drain();
  publish();
  if (sinks_.recorder) {
    sinks_.recorder->report_fault(watch_fault());  // a fault after the loop's last tick
    sinks_.recorder->finish();
  }
  std::optional<model::Error> error = sinks_.log ? sinks_.log->close() : std::nullopt;
  const auto failed = sinks_.history ? sinks_.history->finish() : std::nullopt;
  if (!error && failed) error = model::Error{*failed};
  return error;
}

void Telemetry::run() {
  loop::MonotonicClock clock;
  const std::int64_t frame_ns = model::period_ns(pace_.frame_rate_Hz);
  // Absolute times, as in the loop: a slow disk delays one frame without shifting later ones.
  std::int64_t due_ns = clock.now_ns(), utc_due_ns = due_ns;
  while (!ending_.load(std::memory_order_relaxed)) {
    drain();
    publish();
    if (due_ns >= utc_due_ns) {
      set_utc(due_ns);
      utc_due_ns = due_ns + model::kSecond_ns;
    }
    due_ns += frame_ns;
    // Halfway between two deadlines: a wake-up at a deadline would disturb the same phase of every
    // tick (RT-14).
    clock.sleep_until_ns(loop::next_half_way_ns(due_ns, pace_.loop_period_ns));
  }
}

void Telemetry::set_utc(std::int64_t now_ns) {
  const protocol::UtcOffset utc = read_utc_offset();
  builder_.set_utc(utc);
  if (sinks_.history) report(sinks_.history->work((now_ns + utc.offset_ns) / model::kSecond_ns));
}

void Telemetry::drain() {
  while (ring_.pop(record_)) {
    // Every record goes to every sink; which ticks become a frame is decided in publish().
    if (record_.input.variant != variant()) change_variant();
    builder_.add(record_);
    force_hash_ = hash_wrench(force_hash_, record_.output.written);
    if (sinks_.history) sinks_.history->add(record_);
    if (!sinks_.log && sinks_.recorder == nullptr) continue;
    const LoggedTick tick = builder_.log(record_);
    if (sinks_.log) sinks_.log->add(chunk_of(tick, sinks_.tick_fields));
    if (sinks_.recorder) sinks_.recorder->add(tick);
  }
  report(sinks_.log ? sinks_.log->news() : std::nullopt);
}

void Telemetry::report(std::optional<std::string> news) {
  if (!news) return;
  const std::lock_guard lock(newest_mutex_);
  record_news_ = std::move(news);
}

std::optional<std::string> Telemetry::record_news() {
  const std::lock_guard lock(newest_mutex_);
  return std::exchange(record_news_, std::nullopt);
}

void Telemetry::expect_variant(std::uint32_t variant, const std::vector<std::string>& set,
                               const model::contact::IndentationView& indentations) {
  const nlohmann::json numbers{{"variant", variant}, {"set", set}};
  const std::lock_guard lock(newest_mutex_);
  expected_.push_back({variant,
                       chunk_of(protocol::ChunkKind::kVariant, model::io::text_of(numbers)),
                       &indentations});
}

// Before the first tick of the new tissue. One that was replaced before the loop took it is left
// out.
void Telemetry::change_variant() {
  const std::lock_guard lock(newest_mutex_);
  for (const Expected& expected : std::exchange(expected_, {})) {
    if (expected.variant > record_.input.variant) expected_.push_back(expected);
    if (expected.variant != record_.input.variant) continue;
    builder_.use(*expected.indentations);
    if (sinks_.log) sinks_.log->add(expected.chunk);
    if (sinks_.recorder) sinks_.recorder->add_variant(expected.chunk);
  }
  variant_.store(record_.input.variant, std::memory_order_release);
}

// A fault from the watch goes into the next frame. If the loop no longer ticks, the last frame is
// sent again with the fault.
std::optional<Frame> Telemetry::next_frame() {
  const model::Fault found = watch_fault();
  std::optional<Frame> frame;
  if (builder_.has_news()) {
    frame = builder_.take(ring_.dropped());
  } else {
    if (sinks_.recorder) sinks_.recorder->report_fault(found);
    // Only this thread writes newest_, so it reads it without the lock.
    if (found != model::Fault::kNone && newest_.fault == 0) frame = newest_;
  }
  // The loop's own fault has precedence; the watch's is used if the loop reported none.
  if (frame && frame->fault == 0 && found != model::Fault::kNone) {
    frame->fault = static_cast<std::uint16_t>(found);
    frame->state = loop::State::kStopped;
  }
  return frame;
}

void Telemetry::publish() {
  if (sinks_.log) sinks_.log->flush();  // who follows the log gets each tick as a viewer its frame
  if (const std::optional<Frame> frame = next_frame()) {
    if (sinks_.recorder) sinks_.recorder->add(*frame);
    if (sinks_.socket) {
      // Never waits: a viewer that does not read loses the frame.
      sinks_.socket->send(chunk_of(*frame, sinks_.frame_fields));
      dropped_frames_.store(sinks_.socket->dropped_frames(), std::memory_order_relaxed);
    }
    const std::lock_guard lock(newest_mutex_);
    newest_ = *frame;
  }
  if (sinks_.recorder) sinks_.recorder->work();
}

Frame Telemetry::newest_frame() const {
  const std::lock_guard lock(newest_mutex_);
  return newest_;
}

}  // namespace tact::firmware::telemetry
