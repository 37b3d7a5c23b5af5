// SPDX-License-Identifier: Apache-2.0
#include "host/server/playback.h"

#include <algorithm>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tact::host::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kPause_ns = 1'000'000'000;            // before a repetition
constexpr std::int64_t kLongestGap_ns = 5'000'000'000;       // a longer gap is shortened to this
constexpr std::int64_t kLongest_ns = std::int64_t{1} << 60;  // a later time in a file is invalid
constexpr std::chrono::seconds kMaxLate{1};  // after a longer suspend the schedule restarts now
constexpr std::size_t kMaxStops = 32;        // reported to the page

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

Playback::Playback(boost::asio::io_context& io, LiveView& view, record::Recording recording,
                   std::string name)
    : timer_(io),
      view_(view),
      recording_(snapshot_of(std::move(recording))),
      name_(std::move(name)) {
  const auto believed_ns = [](const record::Frame& frame) {
    return std::clamp(frame.time_ns, -kLongest_ns, kLongest_ns);
  };
  // Times that step back are held at the latest one: at_ns_ must be sorted for the search.
  std::int64_t latest_ns = 0;
  for (const auto& kept : recording_.frames) {
    latest_ns = std::max(latest_ns,
                         believed_ns(kept->frame) - believed_ns(recording_.frames.front()->frame));
    at_ns_.push_back(latest_ns);
  }
}

void Playback::start() {
  view_.begin(recording_.header, *recording_.mesh, Link::kReplay, name_);
  view_.keep(recording_.frames);
  report();
  show(0);
  view_.when_watched([this] {
    due_ = Clock::now();
    if (playing_) schedule();
  });
}

void Playback::stop() {
  ++turn_;
  timer_.cancel();
}

void Playback::report() {
  using firmware::loop::State;
  nlohmann::json stops = nlohmann::json::array();
  for (std::size_t i = 0; i < at_ns_.size() && stops.size() < kMaxStops; ++i) {
    const record::Frame& frame = recording_.frames[i]->frame;
    const bool was_stopped = i > 0 && recording_.frames[i - 1]->frame.state == State::kStopped;
    if (frame.state == State::kStopped && !was_stopped)
      stops.push_back({{"at_s", seconds(at_ns_[i])}, {"fault", frame.fault}});
  }
  view_.report_replay({{"start_s", seconds(recording_.frames.front()->frame.time_ns)},
                       {"length_s", seconds(at_ns_.back())},
                       {"frames", at_ns_.size()},
                       {"playing", playing_},
                       {"speed_ratio", speed_ratio_},
                       {"repeats", repeats_},
                       {"stops", std::move(stops)}});
}

void Playback::show(std::size_t frame) {
  shown_ = frame;
  const record::KeptFrame& kept = *recording_.frames[frame];
  const record::KeptOperator* const person = kept.person.get();
  view_.add(kept.frame, person != nullptr ? &person->tracked : nullptr,
            person != nullptr && person->figure ? &*person->figure : nullptr);
}

std::size_t Playback::frame_at(double at_s) const {
  const auto found = std::ranges::lower_bound(at_ns_, std::llround(at_s * 1e9));
  return std::min(static_cast<std::size_t>(found - at_ns_.begin()), at_ns_.size() - 1);
}

void Playback::schedule() {
  if (is_last() && !repeats_) {
    playing_ = false;
    return report();
  }
  const std::int64_t gap_ns =
      is_last() ? kPause_ns : std::min(at_ns_[shown_ + 1] - at_ns_[shown_], kLongestGap_ns);
  // Absolute times: small delays do not accumulate.
  due_ = std::max(due_, Clock::now() - kMaxLate) +
         std::chrono::nanoseconds(std::llround(static_cast<double>(gap_ns) / speed_ratio_));
  timer_.expires_at(due_);
  // cancel() cannot remove a handler that is already queued; its outdated number makes it do
  // nothing.
  timer_.async_wait([this, turn = ++turn_](boost::system::error_code wrong) {
    if (!wrong) play_next(turn);
  });
}

void Playback::play_next(std::uint64_t turn) {
  if (turn != turn_) return;
  show(is_last() ? 0 : shown_ + 1);
  schedule();
}

void Playback::steer(const ReplayRequest& request) {
  stop();
  speed_ratio_ = request.speed_ratio.value_or(speed_ratio_);
  repeats_ = request.repeats.value_or(repeats_);
  if (request.at_s) show(frame_at(*request.at_s));
  if (request.step_frames) {
    playing_ = false;
    const std::int64_t wanted = static_cast<std::int64_t>(shown_) + *request.step_frames;
    const auto last = static_cast<std::int64_t>(at_ns_.size()) - 1;
    show(static_cast<std::size_t>(std::clamp<std::int64_t>(wanted, 0, last)));
  }
  if (request.playing) {
    // Play at the end starts again from the beginning.
    if (*request.playing && !playing_ && is_last() && !request.at_s) show(0);
    playing_ = *request.playing;
  }
  due_ = Clock::now();
  if (playing_) schedule();
  report();
}

}  // namespace tact::host::server
