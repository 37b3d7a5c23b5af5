// SPDX-License-Identifier: Apache-2.0
// device_loop.h - a device in a loop of about 1 ms on the real clock, as tactd drives it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <functional>

#include "hal/monotonic.h"
#include "hal/registry/open_device.h"
#include "tests/support/no_alloc.h"

namespace tact::tests {

class DeviceLoop : public testing::Test {
 protected:
  static constexpr std::int64_t kMs = 1'000'000;

  static std::int64_t now_ns() { return hal::monotonic_ns(); }
  static void sleep_ms(int ms) {
    const timespec t{.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * kMs};
    nanosleep(&t, nullptr);
  }

  void open(const model::scene::Scene& scene) {
    auto opened = hal::registry::open_device(scene);
    ASSERT_TRUE(opened) << opened.error().message;
    device = std::move(*opened);
    fault = hal::Fault::kNone;
    device->permit(permitted);
    ticked_ns = now_ns();
  }
  void tick(const hal::Wrench& wrench = {}) {
    sleep_ms(1);
    fault = device->read(sample, now_ns());
    device->permit(permitted);
    const hal::Fault written = device->write(wrench);
    if (fault == hal::Fault::kNone) fault = written;
    if (now_ns() - ticked_ns > 80 * kMs) ++silences;  // forces go off at 100
    ticked_ns = now_ns();
  }
  /// Ticks until `done` or for 2 s; false after that.
  bool tick_until(const std::function<bool()>& done, const hal::Wrench& wrench = {}) {
    for (const std::int64_t end_ns = now_ns() + 2000 * kMs; now_ns() < end_ns;) {
      tick(wrench);
      if (done()) return true;
    }
    return false;
  }
  bool ready() {
    return tick_until([&] { return sample.fresh; });
  }
  /// Without a tick, for 2 s at most.
  static bool comes(const std::function<bool()>& done) {
    for (int i = 0; i < 2000 && !done(); ++i) sleep_ms(1);
    return done();
  }
  /// The library of `stub` takes 30 ms for a call: the loop does not wait, and its samples are old.
  template <class Stub>
  void expect_a_hang_to_stop_nothing(Stub& stub) {
    ASSERT_TRUE(ready());
    stub.set_delay_us(30'000);
    sleep_ms(5);
    int fresh = 0;
    std::int64_t in_calls_ns = 0;
    for (int i = 0; i < 20; ++i) {
      const std::int64_t begin_ns = now_ns();
      static_cast<void>(device->read(sample, begin_ns));
      static_cast<void>(device->write({}));
      in_calls_ns += now_ns() - begin_ns;
      fresh += sample.fresh ? 1 : 0;
      sleep_ms(1);
    }
    EXPECT_LT(in_calls_ns, 300 * kMs) << "20 calls of 30 ms take 600";
    EXPECT_LE(fresh, 2) << "what took 30 ms is old";
    stub.set_delay_us(0);
  }
  /// Of led_handle.h: 30 mm by a cosine of 4 s, so at most pi/2 * 30 mm / 2 s = 23.6 mm/s.
  void expect_velocity_of_the_led_handle() {
    ASSERT_TRUE(ready());
    double fastest_mps = 0.0;
    tick_until([&] {
      fastest_mps = std::min(fastest_mps, sample.tool.velocity_mps.z);
      return sample.tool.position_m.z < -0.005;
    });
    EXPECT_LT(fastest_mps, -0.012);
    EXPECT_GT(fastest_mps, -0.060);
  }
  void expect_the_heap_left_alone() {
    ASSERT_TRUE(ready());
    const NoAlloc guard;
    for (int i = 0; i < 50; ++i) tick({.force_N = {0, 0, 1}, .torque_Nm = {}});
    EXPECT_EQ(guard.calls(), 0u);
  }
  bool reported(const std::string& part) const {
    return device->fault_detail().find(part) != std::string::npos;
  }

  hal::registry::OpenDevice device;
  hal::Sample sample;
  hal::Fault fault = hal::Fault::kNone;
  bool permitted = true;
  std::int64_t ticked_ns = 0;
  int silences = 0;  // of the loop, by other work
};

}  // namespace tact::tests
