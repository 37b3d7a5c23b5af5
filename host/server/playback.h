// SPDX-License-Identifier: Apache-2.0
// playback.h - plays a recording, the operator in it too, into the view: with its own timing or
// faster or slower, from where a page wants it, once or again and again.
//
// It begins when the first page looks, and rests on its last frame: what led to a fault is seen,
// and so is the fault. All pages see the same.
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
  /// `recording` has a frame.
  Playback(boost::asio::io_context& io, LiveView& view, record::Recording recording,
           std::string name);

  void start();
  void stop();
  void steer(const ReplayRequest& request);

 private:
  void report();
  void show(std::size_t frame);
  void jump_to(std::size_t frame);
  void schedule();
  void play_next(std::uint64_t turn);
  std::size_t frame_at(double at_s) const;
  bool is_last() const { return shown_ + 1 == recording_.frames.size(); }

  boost::asio::steady_timer timer_;
  LiveView& view_;
  record::Recording recording_;
  std::string name_;
  std::vector<std::int64_t> at_ns_;  // of each frame, since the first; never falls
  std::size_t shown_ = 0;
  std::chrono::steady_clock::time_point due_;
  std::uint64_t turn_ = 0;  // of the timer: one that was overtaken does nothing
  bool playing_ = true, repeats_ = false;
  double speed_ratio_ = 1.0;
};

}  // namespace tact::host::server
