// SPDX-License-Identifier: Apache-2.0
// observation_player.h - plays a file of observations, one per line, at the times in the file.
//
// The order of the file is kept: a line with an earlier time follows at once. Lines that are no
// observation are skipped; ObservationFile has their number and the first of them.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/tracking/observation.h"
#include "model/result.h"

namespace tact::host::tracking {

struct ObservationFile {
  std::vector<Observation> seen;
  std::size_t bad = 0;
  std::string first_bad;  // file:line: what is wrong
};

inline constexpr std::uintmax_t kMaxRecording_bytes = 64'000'000;  // hours of a few cameras

/// The error says why the file has no observation. Files above kMaxRecording_bytes are refused.
model::Result<ObservationFile> read_observation_file(const std::string& path);

/// The error says why the file cannot be repeated: a camera's observations of a body span too short
/// a time, so that a repetition would count as out of order, not as a restart (body_tracker.h).
std::optional<model::Error> check_loop(const std::string& path, const ObservationFile& file);

/// Restarts at the end of the file.
class ObservationPlayer {
 public:
  using Take = std::function<void(const Observation&)>;

  ObservationPlayer(boost::asio::io_context& io, std::vector<Observation> seen, Take take)
      : timer_(io), seen_(std::move(seen)), take_(std::move(take)) {}

  void start();
  void stop();

 private:
  void play();
  /// Time from the previous observation to this one, s of the tracker's clock, >= 0.
  double gap_s(std::size_t next) const;

  boost::asio::steady_timer timer_;
  std::vector<Observation> seen_;
  Take take_;
  std::size_t next_ = 0;
};

}  // namespace tact::host::tracking
