// SPDX-License-Identifier: Apache-2.0
// control_socket.h - what a person asks of a running tactd by tactctl: one word, one sentence back.
//
// A Unix socket of its owner alone, 0600, in a folder that nobody else can write to. The kernel
// says who asks (SO_PEERCRED); the same user and root are heard. No way leads here from a network.
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::firmware::console {

/// What was done, or the reason why not.
struct Answer {
  bool done = false;
  std::string sentence;
};

/// As it goes over the socket, one message: '+' done or '-' refused, then the sentence.
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
  ControlSocket(std::string path, int listener, int watch)
      : path_(std::move(path)), listener_(listener), watch_(watch) {}
  bool accept_one();
  std::optional<ControlRequest> read(int client);
  bool owns_its_file() const;

  std::string path_;
  int listener_, watch_;
  int spare_ = -1;  // a descriptor to be heard with when no other is free
  dev_t device_ = 0;
  ino_t inode_ = 0;
  std::vector<int> silent_;  // clients that have not asked yet
};

/// True for the user of this process, and for root.
bool may_ask(uid_t user);

}  // namespace tact::firmware::console
