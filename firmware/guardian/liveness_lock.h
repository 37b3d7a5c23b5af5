// SPDX-License-Identifier: Apache-2.0
// liveness_lock.h - a robust mutex between two processes: who waits for it learns how its holder
// ended.
//
//     holder lets go      await() gives kLetGo: it leaves in good order
//     holder's thread is  await() gives kDied: the kernel marks the mutex as soon as the thread
//     gone without that   exits, before any memory of its process is freed (RT-18)
//
// It lies in a memory file, so it belongs to both and to no name. Set-up code, but for await().
#pragma once

#include <pthread.h>

#include "model/result.h"

namespace tact::firmware::guardian {

class LivenessLock {
 public:
  enum class End { kLetGo, kDied };

  static model::Result<LivenessLock> make();
  /// Of a descriptor that make() gave to another process; it is closed at the end.
  static model::Result<LivenessLock> take(int fd);
  LivenessLock(LivenessLock&& other) noexcept;
  LivenessLock& operator=(LivenessLock&&) = delete;
  ~LivenessLock();

  int descriptor() const { return fd_; }
  /// By the thread whose end is to be told, and which alone may let go.
  void hold();
  void let_go();
  /// Waits, without limit, for the end of the holder.
  End await();

 private:
  LivenessLock(int fd, pthread_mutex_t* mutex) : fd_(fd), mutex_(mutex) {}

  int fd_;
  pthread_mutex_t* mutex_;
};

}  // namespace tact::firmware::guardian
