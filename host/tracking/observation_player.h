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

struct PlayedLine {
  std::string text;  // as written, for who sends it on; empty with KeepText::kNo
  Observation seen;
};

struct ObservationFile {
  std::vector<PlayedLine> lines;
  std::size_t bad = 0;
  std::string first_bad;  // file:line: what is wrong
};

enum class KeepText : std::uint8_t { kNo, kYes };

inline constexpr std::uintmax_t kMaxRecording_bytes = 64'000'000;  // hours of a few cameras

/// Error: why the file gives no observation at all. Larger than kMaxRecording_bytes: refused.
model::Result<ObservationFile> read_observation_file(const std::string& path,
                                                     KeepText keep = KeepText::kNo);

/// Error: why the file cannot be played again and again. A camera looks at a body for so short a
/// time that its second round is no new beginning (body_tracker.h) but out of order.
std::optional<model::Error> check_loop(const std::string& path, const ObservationFile& file);

class ObservationPlayer {
 public:
  using Take = std::function<void(const PlayedLine&)>;
  using End = std::function<void()>;

  struct Options {
    double speed_ratio = 1.0;  // > 0
    bool loop = true;          // from the start again at the end
  };

  /// `end` is called after the last line, if it does not loop.
  ObservationPlayer(boost::asio::io_context& io, std::vector<PlayedLine> lines,
                    const Options& options, Take take, End end = {});

  void start();
  void stop();

 private:
  void play();
  /// From the line before to this one, s of the tracker's clock, >= 0.
  double gap_s(std::size_t line) const;

  boost::asio::steady_timer timer_;
  std::vector<PlayedLine> lines_;
  Options options_;
  Take take_;
  End end_;
  std::size_t next_ = 0;
};

}  // namespace tact::host::tracking
