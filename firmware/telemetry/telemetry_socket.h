// SPDX-License-Identifier: Apache-2.0
// telemetry_socket.h - hands messages to any user listens, and never waits for anyone.
//
// A SOCK_SEQPACKET unix socket with permissions 0600, for the same user and root, or with 0660 for
// the members of a group too. A new client gets the hello and the mesh file, then every frame that
// fits into its buffer; what does not fit is dropped and counted. Nothing is ever read from a
// client.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/telemetry/telemetry_record.h"
#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

class TelemetrySocket {
 public:
  /// Listens at `path`, for the members of the group `viewers` too. An error if another tactd does
  /// so already. Takes over `mesh_fd` unless it fails.
  static model::Result<TelemetrySocket> open(const std::string& path, const Hello& hello,
                                             int mesh_fd, std::optional<gid_t> viewers = {});
  TelemetrySocket(TelemetrySocket&& other) noexcept;
  TelemetrySocket& operator=(TelemetrySocket&&) = delete;
  ~TelemetrySocket();

  /// Takes in new clients, then offers the frame to all.
  void send(const Frame& frame);
  std::uint64_t dropped_frames() const { return dropped_frames_; }

 private:
  TelemetrySocket(model::io::SocketFile file, const Hello& hello, int listen_fd, int mesh_fd,
                  const model::io::Trust& trust)
      : file_(std::move(file)),
        hello_(hello),
        listen_fd_(listen_fd),
        mesh_fd_(mesh_fd),
        trust_(trust) {}
  void accept_clients();
  bool greet(int client_fd) const;

  model::io::SocketFile file_;
  Hello hello_;
  int listen_fd_, mesh_fd_;
  model::io::Trust trust_;
  std::vector<int> clients_;
  std::uint64_t dropped_frames_ = 0;
};

}  // namespace tact::firmware::telemetry
