// SPDX-License-Identifier: Apache-2.0
#include "tools/program/child_groups.h"

#include <poll.h>

#include <array>
#include <atomic>

namespace tact::tools::program {
namespace {

constexpr std::size_t kMaxGroups = 512;  // more than any --jobs
constexpr int kLongestStart_ms = 1000;

std::array<std::atomic<pid_t>, kMaxGroups> groups{};  // 0: free
std::atomic<int> starting{0};
static_assert(std::atomic<pid_t>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler reads them");

}  // namespace

StartOfChild::StartOfChild() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before_);
  starting.fetch_add(1);
}

StartOfChild::~StartOfChild() {
  starting.fetch_sub(1);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool StartOfChild::remember(pid_t group) {
  for (std::atomic<pid_t>& slot : groups) {
    pid_t free = 0;
    if (slot.compare_exchange_strong(free, group)) return true;
  }
  return false;
}

void forget_child_group(pid_t group) {
  for (std::atomic<pid_t>& slot : groups) {
    pid_t own = group;
    if (slot.compare_exchange_strong(own, 0)) return;
  }
}

void end_child_groups() {
  for (int ms = 0; ms < kLongestStart_ms && starting.load() > 0; ++ms) poll(nullptr, 0, 1);
  for (const std::atomic<pid_t>& slot : groups) {
    const pid_t group = slot.load();
    if (group > 0) kill(-group, SIGKILL);
  }
}

}  // namespace tact::tools::program
