// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/run/real_time.h"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <ctime>

namespace tact::rig {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void ask_stop(int) { g_stop = 1; }

}  // namespace

std::int64_t monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec;
}

bool enter_real_time(int priority, std::string& error) {
  if (priority <= 0) return true;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    error = std::string("memory cannot be locked (") + std::strerror(errno) +
            "): run as root, or raise the limit memlock; --priority 0 goes without";
    return false;
  }
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) {
    error = "SCHED_FIFO " + std::to_string(priority) + " is refused (" + std::strerror(errno) +
            "): run as root, or raise the limit rtprio; --priority 0 goes without";
    return false;
  }
  return true;
}

void leave_real_time() {
  sched_param parameters{};
  sched_setscheduler(0, SCHED_OTHER, &parameters);
}

void catch_stop_signals() {
  struct sigaction action{};
  action.sa_handler = ask_stop;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

bool stop_asked() { return g_stop != 0; }

bool wait_readable(int fd, std::int64_t until_ns) {
  const std::int64_t left_ns = std::max<std::int64_t>(0, until_ns - monotonic_ns());
  const timespec timeout{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  pollfd one{fd, POLLIN, 0};
  return ppoll(&one, 1, &timeout, nullptr) > 0;
}

}  // namespace tact::rig
