// SPDX-License-Identifier: Apache-2.0
// operator_tracking.h - the tracker's input in the viewer: datagrams or a recorded file in, the
// operator's bodies out.
//
//     UDP on 127.0.0.1, or a file in real time -> observation.h -> operator_tracker.h -> now()
//
// One thread, the viewer's: a pose takes about 50 us, so that a thread and a slot of its own would
// buy nothing. What cannot be used is counted, and the first of it told. No force depends on it.
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

  /// `say` gets what a person should know, one line each; may be empty.
  OperatorTracking(boost::asio::io_context& io, Say say);

  /// kNo: poses stay in the tracker's frame, for who wants to find the registration.
  enum class Registered : std::uint8_t { kNo, kYes };

  /// Reads a tracking description (SCENE.tracking.toml, README.md) and opens its input. Error: what
  /// is wrong and what to do.
  std::optional<model::Error> open(const std::string& path,
                                   Registered registered = Registered::kYes);
  /// From here on observations are taken, by the io_context's thread.
  void start();
  void stop();

  /// The bodies as they are now: states and ages follow the clock. Same thread as the io_context.
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
  std::array<char, kMaxObservationBytes + 1> datagram_{};  // a longer one is too long
  std::optional<OperatorTracker> tracker_;
  std::unique_ptr<ObservationPlayer> player_;
  TrackedOperator now_;
  Say say_;
  std::chrono::steady_clock::time_point began_;
  std::uint64_t refused_ = 0, refused_by_content_ = 0;
  int failures_ = 0;  // of the socket, one after the other
  std::uint16_t port_ = 0;
};

}  // namespace tact::host::tracking
