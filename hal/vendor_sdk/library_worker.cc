// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/library_worker.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "hal/loop_gone.h"

namespace tact::hal::vendor_sdk {
namespace {

using namespace std::chrono_literals;

constexpr int kPriority = 78;                             // the loop has 80
constexpr std::int64_t kZeroFirst_ns = 2'000'000;         // of zero force after the forces went on
constexpr std::int64_t kPoweredForSure_ns = 100'000'000;  // before "forces off" is news

std::atomic<int> hanging{0};  // workers that were given up and have not come back

/// Called at exit before the destructors of a library, which was loaded earlier.
void leave_if_one_hangs(int status, void* /*unused*/) {
  if (hanging == 0) return;
  std::fflush(stdout);
  _exit(status);
}

}  // namespace

// A command lives for three periods of the loop, and never less than a good sample.
LibraryWorker::LibraryWorker(std::int64_t cycle_ns, double rate_Hz)
    : cycle_ns_(cycle_ns),
      command_life_ns_(std::max(kOldest_ns, static_cast<std::int64_t>(3e9 / rate_Hz))) {}

void LibraryWorker::enter_fifo(const char* name) {
  pthread_setname_np(pthread_self(), name);
  const sched_param priority{.sched_priority = kPriority};
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);  // tactd names what it lacks
}

void LibraryWorker::publish(LibraryPose pose) {
  pose.sequence = ++sequence_;
  pose.follows_commands = power_ == Power::kOn;
  poses_.write(pose);
}

std::optional<LibraryForce> LibraryWorker::next_force(std::int64_t now_ns) {
  // Nothing new keeps the last one; its age then shows that the loop is late.
  commands_.read(command_);
  const std::int64_t age_ns = now_ns - command_.stamp_ns;
  if (!follow_power(command_.powered && age_ns <= kLoopGone_ns)) return std::nullopt;
  const bool follow = power_ == Power::kOn && age_ns <= command_life_ns_;
  return follow ? command_.force : LibraryForce{};
}

bool LibraryWorker::follow_power(bool wanted) {
  // Zero force is shown for a while after the forces went on: no step into the hand.
  if (wanted == (power_ != Power::kOff)) {
    if (power_ == Power::kZeroFirst && ++zero_cycles_ * cycle_ns_ >= kZeroFirst_ns)
      power_ = Power::kOn;
    if (power_ == Power::kOn && !powered_for_sure())
      powered_cycles_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
  powered_cycles_.store(0, std::memory_order_relaxed);
  zero_cycles_ = 0;
  power_ = wanted ? Power::kZeroFirst : Power::kOff;
  return switch_forces(wanted);
}

bool LibraryWorker::powered_for_sure() const {
  return powered_cycles_.load(std::memory_order_relaxed) * cycle_ns_ >= kPoweredForSure_ns;
}

std::string LibraryWorker::fault_text(std::int64_t now_ns) const {
  std::string said = cause_text();
  const std::int64_t cycle_ns = last_cycle_ns_;
  // Always the same message, as a reader reports each one that is new.
  if (cycle_ns != 0 && now_ns - cycle_ns > kLibrarySilence_ns)
    said += fmt::format(
        "{}the library has made no call for more than {} ms: the device may still push; switch its "
        "supply off",
        said.empty() ? "" : "; ", kLibrarySilence_ns / 1'000'000);
  return said;
}

void LibraryWorker::thread_ends() {
  if (--running_ == 0 && given_up_.exchange(false)) --hanging;
}

bool LibraryWorker::stop(std::chrono::milliseconds timeout) {
  quit_ = true;
  // No join: a library that hangs must not keep tactd from ending.
  for (auto waited = 0ms; waited < timeout && running_ > 0; waited += 1ms)
    std::this_thread::sleep_for(1ms);
  if (running_ > 0) {
    ++hanging;
    given_up_ = true;
    on_exit(leave_if_one_hangs, nullptr);
    return false;
  }
  close();
  return true;
}

}  // namespace tact::hal::vendor_sdk
