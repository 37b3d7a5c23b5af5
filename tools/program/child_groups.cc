// SPDX-License-Identifier: Apache-2.0
#include "tools/program/child_groups.h"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>

namespace tact::tools::program {
namespace {

constexpr std::size_t kMaxGroups = 512;  // more than any --jobs
constexpr int kLongestStart_ms = 1000;

std::array<std::atomic<pid_t>, kMaxGroups> groups{};  // 0: free
std::atomic<int> starting{0};

struct Scratch {
  static constexpr pid_t kFree = 0, kChanging = -1;
  std::atomic<pid_t> owner{kFree};  // a process that begins as a copy of it owns none
  std::array<char, 512> path{};

  bool take(pid_t from) { return owner.compare_exchange_strong(from, kChanging); }
};
std::array<Scratch, 16> scratches{};
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

void remember_scratch(const std::string& path) {
  for (Scratch& slot : scratches) {
    if (path.size() >= slot.path.size() || !slot.take(Scratch::kFree)) continue;
    path.copy(slot.path.data(), path.size());
    slot.path[path.size()] = '\0';
    slot.owner = getpid();
    return;
  }
}

void forget_scratch(const std::string& path) {
  for (Scratch& slot : scratches)
    if (slot.take(getpid())) slot.owner = path == slot.path.data() ? Scratch::kFree : getpid();
}

void end_child_groups() {
  for (int ms = 0; ms < kLongestStart_ms && starting.load() > 0; ++ms) poll(nullptr, 0, 1);
  for (const std::atomic<pid_t>& slot : groups) {
    const pid_t group = slot.load();
    if (group > 0) kill(-group, SIGKILL);
  }
  for (const Scratch& slot : scratches) {
    if (slot.owner != getpid()) continue;
    const pid_t child = _Fork();  // fork() may wait for a lock that this thread holds
    if (child == 0) {
      execl("/bin/rm", "rm", "-rf", "--", slot.path.data(), nullptr);
      _exit(1);
    }
    if (child > 0) waitpid(child, nullptr, 0);
  }
}

}  // namespace tact::tools::program
