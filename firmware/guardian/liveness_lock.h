// SPDX-License-Identifier: Apache-2.0
// liveness_lock.h - a page that two processes share: each learns that the other ended or is held.
//
//     let_go() by the holder     await() returns kLetGo: a regular end
//     holder's thread has ended  await() returns kDied: the kernel marks the robust mutex when the
//     without let_go()           thread exits, before it frees memory of the process (RT-18)
//     holder counts no more      await() returns kSilent: a core dump, SIGSTOP, a debugger, a
//                                frozen cgroup. At 0 it is not watched
//     waiter counts no more      the holder's watch sees it by the waiter's count
//
// It lies in an anonymous memory file shared by descriptor. All but await() is set-up code.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>

#include "model/result.h"

namespace tact::firmware::guardian {

struct LivenessPage {
  pthread_mutex_t mutex;
  std::atomic<std::uint64_t> holder_count, waiter_count;  // of a new page: 0
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

class LivenessLock {
 public:
  enum class End { kLetGo, kDied, kSilent };

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
  /// Until the holder has ended, or has counted nothing for `silence_ns`, at most half as long
  /// again. It looks, and counts, twice in that time, between two periods of the loop.
  End await(std::int64_t silence_ns, std::int64_t period_ns);

  LivenessPage& page() const { return *page_; }

 private:
  LivenessLock(int fd, LivenessPage* page) : fd_(fd), page_(page) {}

  int fd_;
  LivenessPage* page_;
};

}  // namespace tact::firmware::guardian
