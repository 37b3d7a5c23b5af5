#include "host/tracking/operator_tracking.h"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/system/error_code.hpp>

namespace tact::host {
namespace {

constexpr int kMostFailures = 100;  // of the socket, in a row

}  // namespace

using boost::asio::ip::udp;
using boost::system::error_code;

OperatorTracking::OperatorTracking(boost::asio::io_context& io, Say say)
    : io_(io), socket_(io), say_(std::move(say)), began_(std::chrono::steady_clock::now()) {}

double OperatorTracking::now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

void OperatorTracking::say(const std::string& sentence) const {
  if (say_) say_(sentence);
}

std::string OperatorTracking::open(const std::string& path, Registered registered) {
  TrackingSetup setup;
  if (std::string wrong = load_tracking_setup(path, setup); !wrong.empty()) return wrong;
  if (registered == Registered::kNo) {
    setup.registration = {};
  } else if (setup.registered_by.empty()) {
    say(
        fmt::format("{}: there is no registration; the tracker's frame is taken for the device's, "
                    "tact-view --register finds the right one",
                    path));
  }
  std::string wrong = setup.udp_port != 0 ? listen(setup.udp_port) : load(setup.recording);
  if (wrong.empty()) tracker_.emplace(std::move(setup));
  return wrong;
}

std::string OperatorTracking::listen(std::uint16_t port) {
  error_code wrong;
  socket_.open(udp::v4(), wrong);
  if (!wrong) socket_.bind({boost::asio::ip::address_v4::loopback(), port}, wrong);
  if (wrong) {
    return fmt::format(
        "UDP port {} on 127.0.0.1: {}; stop the other program or write another "
        "udp_port",
        port, wrong.message());
  }
  port_ = port;
  return {};
}

std::string OperatorTracking::load(const std::string& recording) {
  ObservationFile file;
  if (std::string wrong = read_observation_file(recording, file); !wrong.empty()) return wrong;
  if (std::string wrong = why_no_loop(recording, file); !wrong.empty()) return wrong;
  if (file.bad > 0) {
    refused_ = file.bad;
    say(fmt::format("{}; {} such lines are left out", file.first_bad, file.bad));
  }
  player_ =
      std::make_unique<ObservationPlayer>(io_, std::move(file.lines), ObservationPlayer::Options{},
                                          [this](const PlayedLine& line) { take(line.seen); });
  return {};
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
        if (failures_ == kMostFailures) {  // else this thread would do nothing else
          say(fmt::format("tracking: its port fails ({}); it ends here", wrong.message()));
          return;
        }
        if (!wrong) {
          Observation seen;
          const std::string bad = parse_observation({datagram_.data(), size}, seen);
          bad.empty() ? take(seen) : refuse(bad);
        }
        receive_next();
      });
}

void OperatorTracking::take(const Observation& seen) {
  if (const std::string wrong = tracker_->take(seen, now_s()); !wrong.empty()) refuse(wrong);
}

void OperatorTracking::refuse(const std::string& wrong) {
  if (refused_by_content_++ == 0) {
    say(fmt::format("tracking: an observation is left out: {}; others like it are only counted",
                    wrong));
  }
  ++refused_;
}

const TrackedOperator& OperatorTracking::now() { return now_ = tracker_->at(now_s()); }

}  // namespace tact::host
