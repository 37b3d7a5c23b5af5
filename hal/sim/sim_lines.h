// SPDX-License-Identifier: Apache-2.0
// sim_lines.h - safety lines without wires: the levels are what a test or a person sets.
//
// The same logic as behind the GPIO chip (hal/gpio/safety_logic.h), the same answers when the chip
// is lost; inputs may be set from any thread.
#pragma once

#include <atomic>

#include "hal/gpio/safety_logic.h"

namespace tact::hal::sim {

class SimLines final : public SafetyLines {
 public:
  struct Inputs {
    std::atomic<bool> estop_a{true}, estop_b{true}, dead_man{true};
    std::atomic<bool> grip{false}, clutch{false};  // pressed
    std::atomic<bool> chip_lost{false};            // every call fails from now on
  };

  explicit SimLines(const gpio::SafetyWiring& wiring = {.estop = true, .dead_man = true})
      : logic_(wiring) {}

  model::Fault read(std::int64_t now_ns) RT_SAFE override {
    if (inputs_.chip_lost.load(std::memory_order_relaxed)) lost_ = true;
    const model::Fault fault =
        logic_.evaluate({.estop_a = inputs_.estop_a.load(std::memory_order_relaxed),
                         .estop_b = inputs_.estop_b.load(std::memory_order_relaxed),
                         .dead_man = inputs_.dead_man.load(std::memory_order_relaxed),
                         .grip = inputs_.grip.load(std::memory_order_relaxed),
                         .clutch = inputs_.clutch.load(std::memory_order_relaxed)},
                        now_ns);
    return lost_ ? model::Fault::kLinesLost : fault;
  }
  model::Fault write(const LinesTick& tick) RT_SAFE override {
    if (inputs_.chip_lost.load(std::memory_order_relaxed)) lost_ = true;
    if (lost_) return outputs_ = {}, model::Fault::kLinesLost;
    outputs_ = logic_.drive(tick);
    return model::Fault::kNone;
  }
  std::optional<bool> grip() const RT_SAFE override { return logic_.grip(); }
  std::optional<bool> clutch() const RT_SAFE override { return logic_.clutch(); }
  bool enabled() const RT_SAFE override { return !lost_ && !dropped_ && logic_.enabled(); }
  void drop() RT_SAFE override { dropped_ = true; }
  void scope(bool) RT_SAFE override {}
  std::string notice() const override { return logic_.notice(); }
  std::string fault_detail() const override {
    return text_of(lost_ ? gpio::LinesCause::kChipLost : logic_.cause());
  }
  void stop() override { outputs_ = {}, lost_ = true; }

  Inputs& inputs() { return inputs_; }
  gpio::SafetyOutputs outputs() const { return dropped_ ? gpio::SafetyOutputs{} : outputs_; }

 private:
  Inputs inputs_;
  gpio::SafetyLogic logic_;
  gpio::SafetyOutputs outputs_;
  std::atomic<bool> lost_{false}, dropped_{false};
};

}  // namespace tact::hal::sim
