// SPDX-License-Identifier: Apache-2.0
// control_socket.h - what a person asks of a running tactd by tactctl: one word, one message back.
//
// A Unix socket of its owner alone, 0600, in a folder that nobody else can write to. The kernel
// says who asks (SO_PEERCRED); the same user and root are heard. No way leads here from a network.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::firmware::console {

/// What was done, or the reason why not.
struct Answer {
  bool done = false;
  std::string message;
};

/// As it goes over the socket, one message: '+' done or '-' refused, then the message.
std::string pack_answer(const Answer& answer);
Answer unpack_answer(const std::string& message);

inline constexpr std::size_t kLongestControlMessage = 1024;

/// Somebody waits for the answer; an unanswered request is closed.
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
  /// Listens at `path`, in whose folder it removes what killed ones left.
  static model::Result<std::unique_ptr<ControlSocket>> open(const std::string& path);
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;
  /// Removes its own file alone: another may stand there by now.
  ~ControlSocket();

  /// Readable when next() has something to do.
  int fd() const { return watch_; }
  /// The oldest request that is there. Waits 20 ms at most, where descriptors have run out.
  std::optional<ControlRequest> next();

 private:
  ControlSocket(model::io::SocketFile file, int listener, int watch)
      : file_(std::move(file)), listener_(listener), watch_(watch) {}
  bool accept_one();
  std::optional<ControlRequest> read(int client);

  model::io::SocketFile file_;
  int listener_, watch_;
  int spare_ = -1;           // a descriptor to be heard with when no other is free
  std::vector<int> silent_;  // clients that have not asked yet
};

}  // namespace tact::firmware::console
