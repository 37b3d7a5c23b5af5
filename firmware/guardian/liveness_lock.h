// SPDX-License-Identifier: Apache-2.0
// liveness_lock.h - a robust mutex shared by two processes: the waiter learns how the holder ended.
//
//     let_go() by the holder     await() returns kLetGo: a regular end
//     holder's thread has ended  await() returns kDied: the kernel marks the mutex as soon as the
//     without let_go()           thread exits, before it frees memory of the process (RT-18)
//
// It lies in an anonymous memory file shared by descriptor. All but await() is set-up code.
#pragma once

#include <pthread.h>

#include "model/result.h"

namespace tact::firmware::guardian {

class LivenessLock {
 public:
  enum class End { kLetGo, kDied };

  static model::Result<LivenessLock> make();
  /// From a descriptor of make() received from another process; closed by the destructor.
  static model::Result<LivenessLock> take(int fd);
  LivenessLock(LivenessLock&& other) noexcept;
  LivenessLock& operator=(LivenessLock&&) = delete;
  ~LivenessLock();

  int descriptor() const { return fd_; }
  /// Call from the thread to be monitored; only that thread may call let_go().
  void hold();
  void let_go();
  /// Waits without a timeout for the end of the holder.
  End await();

 private:
  LivenessLock(int fd, pthread_mutex_t* mutex) : fd_(fd), mutex_(mutex) {}

  int fd_;
  pthread_mutex_t* mutex_;
};

}  // namespace tact::firmware::guardian
