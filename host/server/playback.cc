// SPDX-License-Identifier: Apache-2.0
#include "host/server/playback.h"

#include <algorithm>
#include <boost/system/error_code.hpp>
#include <chrono>

namespace tact::host::server {
namespace {

constexpr std::chrono::nanoseconds kPause{1'000'000'000};  // before it starts again
constexpr std::int64_t kLongestGap_ns = 5'000'000'000;     // a gap in the file is not waited out

}  // namespace

Playback::Playback(boost::asio::io_context& io, LiveView& view, record::Recording recording,
                   std::string name)
    : timer_(io), view_(view), recording_(std::move(recording)), name_(std::move(name)) {}

void Playback::start() {
  view_.begin(recording_.hello, recording_.mesh, Link::kReplay, name_);
  timer_.expires_after(std::chrono::nanoseconds(0));
  play_next();
}

void Playback::stop() {
  boost::system::error_code ignored;
  timer_.cancel(ignored);
}

void Playback::play_next() {
  timer_.async_wait([this](boost::system::error_code wrong) {
    if (wrong) return;
    if (next_ == recording_.frames.size()) {
      next_ = 0;
      view_.rewind();
    }
    const record::Frame& frame = recording_.frames[next_];
    view_.add(frame, recording_.operator_at(next_), recording_.figure_at(next_));
    ++next_;
    std::chrono::nanoseconds wait = kPause;
    if (next_ < recording_.frames.size()) {
      const std::int64_t gap_ns = recording_.frames[next_].time_ns - frame.time_ns;
      wait = std::chrono::nanoseconds(std::clamp<std::int64_t>(gap_ns, 0, kLongestGap_ns));
    }
    timer_.expires_at(timer_.expiry() + wait);  // absolute: small delays do not add up
    play_next();
  });
}

}  // namespace tact::host::server
