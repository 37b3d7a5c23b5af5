// SPDX-License-Identifier: Apache-2.0
// operator_tracking.h - the tracker's input in the viewer: reads datagrams or a recorded file and
// gives the operator's bodies.
//
//     UDP on 127.0.0.1, or a file in real time -> observation.h -> operator_tracker.h -> now()
//
// Runs in the viewer's one thread: a pose takes about 50 us, so a thread of its own would gain
// nothing. Invalid input is counted, and its first case reported. No force depends on it.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "host/tracking/observation_player.h"
#include "host/tracking/operator_tracker.h"
#include "model/result.h"

namespace tact::host::tracking {

class OperatorTracking {
 public:
  using Say = std::function<void(const std::string& message)>;

  /// `say` receives messages for a person, one line each; may be empty.
  OperatorTracking(boost::asio::io_context& io, Say say);

  /// kNo: poses stay in the tracker's frame, as --register needs them.
  enum class Registered : std::uint8_t { kNo, kYes };

  /// Reads a tracking description (SCENE.tracking.toml, README.md) and opens its input. The error
  /// states the cause and the remedy.
  std::optional<model::Error> open(const std::string& path,
                                   Registered registered = Registered::kYes);
  /// Starts to take observations, in the io_context's thread.
  void start();
  void stop();

  /// The bodies now: states and ages follow the clock. Call in the io_context's thread.
  const TrackedOperator& now();

  const TrackingSetup& setup() const { return tracker_->setup(); }
  std::uint64_t refused() const { return refused_; }  // datagrams or lines
  std::uint16_t port() const { return port_; }        // 0: a file is played

 private:
  std::optional<model::Error> listen(std::uint16_t port);
  std::optional<model::Error> load(const std::string& recording);
  void receive_next();
  void take(const Observation& seen);
  void refuse(const model::Error& error);
  void say(const std::string& message) const;
  double now_s() const;

  boost::asio::io_context& io_;
  boost::asio::ip::udp::socket socket_;
  boost::asio::ip::udp::endpoint sender_;
  std::array<char, kMaxObservationBytes + 1> datagram_{};  // one byte more shows an oversized one
  std::optional<OperatorTracker> tracker_;
  std::unique_ptr<ObservationPlayer> player_;
  TrackedOperator now_;
  Say say_;
  std::chrono::steady_clock::time_point began_;
  std::uint64_t refused_ = 0, refused_by_content_ = 0;
  int failures_ = 0;  // of the socket, in a row
  std::uint16_t port_ = 0;
};

}  // namespace tact::host::tracking
