// SPDX-License-Identifier: Apache-2.0
#include "firmware/watch/loop_monitor.h"

#include "firmware/loop/release_schedule.h"
#include "model/time_ns.h"

namespace tact::firmware::watch {

std::optional<model::Error> LoopMonitor::start(const pc::RtSettings& loop) {
  auto thread = hal::threads::start_thread("tact-watch", [this, loop] {
    std::vector<pc::Shortfall> known;
    // pc::probe_rt_threads has already reported what is refused here.
    enter_watch_thread(loop, known);
    run();
    leave_guardian();
    pc::leave_rt_thread();
  });
  if (!thread) return thread.error();
  thread_ = std::move(*thread);
  return std::nullopt;
}

// At real-time priority, so that a regular end is not taken for a silence.
void LoopMonitor::leave_guardian() RT_SAFE {
  if (guardian_.own_count != nullptr) guardian_.own_count->store(0, std::memory_order_relaxed);
}

void LoopMonitor::stop() {
  ending_.store(true, std::memory_order_relaxed);
  thread_.join();
  leave_guardian();
}

void LoopMonitor::run() RT_SAFE {
  // Relaxed: join() orders all that the end needs.
  while (!ending_.load(std::memory_order_relaxed)) {
    clock_.sleep_until_ns(next_ns(clock_.now_ns()));
    check();
  }
}

void LoopMonitor::check() RT_SAFE {
  // Requests::trip keeps the first fault: a stall is reported in preference to a lost guardian.
  const model::Fault found = stall_.step(progress_);
  if (found != model::Fault::kNone) requests_.trip(found);
  if (found == model::Fault::kNone && guardian_.own_count != nullptr)
    guardian_.own_count->fetch_add(1, std::memory_order_relaxed);
  if (is_guardian_gone()) requests_.trip(model::Fault::kGuardianLost);
  if (suspend_.step(clock_.suspended_ns())) requests_.trip(model::Fault::kLoopLate);
  if (requests_.fault.load(std::memory_order_relaxed) != model::Fault::kNone) lines_.drop();
}

// The guardian counts at least every 0.25 s: lost after two missed increments and a margin.
bool LoopMonitor::is_guardian_gone() RT_SAFE {
  constexpr std::int64_t kHeld_ns = 600 * model::kMillisecond_ns;  // chosen
  if (guardian_.is_lost == nullptr) return false;
  if (guardian_.is_lost->load(std::memory_order_relaxed)) return true;
  if (guardian_.its_count == nullptr) return false;
  const std::uint64_t now = guardian_.its_count->load(std::memory_order_relaxed);
  guardian_still_ns_ = now == guardian_before_ ? guardian_still_ns_ + stall_.check_ns() : 0;
  guardian_before_ = now;
  return guardian_still_ns_ > kHeld_ns;
}

// Halfway between two deadlines, so that on a shared core the watch does not delay the loop's
// wake-up. The schedule is absolute: its own delay, below half a period, does not accumulate.
std::int64_t LoopMonitor::next_ns(std::int64_t now_ns) const RT_SAFE {
  const std::int64_t period_ns = stall_.period_ns();
  return loop::next_half_way_ns(now_ns + stall_.check_ns() - period_ns / 2, period_ns);
}

}  // namespace tact::firmware::watch
