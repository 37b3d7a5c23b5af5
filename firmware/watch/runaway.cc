// SPDX-License-Identifier: Apache-2.0
#include "firmware/watch/runaway.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>

namespace tact::firmware::watch {
namespace {

std::atomic<loop::Requests*> runaway_requests{nullptr};
static_assert(std::atomic<loop::Requests*>::is_always_lock_free);

// Runs in any thread; lock-free stores only. The loop must end, because nothing else would free the
// core of a loop that does not sleep.
void on_runaway(int) {
  loop::Requests* requests = runaway_requests.load();
  if (requests == nullptr) return;
  requests->trip(model::Fault::kLoopRanAway);
  requests->stop.store(true);
}

}  // namespace

namespace {

/// The hard limit that stays, in units of the kernel; RLIM_INFINITY: none.
rlim_t lift(__rlimit_resource which) {
  rlimit limit{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  getrlimit(which, &limit);
  const rlimit none{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  // Raising a hard limit takes a privilege; without it the soft limit is raised to the hard one.
  if (setrlimit(which, &none) == 0) return RLIM_INFINITY;
  const rlimit most{.rlim_cur = limit.rlim_max, .rlim_max = limit.rlim_max};
  setrlimit(which, &most);
  return limit.rlim_max;
}

}  // namespace

std::vector<pc::Shortfall> lift_time_limits() {
  std::vector<pc::Shortfall> kept;
  if (const rlim_t most_us = lift(RLIMIT_RTTIME); most_us != RLIM_INFINITY)
    kept.push_back({fmt::format(
        "the kernel kills a real-time thread of this session after {} us without a sleep "
        "(RLIMIT_RTTIME), without a word; start tactd after ulimit -R unlimited, or take rttime "
        "out of /etc/security/limits.d/",
        most_us)});
  if (const rlim_t most_s = lift(RLIMIT_CPU); most_s != RLIM_INFINITY)
    kept.push_back({fmt::format(
        "the kernel kills this process after {} s of CPU time (RLIMIT_CPU), without a word; start "
        "tactd after ulimit -t unlimited, or take cpu out of /etc/security/limits.d/",
        most_s)});
  return kept;
}

RunawayGuard::RunawayGuard(loop::Requests& requests, rlim_t longest_us) {
  runaway_requests.store(&requests);
  struct sigaction action{};
  action.sa_handler = on_runaway;
  // The signal may arrive in any thread: SA_RESTART repeats its interrupted call.
  action.sa_flags = SA_RESTART;
  sigaction(SIGXCPU, &action, nullptr);
  // The soft limit sends the signal. The hard limit, which kills, is left as it was.
  if (getrlimit(RLIMIT_RTTIME, &before_) != 0) return;
  const rlimit ours{.rlim_cur = std::min(longest_us, before_.rlim_max),
                    .rlim_max = before_.rlim_max};
  setrlimit(RLIMIT_RTTIME, &ours);
}

// The handler stays installed: a signal still pending must not end the process.
RunawayGuard::~RunawayGuard() {
  if (before_.rlim_max != 0) setrlimit(RLIMIT_RTTIME, &before_);
  runaway_requests.store(nullptr);
}

}  // namespace tact::firmware::watch
