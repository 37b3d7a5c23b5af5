#include "firmware/loop_threads.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

#include "firmware/alloc_counter.h"

namespace tact::firmware {
namespace {

constexpr std::int64_t kPatience_ns = 2'000'000'000;
constexpr unsigned kLastWords_s = 2;

}  // namespace

LoopThreads::LoopThreads(const LoopParts& parts)
    : parts_(parts),
      runaway_(parts.requests),
      watch_(StallWatch(parts.period_ns, parts.hard_real_time), parts.loop.progress(),
             parts.requests, parts.lines) {
  watch_.start(parts_.rt);
  keeper_ = std::thread(&LoopThreads::keep, this);
}

// Outside the loop's thread, whose filter would let a device's stop do nothing.
void LoopThreads::keep() {
  std::thread(&LoopThreads::in_loop_thread, this).join();
  watch_.stop();
  parts_.device.stop();  // at once: drives watch for their host
  ended_.store(true);
}

void LoopThreads::in_loop_thread() {
  pthread_setname_np(pthread_self(), "tact-loop");
  std::vector<Shortfall> known;
  enter_rt_thread(parts_.rt, known);
  if (parts_.filter != nullptr) parts_.filter->enter_thread();  // tried before: Session
  rusage before{}, after{};
  {
    const HeapWatch heap;
    getrusage(RUSAGE_THREAD, &before);
    parts_.loop.run();
    getrusage(RUSAGE_THREAD, &after);
    costs_.heap_calls = heap.calls();
  }
  if (parts_.filter != nullptr) parts_.filter->leave_loop();
  leave_rt_thread();
  costs_.heap_calls_known = can_count_heap_calls();
  costs_.minor_faults = after.ru_minflt - before.ru_minflt;
  costs_.major_faults = after.ru_majflt - before.ru_majflt;
  costs_.voluntary_switches = after.ru_nvcsw - before.ru_nvcsw;
  costs_.involuntary_switches = after.ru_nivcsw - before.ru_nivcsw;
}

bool LoopThreads::hangs() {
  if (!parts_.requests.stop.load() || !parts_.loop.progress().running()) return false;
  const std::int64_t now_ns = MonotonicClock().now_ns();
  if (asked_ns_ == 0) asked_ns_ = now_ns;
  return now_ns - asked_ns_ > kPatience_ns;
}

void LoopThreads::join() {
  if (keeper_.joinable()) keeper_.join();
}

// The device may be in the middle of a call that hangs, so its stop may hang, too: SIGALRM ends that.
void LoopThreads::leave_behind(int status) {
  parts_.lines.drop();
  std::signal(SIGALRM, [](int) { _exit(1); });
  alarm(kLastWords_s);
  parts_.device.stop();
  _exit(status);
}

}  // namespace tact::firmware
