// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/loop_back.h"

namespace tact::tools::jitter {

void PulseMeter::add(const hal::gpio::Edge& edge) {
  if (edge.rising) {
    if (rose_ns_) ++unpaired_;
    rose_ns_ = edge.time_ns;
    return;
  }
  if (!rose_ns_ || edge.time_ns - *rose_ns_ > period_ns_)
    ++unpaired_;
  else
    pulses_.record(edge.time_ns - *rose_ns_, pulses_.histogram.count(), *rose_ns_);
  rose_ns_.reset();
}

model::Result<std::unique_ptr<LoopBack>> LoopBack::start(
    std::unique_ptr<hal::gpio::EdgeMonitor> edges, std::int64_t period_ns) {
  std::unique_ptr<LoopBack> back(new LoopBack(std::move(edges), period_ns));
  auto thread = hal::threads::start_thread("tact-edges", [&back = *back] {
    while (!back.ending_.load())
      for (const hal::gpio::Edge& edge : back.edges_->read(std::chrono::milliseconds(20)))
        back.meter_.add(edge);
  });
  if (!thread) return thread.error();
  back->thread_ = std::move(*thread);
  return back;
}

LoopBack::~LoopBack() { stop(); }

PulseMeter LoopBack::stop() {
  ending_.store(true);
  thread_.join();
  return meter_;
}

}  // namespace tact::tools::jitter
