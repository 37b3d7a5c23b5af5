// SPDX-License-Identifier: Apache-2.0
// simulated_loop.h - the whole controller on a simulated clock, armed at its start: contact, gate,
// loop. Tissue and device are the caller's and live longer.
#pragma once

#include <memory>

#include "firmware/loop/rt_loop.h"
#include "model/contact/contact.h"
#include "model/time_ns.h"

namespace tact::tools::program {

class SimulatedLoop {
 public:
  SimulatedLoop(const model::contact::ContactScene& contact, const model::Limits& limits,
                double rate_Hz, hal::Device& device)
      : controller_(contact, firmware::gate::Gate(limits, 1.0 / rate_Hz, 1.0),
                    /*hard_real_time=*/true),
        loop_({.period_ns = model::period_ns(rate_Hz)}, device, lines_, controller_, clock_,
              requests_, *ring_) {
    requests_.arm_at_start.store(true);
  }

  /// One tick, and what it left in the ring.
  const firmware::loop::TickRecord& step() {
    loop_.step();
    while (ring_->pop(record_)) continue;
    return record_;
  }

 private:
  firmware::loop::Controller controller_;
  firmware::loop::SimulatedClock clock_;
  firmware::loop::Requests requests_;
  hal::NoSafetyLines lines_;
  std::unique_ptr<firmware::loop::TickRing> ring_ = std::make_unique<firmware::loop::TickRing>();
  firmware::loop::RtLoop loop_;
  firmware::loop::TickRecord record_;
};

}  // namespace tact::tools::program
