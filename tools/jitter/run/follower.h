// SPDX-License-Identifier: Apache-2.0
// follower.h - puts the calling thread above the load and off the loop's core.
#pragma once

#include <pthread.h>
#include <sched.h>

#include "firmware/pc/rt_setup.h"

namespace tact::tools::jitter {

inline constexpr int kFollowPriority = 5;  // above all ordinary work, below anything of a loop

// Above the load and off the loop's core while it lives: to look at the kernel's counters takes the
// kernel some 100 us, in which no other thread of that core wakes. Where FIFO is refused the thread
// stays an ordinary one; on a PC of one core it stays there.
class Follower {
 public:
  explicit Follower(int loop_core) {
    pthread_getaffinity_np(pthread_self(), sizeof before_, &before_);
    cpu_set_t others = before_;
    CPU_CLR(static_cast<std::size_t>(loop_core), &others);
    if (CPU_COUNT(&others) > 0) pthread_setaffinity_np(pthread_self(), sizeof others, &others);
    const sched_param above_the_load{.sched_priority = kFollowPriority};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &above_the_load);
  }
  ~Follower() {
    firmware::pc::leave_rt_thread();  // what is started from here on is ordinary
    pthread_setaffinity_np(pthread_self(), sizeof before_, &before_);
  }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

 private:
  cpu_set_t before_{};
};

}  // namespace tact::tools::jitter
