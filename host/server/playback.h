// SPDX-License-Identifier: Apache-2.0
// playback.h - plays a recording, with its operator, into the view: at its own speed or another,
// from a position that a page chooses, once or repeatedly.
//
// It starts with the first page and stops at its last frame, so that a fault and the time before it
// stay visible. All pages show the same frame.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "host/server/live_view.h"
#include "host/server/replay_request.h"

namespace tact::host::server {

class Playback {
 public:
  /// `recording` must have a frame.
  Playback(boost::asio::io_context& io, LiveView& view, record::Recording recording,
           std::string name);

  void start();
  void stop();
  void steer(const ReplayRequest& request);

 private:
  void report();
  void show(std::size_t frame);
  void schedule();
  void play_next(std::uint64_t turn);
  std::size_t frame_at(double at_s) const;
  bool is_last() const { return shown_ + 1 == recording_.frames.size(); }

  boost::asio::steady_timer timer_;
  LiveView& view_;
  record::Snapshot recording_;
  std::string name_;
  std::vector<std::int64_t> at_ns_;  // of each frame, since the first; never decreases
  std::size_t shown_ = 0;
  std::chrono::steady_clock::time_point due_;
  std::uint64_t turn_ = 0;  // identifies the valid timer; an older handler does nothing
  bool playing_ = true, repeats_ = false;
  double speed_ratio_ = 1.0;
};

}  // namespace tact::host::server
