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

std::optional<pc::Shortfall> lift_rttime_limit() {
  rlimit limit{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  getrlimit(RLIMIT_RTTIME, &limit);
  if (limit.rlim_cur == RLIM_INFINITY && limit.rlim_max == RLIM_INFINITY) return std::nullopt;
  const rlimit none{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  // Raising a hard limit takes a privilege; without it the soft limit is raised to the hard one.
  if (setrlimit(RLIMIT_RTTIME, &none) == 0) return std::nullopt;
  const rlimit most{.rlim_cur = limit.rlim_max, .rlim_max = limit.rlim_max};
  setrlimit(RLIMIT_RTTIME, &most);
  if (limit.rlim_max == RLIM_INFINITY) return std::nullopt;
  return pc::Shortfall{
      fmt::format("the kernel kills a real-time thread of this session after {} us without a sleep "
                  "(RLIMIT_RTTIME), without a word; start tactd after ulimit -R unlimited, or take "
                  "rttime out of "
                  "/etc/security/limits.d/",
                  limit.rlim_max)};
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
