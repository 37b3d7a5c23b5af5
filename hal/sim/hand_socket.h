// SPDX-License-Identifier: Apache-2.0
// hand_socket.h - lets a person move the simulated hand: a local datagram socket and its thread.
//
// The thread is an ordinary one, started before the loop, and runs only when a datagram comes: no
// timer of it falls into a tick. It passes the newest sound HandTarget to
// the loop through a LatestSlot and ignores everything else. The socket file belongs to its owner
// only (mode 0600). A file left behind by a dead process is replaced, a living one is not.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hal/sim/hand_target.h"
#include "hal/threads/latest_slot.h"
#include "hal/threads/thread.h"
#include "model/io/socket_file.h"
#include "model/result.h"

namespace tact::hal::sim {

/// Magic, version, finite position within a metre, a turn of at most pi, finite grip.
bool is_sound(const HandTarget& target) RT_SAFE;

class HandSocket {
 public:
  /// Listens at `path` until stop(). The slot must outlive this.
  static model::Result<std::unique_ptr<HandSocket>> start(const std::string& path,
                                                          threads::LatestSlot<HandTarget>& newest);
  HandSocket(const HandSocket&) = delete;
  HandSocket& operator=(const HandSocket&) = delete;
  ~HandSocket();

  /// Ends the thread and removes the socket file; safe to call twice.
  void stop();
  const std::string& path() const { return path_; }

 private:
  HandSocket(int descriptor, const std::string& path, threads::LatestSlot<HandTarget>& newest);
  void listen();

  int descriptor_;
  std::string path_;
  model::io::SocketFile file_;
  threads::LatestSlot<HandTarget>& newest_;
  std::atomic<bool> stopping_{false};
  threads::Thread thread_;  // last: it uses the others
};

}  // namespace tact::hal::sim
