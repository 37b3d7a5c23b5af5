// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/observation_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <map>
#include <sstream>
#include <utility>

#include "host/tracking/body_tracker.h"
#include "model/io/input_file.h"

namespace tact::host::tracking {
namespace {

using model::Error;
using model::Result;

// Chosen; one turn is an image period at 60 Hz, so the thread is never blocked.
constexpr double kLongestGap_s = 60.0;  // a longer one is shortened to this
constexpr double kTurn_s = 1.0 / 60.0;  // from the last line to the first

}  // namespace

Result<ObservationFile> read_observation_file(const std::string& path) {
  auto text = model::io::read_file(
      path, "give a file of observations, one per line; cut a larger one into parts",
      kMaxRecording_bytes);
  if (!text) return text.error();
  std::istringstream file(std::move(*text));
  ObservationFile out;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    // A file from Windows has lines that end with \r.
    if (line.empty() || line == "\r") continue;
    Result<Observation> seen = parse_observation(line);
    if (seen)
      out.seen.push_back(std::move(*seen));
    else if (out.bad++ == 0)
      out.first_bad = fmt::format("{}:{}: {}", path, number, seen.error().message);
  }
  if (!out.seen.empty()) return out;
  if (out.bad > 0) return Error{out.first_bad};
  return Error{fmt::format("{}: it is empty; give a file of observations", path)};
}

std::optional<Error> check_loop(const std::string& path, const ObservationFile& file) {
  struct Span {
    double first_s = 0.0, last_s = 0.0;
  };
  std::map<std::pair<std::string, std::string>, Span> spans;  // by camera and body
  for (const Observation& seen : file.seen) {
    Span& span =
        spans.try_emplace({seen.camera, seen.body}, Span{seen.time_s, seen.time_s}).first->second;
    span.last_s = std::max(span.last_s, seen.time_s);
  }
  for (const auto& [who, span] : spans) {
    // A shorter step back counts as out of order (body_tracker.h), so the repetition would be
    // rejected.
    if (span.last_s - span.first_s > kRestart_s) continue;
    return Error{fmt::format(
        "{}: camera {} looks at body {} for {:.2f} s, and a file that begins again at its end "
        "needs more than {:g} s; record longer or leave these lines out",
        path, who.first, who.second, span.last_s - span.first_s, kRestart_s)};
  }
  return std::nullopt;
}

void ObservationPlayer::start() {
  next_ = 0;
  timer_.expires_after(std::chrono::nanoseconds(0));
  play();
}

void ObservationPlayer::stop() {
  boost::system::error_code ignored;
  timer_.cancel(ignored);
}

double ObservationPlayer::gap_s(std::size_t next) const {
  return std::clamp(seen_[next].time_s - seen_[next - 1].time_s, 0.0, kLongestGap_s);
}

void ObservationPlayer::play() {
  timer_.async_wait([this](boost::system::error_code wrong) {
    if (wrong) return;
    double wait_s = 0.0;
    while (!(wait_s > 0.0)) {  // all observations of this moment; ends because kTurn_s > 0
      take_(seen_[next_++]);
      if (next_ < seen_.size()) {
        wait_s = gap_s(next_);
      } else {
        next_ = 0;
        wait_s = kTurn_s;
      }
    }
    const std::chrono::duration<double> wait(wait_s);
    // Absolute times: small delays do not accumulate.
    timer_.expires_at(timer_.expiry() +
                      std::chrono::duration_cast<std::chrono::steady_clock::duration>(wait));
    play();
  });
}

}  // namespace tact::host::tracking
