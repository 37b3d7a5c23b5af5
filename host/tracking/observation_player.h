// SPDX-License-Identifier: Apache-2.0
// observation_player.h - plays a file of observations, one per line, with the time that they carry.
//
// The order of the file is kept: a line whose time goes back comes at once. Lines that are no
// observation are left out; ObservationFile says how many and where the first is.
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

/// Error: why the file gives no observation at all. Larger than kMaxRecording_bytes: refused.
model::Result<ObservationFile> read_observation_file(const std::string& path);

/// Error: why the file cannot be played again and again. A camera looks at a body for so short a
/// time that its second round is no new beginning (body_tracker.h) but out of order.
std::optional<model::Error> check_loop(const std::string& path, const ObservationFile& file);

/// From the start again at the end.
class ObservationPlayer {
 public:
  using Take = std::function<void(const Observation&)>;

  ObservationPlayer(boost::asio::io_context& io, std::vector<Observation> seen, Take take)
      : timer_(io), seen_(std::move(seen)), take_(std::move(take)) {}

  void start();
  void stop();

 private:
  void play();
  /// From the observation before to this one, s of the tracker's clock, >= 0.
  double gap_s(std::size_t next) const;

  boost::asio::steady_timer timer_;
  std::vector<Observation> seen_;
  Take take_;
  std::size_t next_ = 0;
};

}  // namespace tact::host::tracking
