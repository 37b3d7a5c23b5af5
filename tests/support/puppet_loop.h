// SPDX-License-Identifier: Apache-2.0
// puppet_loop.h - a loop whose device, safety lines and clock do what a test says.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "firmware/loop/rt_loop.h"
#include "hal/device.h"
#include "hal/safety_lines.h"
#include "model/scene/tissue.h"
#include "tests/support/pass_time.h"
#include "tests/support/test_scene.h"

namespace tact::firmware {

// A device that a test moves: presses the plate, and can be slow, silent or broken.
class PuppetDevice : public hal::Device {
 public:
  explicit PuppetDevice(loop::SimulatedClock& clock) : clock_(clock) {}

  hal::DeviceInfo info() const override {
    return {.name = "puppet", .max_force_N = 20.0, .grip = hal::GripKind::kNone};
  }
  void catch_up(std::int64_t) RT_SAFE override {
    ++catch_ups;
    caught_up_first = reads == 0;
  }
  model::Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override {
    ++reads;
    tests::pass_ns(clock_, slow_ns);
    slow_ns = 0;
    if (silent) return model::Fault::kNone;
    sample.tool.position_m = {0, 0, height_m};
    sample.stamp_ns = now_ns;
    ++sample.sequence;
    sample.fresh = true;
    return fault;
  }
  model::Fault write(const model::Wrench& wrench) RT_SAFE override {
    last = wrench;
    ++writes;
    return write_fault;
  }
  void permit(bool powered) RT_SAFE override { permitted = powered; }
  bool ready() const RT_SAFE override { return can_push; }
  void between_ticks(double elapsed) RT_SAFE override { elapsed_s += elapsed; }
  void shift_tool(const model::Vec3& of_tool_m) RT_SAFE override { shift_m = of_tool_m; }
  void stop() override {}

  double height_m = 0.004 - 0.003;
  std::int64_t slow_ns = 0;
  bool silent = false;
  model::Fault fault = model::Fault::kNone, write_fault = model::Fault::kNone;
  model::Wrench last;
  model::Vec3 shift_m;
  int catch_ups = 0, reads = 0, writes = 0;
  bool caught_up_first = false;
  bool permitted = false, can_push = true;
  double elapsed_s = 0.0;

 private:
  loop::SimulatedClock& clock_;
};

// Safety lines that a test sets, and the order of the calls of loop and device.
class PuppetLines final : public hal::SafetyLines {
 public:
  model::Fault read(std::int64_t) RT_SAFE override { return fault; }
  model::Fault write(const hal::LinesTick& tick) RT_SAFE override {
    last = tick;
    writes_of_device_before = device_writes != nullptr ? *device_writes : 0;
    return write_fault;
  }
  std::optional<bool> grip() const RT_SAFE override { return grip_pressed; }
  std::optional<bool> clutch() const RT_SAFE override { return clutch_pressed; }
  std::uint8_t event_word() const RT_SAFE override { return event_bits; }
  bool enabled() const RT_SAFE override { return enable; }
  void scope(bool up) RT_SAFE override { up ? ++ups : ++downs; }
  void stop() override {}

  model::Fault fault = model::Fault::kNone, write_fault = model::Fault::kNone;
  bool enable = true;
  std::uint8_t event_bits = 0;
  std::optional<bool> grip_pressed, clutch_pressed;
  hal::LinesTick last;
  const int* device_writes = nullptr;
  int writes_of_device_before = 0, ups = 0, downs = 0;
};

class PuppetLoop : public testing::Test {
 protected:
  void run_ticks(int n) {
    for (int i = 0; i < n; ++i) loop.step();
  }
  // Comes down from above, as a hand does, so that the contact has no slack.
  void press() {
    device.height_m = 0.006;
    requests.arm_at_start.store(true);
    run_ticks(600);
    for (; device.height_m > 0.001; device.height_m -= 0.00005) loop.step();
    run_ticks(10);
  }
  loop::TickRecord newest() {
    loop::TickRecord record, last;
    while (ring->pop(record)) last = record;
    return last;
  }

  model::scene::Scene scene = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue = std::move(*model::scene::make_tissue(scene));
  loop::SimulatedClock clock;
  PuppetDevice device{clock};
  PuppetLines lines;
  loop::Controller controller{tissue->contact_scene(), gate::Gate(scene.limits, 0.001, 1.0),
                              /*hard_real_time=*/true};
  loop::Requests requests;
  std::unique_ptr<loop::TickRing> ring = std::make_unique<loop::TickRing>();
  loop::RtLoop loop{{.period_ns = 1'000'000}, device, lines, controller, clock, requests, *ring};
};

}  // namespace tact::firmware
