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

LoopBack::LoopBack(std::unique_ptr<hal::gpio::EdgeMonitor> edges, std::int64_t period_ns)
    : edges_(std::move(edges)), meter_(period_ns), thread_([this] {
        while (!ending_.load())
          for (const hal::gpio::Edge& edge : edges_->read(std::chrono::milliseconds(20)))
            meter_.add(edge);
      }) {}

LoopBack::~LoopBack() { stop(); }

PulseMeter LoopBack::stop() {
  ending_.store(true);
  if (thread_.joinable()) thread_.join();
  return meter_;
}

}  // namespace tact::tools::jitter
