// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/loop_executor.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "firmware/run/thread_costs.h"

namespace tact::firmware::run {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kTimeout_ns = 3'000'000'000;  // longer than any device needs to stop
// Chosen: the device gets 2 s to stop, and the process ends within 6 s even if a call hangs.
constexpr auto kDeviceStop = 2000ms, kLook = 10ms;
constexpr unsigned kShutdownFrames_s = 6;

}  // namespace

LoopExecutor::LoopExecutor(const GuardedLoop& guarded)
    : guarded_(guarded), runaway_(guarded.requests) {
  // Before the loop, because no thread may start when the PC is short of something.
  auto stopper = hal::threads::start_thread("tact-stop", [this] {
    hung_.acquire();
    if (!ended_.load()) guarded_.device.stop();
    stopped_.store(true);
  });
  auto executor = stopper ? hal::threads::start_thread("tact-executor", [this] { run_all(); })
                          : stopper.error();
  if (!executor) {
    error_ = executor.error();
    guarded_.device.stop();
    ended_.store(true);
  } else {
    executor_ = std::move(*executor);
  }
  if (stopper) stopper_ = std::move(*stopper);
}

LoopExecutor::~LoopExecutor() {
  // No thread serves the loop any more; one that has ended keeps its state for the report.
  if (!ended_.load()) guarded_.requests.stop.store(true);
  static_cast<void>(join());  // its error was returned before
  hung_.release();
}

// Not in the loop's thread, whose filter would refuse the system calls of Device::stop().
void LoopExecutor::run_all() {
  for (const LoopRun& one : guarded_.runs) {
    error_ = run_one(one);
    if (error_ || guarded_.requests.stop.load()) break;
  }
  guarded_.device.stop();  // at once, because drives expect cyclic messages of their host
  ended_.store(true);
}

std::optional<model::Error> LoopExecutor::run_one(const LoopRun& one) {
  // The watch starts before the loop's thread and stops after it, so it monitors every tick.
  watch::GuardianLink link;
  if (const auto* guardian = guarded_.guardian)
    link = {.is_lost = &guardian->is_lost(),
            .own_count = &guardian->page().holder_count,
            .its_count = &guardian->page().waiter_count};
  watch::LoopMonitor watch(watch::StallDetector(guarded_.period_ns, guarded_.hard_real_time),
                           one.progress, guarded_.requests, guarded_.lines, link);
  if (auto error = watch.start(guarded_.rt)) return error;
  auto loop = hal::threads::start_thread("tact-loop", [&] {
    add_to(costs_, run_as_loop_thread(guarded_.rt, one.run, guarded_.filter));
  });
  if (!loop) return loop.error();
  loop->join();
  watch.stop();
  return std::nullopt;
}

bool LoopExecutor::hangs() {
  if (!guarded_.requests.stop.load() || ended_.load()) return false;
  const std::int64_t now_ns = loop::MonotonicClock().now_ns();
  // The timeout starts when the request is first noticed, from any source.
  if (asked_ns_ == 0) asked_ns_ = now_ns;
  return now_ns - asked_ns_ > kTimeout_ns;
}

std::optional<model::Error> LoopExecutor::join() {
  executor_.join();
  return error_;
}

// The device's stop and the disk may hang, too: SIGALRM ends the process then. The guardian takes
// this exit for a death and zeroes the device once more.
void LoopExecutor::leave_behind(int status, const std::function<void()>& shutdown_frames) {
  // The lines first: the power goes off even if a call below hangs.
  guarded_.lines.drop();
  std::signal(SIGALRM, [](int) { _exit(1); });
  alarm(kShutdownFrames_s);
  hung_.release();
  for (auto waited = 0ms; !stopped_.load() && waited < kDeviceStop; waited += kLook)
    std::this_thread::sleep_for(kLook);
  shutdown_frames();
  // No destructors, because one would wait for the loop's thread.
  _exit(status);
}

}  // namespace tact::firmware::run
