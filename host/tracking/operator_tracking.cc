// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/operator_tracking.h"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/system/error_code.hpp>

namespace tact::host::tracking {
namespace {

constexpr int kMaxFailures = 100;  // of the socket, in a row

}  // namespace

using boost::asio::ip::udp;
using boost::system::error_code;
using model::Error;
using model::Result;

OperatorTracking::OperatorTracking(boost::asio::io_context& io, Say say)
    : io_(io), socket_(io), say_(std::move(say)), began_(std::chrono::steady_clock::now()) {}

double OperatorTracking::now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

void OperatorTracking::say(const std::string& message) const {
  if (say_) say_(message);
}

std::optional<Error> OperatorTracking::open(const std::string& path, Registered registered) {
  Result<TrackingSetup> setup = load_tracking_setup(path);
  if (!setup) return setup.error();
  if (registered == Registered::kNo) {
    setup->registration = {};
  } else if (setup->registered_by.empty()) {
    say(
        fmt::format("{}: there is no registration; the tracker's frame is taken for the device's, "
                    "tact-view --register finds the right one",
                    path));
  }
  if (std::optional<Error> error =
          // 0 means a recording: tracking_setup.cc has checked that there is exactly one input.
      setup->udp_port != 0 ? listen(setup->udp_port) : load(setup->recording)) {
    return error;
  }
  tracker_.emplace(std::move(*setup));
  return std::nullopt;
}

std::optional<Error> OperatorTracking::listen(std::uint16_t port) {
  error_code wrong;
  socket_.open(udp::v4(), wrong);
  // Loopback only, because the sender of a datagram cannot be verified.
  if (!wrong) socket_.bind({boost::asio::ip::address_v4::loopback(), port}, wrong);
  if (wrong) {
    return Error{
        fmt::format("UDP port {} on 127.0.0.1: {}; stop the other program or write another "
                    "udp_port",
                    port, wrong.message())};
  }
  port_ = port;
  return std::nullopt;
}

std::optional<Error> OperatorTracking::load(const std::string& recording) {
  Result<ObservationFile> file = read_observation_file(recording);
  if (!file) return file.error();
  if (std::optional<Error> error = check_loop(recording, *file)) return error;
  if (file->bad > 0) {
    refused_ = file->bad;
    say(fmt::format("{}; {} such lines are left out", file->first_bad, file->bad));
  }
  player_ = std::make_unique<ObservationPlayer>(io_, std::move(file->seen),
                                                [this](const Observation& seen) { take(seen); });
  return std::nullopt;
}

void OperatorTracking::start() {
  if (player_) player_->start();
  if (port_ != 0) receive_next();
}

void OperatorTracking::stop() {
  error_code ignored;
  socket_.close(ignored);
  if (player_) player_->stop();
}

void OperatorTracking::receive_next() {
  socket_.async_receive_from(
      boost::asio::buffer(datagram_), sender_, [this](error_code wrong, std::size_t size) {
        if (wrong == boost::asio::error::operation_aborted) return;
        failures_ = wrong ? failures_ + 1 : 0;
        if (failures_ == kMaxFailures) {  // otherwise this thread would be busy with the errors
          say(fmt::format("tracking: its port fails ({}); it ends here", wrong.message()));
          return;
        }
        if (!wrong) {
          const Result<Observation> seen = parse_observation({datagram_.data(), size});
          seen ? take(*seen) : refuse(seen.error());
        }
        receive_next();
      });
}

void OperatorTracking::take(const Observation& seen) {
  if (const std::optional<Error> error = tracker_->take(seen, now_s())) refuse(*error);
}

void OperatorTracking::refuse(const Error& error) {
  // A faulty sender repeats its fault in each datagram.
  if (refused_by_content_++ == 0) {
    say(fmt::format("tracking: an observation is left out: {}; others like it are only counted",
                    error.message));
  }
  ++refused_;
}

const TrackedOperator& OperatorTracking::now() { return now_ = tracker_->at(now_s()); }

}  // namespace tact::host::tracking
