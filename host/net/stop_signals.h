// SPDX-License-Identifier: Apache-2.0
// stop_signals.h - Ctrl-C and SIGTERM for a program that waits in Asio. Not by its signal_set,
// which loses a signal whose one write fails.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>

namespace tact::host::net {

class StopSignals {
 public:
  explicit StopSignals(boost::asio::io_context& io) : signals_(io) {}

  /// Calls `stop` at the first of these signals. An error: they cannot be waited for.
  boost::system::error_code wait(std::function<void()> stop);

 private:
  boost::asio::posix::stream_descriptor signals_;
};

}  // namespace tact::host::net
