// SPDX-License-Identifier: Apache-2.0
// Nothing in here may wait but for the clock; nothing locks, allocates, prints or throws.
#include "tools/jitter/run/bare_loop.h"

#include <algorithm>
#include <limits>

#include "firmware/loop/release_schedule.h"

namespace tact::tools::jitter {
namespace {

constexpr std::int64_t kMax_ns = std::numeric_limits<std::int32_t>::max();

std::int32_t clipped(std::int64_t duration_ns) RT_SAFE {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(duration_ns, 0, kMax_ns));
}

}  // namespace

void BareLoop::run() RT_SAFE {
  due_ns_ = firmware::loop::next_deadline_ns(clock_.now_ns() + period_ns_, period_ns_);
  while (!stop_.load(std::memory_order_relaxed) && (max_periods_ == 0 || periods_ < max_periods_))
    step();
}

void BareLoop::step() RT_SAFE {
  using enum firmware::loop::Phase;
  clock_.sleep_until_ns(due_ns_);
  const std::int64_t wake_ns = clock_.now_ns();
  record_.due_ns = due_ns_;
  record_.phase_ns[static_cast<std::size_t>(kWake)] = clipped(wake_ns - due_ns_);
  ring_.push(record_);
  const std::int64_t end_ns = clock_.now_ns();
  for (const auto phase : {kPublish, kTotal})  // reported with the next tick, as the real loop does
    record_.phase_ns[static_cast<std::size_t>(phase)] = clipped(end_ns - wake_ns);
  ++record_.tick;
  due_ns_ += period_ns_;
  const std::int64_t skipped = firmware::loop::periods_missed(due_ns_, end_ns, period_ns_);
  due_ns_ += skipped * period_ns_;
  record_.input.skipped_periods = static_cast<std::uint32_t>(std::min(skipped, kMax_ns));
  periods_ += 1 + static_cast<std::uint64_t>(skipped);
}

}  // namespace tact::tools::jitter
