// SPDX-License-Identifier: Apache-2.0
// playback.h - plays a recording, the operator in it too, into the view with its own timing, from
// the start again at the end.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <string>

#include "host/server/live_view.h"

namespace tact::host::server {

class Playback {
 public:
  Playback(boost::asio::io_context& io, LiveView& view, record::Recording recording,
           std::string name);

  void start();
  void stop();

 private:
  void play_next();

  boost::asio::steady_timer timer_;
  LiveView& view_;
  record::Recording recording_;
  std::string name_;
  std::size_t next_ = 0;
};

}  // namespace tact::host::server
