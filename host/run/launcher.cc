// SPDX-License-Identifier: Apache-2.0
#include "host/run/launcher.h"

#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/read_until.hpp>
#include <cstdio>
#include <utility>

namespace tact::host::run {
namespace {

constexpr std::size_t kMaxLine_bytes = 4096;  // as much as a pipe takes at once

}  // namespace

Launcher::Launcher(boost::asio::io_context& io, Refused refused)
    : input_(io), refused_(std::move(refused)) {
  boost::system::error_code wrong;
  // A copy: closing it closes nobody's standard input.
  input_.assign(::dup(STDIN_FILENO), wrong);
}

void Launcher::hand(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);  // it waits for this line at the other end of a pipe
}

void Launcher::read_next() {
  boost::asio::async_read_until(input_, boost::asio::dynamic_buffer(text_, kMaxLine_bytes), '\n',
                                [this](boost::system::error_code wrong, std::size_t bytes) {
                                  if (wrong) return;  // nobody is there who could say anything
                                  refused_(text_.substr(0, bytes - 1));
                                  text_.erase(0, bytes);
                                  read_next();
                                });
}

}  // namespace tact::host::run
