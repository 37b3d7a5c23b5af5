// SPDX-License-Identifier: Apache-2.0
// telemetry_client.h - receives tactd's messages: the start of a run with its meshes, then frames.
//
// Connects to tactd's socket and retries twenty times a second, before tactd starts and after the
// connection ended. Every message is checked before it is passed on. In the other direction it
// sends only a hand target for a simulated device; it cannot command a force.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/protocol/run_file.h"
#include "host/record/telemetry_check.h"
#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::host::run {

/// $XDG_RUNTIME_DIR/tact/telemetry.sock, or /tmp/tact-<uid>/telemetry.sock.
std::string default_telemetry_path();

struct TelemetryEvents {
  std::function<void(const record::RunHeader&, record::MeshBytes)> start;
  std::function<void(const record::Frame&)> frame;
  std::function<void(const std::string& reason)> lost;  // once per loss; reason may be empty
  /// Connected, but no frame for 0.3 s (2.5 periods, if longer). 0: frames arrive again.
  std::function<void(double silence_s)> silent{};
};

class TelemetryClient {
 public:
  /// `trust`: the user whose tactd is trusted, in addition to the same user and root.
  TelemetryClient(boost::asio::io_context& io, std::string path, TelemetryEvents events,
                  const model::io::Trust& trust = {});
  ~TelemetryClient();
  TelemetryClient(const TelemetryClient&) = delete;
  TelemetryClient& operator=(const TelemetryClient&) = delete;

  void start();
  void stop();

  /// Target of a simulated hand, W. Dropped for hardware or without a receiver.
  void move_hand(const double (&position_m)[3], const double (&rotation_rad)[3], double grip_ratio);

 private:
  void connect();
  void retry_later();
  void lose(const std::string& reason);
  void wait_for_data();
  void listen();
  bool has_data();
  bool read_message();
  std::optional<model::Error> take_start(std::string_view message, int memory_file);
  std::optional<model::Error> take_frame(std::string_view message);

  boost::asio::posix::stream_descriptor socket_;
  boost::asio::steady_timer retry_, silence_;
  std::string path_;
  model::io::Trust trust_;
  TelemetryEvents events_;
  int hand_socket_ = -1;
  record::RunHeader header_;
  std::optional<firmware::protocol::Unpacker> frames_;  // by the table in the head
  bool has_start_ = false, is_silent_ = false;
  std::string last_reason_ = "never";  // a reason is reported once, not at every retry
};

}  // namespace tact::host::run
