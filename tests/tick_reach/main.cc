// SPDX-License-Identifier: Apache-2.0
// tact-tick-reach: enters what a tick can enter, and leaves clang's coverage of that alone.
//
// `sim` is the whole loop on the simulated delta with the injected of tact-soak: strokes, faults,
// stops, late ticks, operators. `odrive` and `falcon` are the devices' part of a tick, from the
// first one after opening to a device that is lost. Set-up, tests and physics are not counted.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>

#include "firmware/gate/limits_for.h"
#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/run/loop_parts.h"
#include "hal/falcon/falcon_device.h"
#include "hal/odrive/odrive_delta.h"
#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta.h"
#include "hal/sim/sim_lines.h"
#include "model/scene/tissue.h"
#include "tests/hal/falcon/falcon_bench.h"
#include "tests/hal/falcon_usb/usbfs_bus.h"
#include "tests/hal/odrive/odrive_drives.h"
#include "tests/soak/fault_injection.h"
#include "tests/support/can_bench.h"
#include "tests/tick_reach/counters.h"

namespace tact::tick_reach {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

/// The physics of a simulated device lie between ticks.
class Counted final : public hal::Device {
 public:
  explicit Counted(hal::Device& device) : device_(device) {}
  hal::DeviceInfo info() const override { return device_.info(); }
  hal::Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override {
    return device_.read(sample, now_ns);
  }
  void permit(bool powered) RT_SAFE override { device_.permit(powered); }
  bool ready() const RT_SAFE override { return device_.ready(); }
  hal::Fault write(const hal::Wrench& wrench) RT_SAFE override { return device_.write(wrench); }
  void between_ticks(double elapsed_s) RT_SAFE override {
    counters::pause();
    device_.between_ticks(elapsed_s);
    counters::resume();
  }
  void stop() override { device_.stop(); }

 private:
  hal::Device& device_;
};

// The same laws, loop and gate drive every device.
int reach_sim(const std::string& path) {
  const auto scene = hal::registry::load_scene(path, {});
  if (!scene) return fmt::print(stderr, "tact-tick-reach: {}\n", scene.error().message), 2;
  const auto tissue = model::scene::make_tissue(*scene);
  auto device =
      hal::sim::make_sim_delta(scene->device.of<hal::sim::SimDeviceSettings>(), scene->hand);
  if (!tissue || !device) return 2;
  Counted counted(**device);
  hal::sim::SimLines lines;
  firmware::loop::SimulatedClock clock;
  firmware::loop::Requests requests;
  const auto ring = std::make_unique<firmware::loop::TickRing>();
  const model::Limits limits = firmware::gate::limits_for(scene->limits, (*device)->info());
  firmware::loop::Controller controller((*tissue)->contact_scene(),
                                        firmware::gate::Gate(limits, 1e-9 * kPeriod_ns, 1.0),
                                        /*hard_real_time=*/true);
  firmware::loop::RtLoop loop({.period_ns = kPeriod_ns}, counted, lines, controller, clock,
                              requests, *ring);
  soak::FaultInjection injected(1, scene->hand, kPeriod_ns);
  firmware::loop::State state = firmware::loop::State::kOff;
  firmware::loop::TickRecord record;
  for (int tick = 0; tick < 100'000; ++tick) {
    injected.step(**device, lines, clock, requests, state == firmware::loop::State::kStopped);
    counters::resume();
    loop.step();
    counters::pause();
    if (ring->pop(record)) state = record.output.state;
  }
  return loop.statistics().max_force_N > 0.1 ? 0 : 1;
}

hal::Fault device_tick(hal::Device& device, hal::Sample& sample, std::int64_t now_ns) {
  counters::resume();
  const hal::Fault fault = device.read(sample, now_ns);
  device.permit(true);
  const bool pushes = sample.fresh && device.ready();
  const hal::Fault write_fault =
      device.write({.force_N = {pushes ? 1.0 : 0.0, 0.0, 0.0}, .torque_Nm = {}});
  counters::pause();
  return fault == hal::Fault::kNone ? write_fault : fault;
}

int reach_odrive() {
  tests::PlayedOdrives drives;
  auto device = hal::odrive::start_odrive_delta(
      drives.bus.bus(), tests::jig_settings(tests::published_pose()), 1e9 / kPeriod_ns);
  if (!device) return fmt::print(stderr, "tact-tick-reach: {}\n", device.error().message), 2;
  hal::Sample sample;
  bool was_ready = false;
  for (int tick = 0; tick < 2000; ++tick) {
    drives.millisecond();
    if (tick == 1000) drives.axis[1].error = 0x20;  // its watchdog or any other
    device_tick(**device, sample, 5'000'000'000 + tick * kPeriod_ns);
    was_ready = was_ready || (*device)->ready();
  }
  return was_ready ? 0 : 1;
}

int reach_falcon() {
  tests::Bus bus;
  bus.swallow_out = true;  // what completes, and whom that wakes, lies between ticks
  auto pipe = tests::start(bus);
  hal::falcon::FalconPipe& end = *pipe;
  hal::falcon::FalconDevice device(tests::falcon_settings(), std::move(pipe));
  hal::Sample sample;
  bool was_ready = false;
  for (int tick = 0; tick < 300; ++tick) {
    bus.change([&] {
      while (!bus.out.empty()) bus.finish(bus.out, 0, 16);
    });
    if (tick < 200) bus.send(tests::transfer_of(tests::homed_at({1e-5 * tick, 0.0, 0.0})));
    hal::falcon_usb::usb_pause_ns(2'000'000);  // the USB thread sleeps again
    if (tick == 250) bus.change([&] { bus.submit_error = ENODEV; });
    device_tick(device, sample, hal::monotonic_ns());
    was_ready = was_ready || device.ready();
  }
  bus.change([&] { bus.reap_error = ENODEV; });
  return was_ready && end.health().end != hal::falcon::FalconPipeEnd::kOpen ? 0 : 1;
}

int reach(std::string_view what) {
  if (what == "odrive") return reach_odrive();
  if (what == "falcon") return reach_falcon();
  return reach_sim(TACT_SOURCE_DIR "/model/scenes/liver.toml");
}

}  // namespace
}  // namespace tact::tick_reach

int main(int argc, char** argv) {
  if (argc != 2) return fmt::print(stderr, "usage: tact-tick-reach sim | odrive | falcon\n"), 2;
  const int status = tact::tick_reach::reach(argv[1]);
  tact::tick_reach::counters::keep_only_counted();
  return status;
}
