// SPDX-License-Identifier: Apache-2.0
// invariants.h - what must be true after each tick, for any input.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/loop/tick_record.h"
#include "model/limit_witness.h"

namespace tact::soak {

class Invariants {
 public:
  /// Limits of scene and device together (firmware::gate::limits_for).
  Invariants(const model::Limits& limits, std::int64_t period_ns)
      : witness_(limits, static_cast<double>(period_ns) * 1e-9), period_ns_(period_ns) {}

  void check(const firmware::loop::TickRecord& record);

  std::uint64_t broken() const { return broken_; }
  /// The first one that broke, with its tick; empty when all were kept.
  const std::string& first() const { return first_; }

 private:
  void expect(bool kept, const char* promise, std::uint64_t tick);
  void check_state(const firmware::loop::TickRecord& record);

  model::LimitWitness witness_;
  std::int64_t period_ns_;
  std::int64_t first_due_ns_ = 0;
  firmware::loop::TickRecord before_{};
  bool begun_ = false;
  std::uint64_t broken_ = 0;
  std::string first_;
};

}  // namespace tact::soak
