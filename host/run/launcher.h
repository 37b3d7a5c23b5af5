// SPDX-License-Identifier: Apache-2.0
// launcher.h - the wire to who has started tact-view with --scenes (tools/run): a wish goes to it
// as a line of standard output, and why it came to nothing comes as a line of standard input.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>
#include <string>

namespace tact::host::run {

class Launcher {
 public:
  using Refused = std::function<void(const std::string& sentence)>;
  Launcher(boost::asio::io_context& io, Refused refused);

  void start() { read_next(); }
  static void hand(const std::string& line);

 private:
  void read_next();

  boost::asio::posix::stream_descriptor input_;
  Refused refused_;
  std::string text_;
};

}  // namespace tact::host::run
