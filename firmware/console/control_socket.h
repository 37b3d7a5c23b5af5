// SPDX-License-Identifier: Apache-2.0
// control_socket.h - tactd's side of tactctl: a socket that takes one word and returns one message.
//
// A Unix socket with permissions 0600, in a folder that only its owner can write to. The kernel
// names the client's user (SO_PEERCRED); only the same user and root are served.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::firmware::console {

/// What was done, or why it was refused.
struct Answer {
  bool done = false;
  std::string message;
};

/// One message on the socket: '+' done or '-' refused, then the text.
std::string pack_answer(const Answer& answer);
Answer unpack_answer(const std::string& message);

inline constexpr std::size_t kLongestControlMessage = 1024;
/// Begins a request for other numbers of the law: KEY=VALUE, with spaces between several.
inline constexpr std::string_view kSetWord = "set ";

/// A client waits for the answer; the destructor closes its connection.
class ControlRequest {
 public:
  ControlRequest(int client, std::string word) : client_(client), word_(std::move(word)) {}
  ControlRequest(ControlRequest&& other) noexcept;
  ControlRequest& operator=(ControlRequest&&) = delete;
  ~ControlRequest();

  const std::string& word() const { return word_; }
  void answer(const Answer& answer) const;

 private:
  int client_;
  std::string word_;
};

class ControlSocket {
 public:
  /// Listens at `path`, and removes the sockets of killed tactds from that folder.
  static model::Result<std::unique_ptr<ControlSocket>> open(const std::string& path);
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;
  /// Removes its own file only: another tactd's may stand at the path by now.
  ~ControlSocket();

  /// Readable when next() has work.
  int fd() const { return watch_; }
  /// The oldest waiting request, if any. Sleeps 20 ms if no descriptor is free.
  std::optional<ControlRequest> next();

 private:
  ControlSocket(model::io::SocketFile file, int listener, int watch)
      : file_(std::move(file)), listener_(listener), watch_(watch) {}
  bool accept_one();
  std::optional<ControlRequest> read(int client);

  model::io::SocketFile file_;
  int listener_, watch_;
  int spare_ = -1;           // reserved descriptor, to accept a client when no other is free
  std::vector<int> silent_;  // clients that have sent nothing yet
};

}  // namespace tact::firmware::console
