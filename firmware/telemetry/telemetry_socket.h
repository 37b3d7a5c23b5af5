// SPDX-License-Identifier: Apache-2.0
// telemetry_socket.h - hands messages to whoever listens, and never waits for anyone.
//
// A SOCK_SEQPACKET unix socket with permissions 0600. A new client gets the hello and the mesh
// file, then every frame that fits into its buffer; what does not fit is dropped and counted.
// Nothing is ever read from a client.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/telemetry/telemetry_record.h"
#include "model/result.h"

namespace tact::firmware::telemetry {

/// $XDG_RUNTIME_DIR/tact, or /tmp/tact-<uid>: made with permissions 0700, refused if not ours.
model::Result<std::string> runtime_directory();

class TelemetrySocket {
 public:
  /// Listens at `path`. An error if another tactd does so already. Takes over `mesh_fd`.
  static model::Result<TelemetrySocket> open(const std::string& path, const Hello& hello,
                                             int mesh_fd);
  TelemetrySocket(TelemetrySocket&& other) noexcept;
  TelemetrySocket& operator=(TelemetrySocket&&) = delete;
  ~TelemetrySocket();

  /// Takes in new clients, then offers the frame to all.
  void send(const Frame& frame);
  std::uint64_t dropped_frames() const { return dropped_frames_; }

 private:
  TelemetrySocket(std::string path, const Hello& hello, int listen_fd, int mesh_fd)
      : path_(std::move(path)), hello_(hello), listen_fd_(listen_fd), mesh_fd_(mesh_fd) {}
  void accept_clients();
  bool greet(int client_fd) const;

  std::string path_;
  Hello hello_;
  int listen_fd_, mesh_fd_;
  std::vector<int> clients_;
  std::uint64_t dropped_frames_ = 0;
};

}  // namespace tact::firmware::telemetry
