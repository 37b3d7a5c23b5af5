// SPDX-License-Identifier: Apache-2.0
// telemetry_socket.h - sends messages to connected viewers and never waits for one.
//
// A SOCK_SEQPACKET unix socket: permissions 0600 for the same user and root, or 0660 for the
// members of a group, too. A new client gets the first letters of a run and the memory file of its
// start (firmware/protocol/run_file.h), then every frame that fits into its buffer; the others are
// dropped and counted. Nothing is read from a client. A client beyond kMaxClients gets
// protocol::kFull in place of the first letters, and is closed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

class TelemetrySocket {
 public:
  /// Chosen: each client costs a system call per frame.
  static constexpr std::size_t kMaxClients = 32;

  /// Listens at `path`, also for members of the group `viewers`. An error if another tactd already
  /// does. Takes ownership of the memory file `start_fd` on success.
  static model::Result<TelemetrySocket> open(const std::string& path, int start_fd,
                                             std::optional<gid_t> viewers = {});
  TelemetrySocket(TelemetrySocket&& other) noexcept;
  TelemetrySocket& operator=(TelemetrySocket&&) = delete;
  ~TelemetrySocket();

  /// Accepts new clients, then sends the frame's chunk to all.
  void send(const std::string& message);
  std::uint64_t dropped_frames() const { return dropped_frames_; }

 private:
  TelemetrySocket(model::io::SocketFile file, int listen_fd, int start_fd,
                  const model::io::Trust& trust)
      : file_(std::move(file)), listen_fd_(listen_fd), start_fd_(start_fd), trust_(trust) {}
  void accept_clients();
  bool greet(int client_fd) const;

  model::io::SocketFile file_;
  int listen_fd_, start_fd_;
  model::io::Trust trust_;
  std::vector<int> clients_;
  std::uint64_t dropped_frames_ = 0;
};

}  // namespace tact::firmware::telemetry
