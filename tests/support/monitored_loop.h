// SPDX-License-Identifier: Apache-2.0
// monitored_loop.h - a loop on the real clock in a thread of its own, with a device that can hang,
// keep its core busy or make a system call, and an enable line that a test may look at.
#pragma once

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <optional>
#include <thread>

#include "firmware/watch/loop_monitor.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware {

inline constexpr std::int64_t kMs = 1'000'000;

// What a broken device would do; the compiler must not check it.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
inline long ask_parent() RT_SAFE { return syscall(SYS_getppid); }
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

// A device whose call can stay away: asleep, or busy.
class HangingDevice final : public PuppetDevice {
 public:
  HangingDevice() : PuppetDevice(unused_) {}
  model::Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override {
    while (asleep.load()) clock_.sleep_until_ns(clock_.now_ns() + kMs);
    while (busy.load()) clock_.now_ns();
    if (calls.load()) {
      answer = ask_parent();
      called_at = sample.sequence + 1;
      calls.store(false);
    }
    return PuppetDevice::read(sample, now_ns);
  }
  std::atomic<bool> asleep{false}, busy{false}, calls{false};
  long answer = 0;
  std::uint64_t called_at = 0;  // sequence of that sample

 private:
  loop::SimulatedClock unused_;
  loop::MonotonicClock clock_;
};

// An enable line that another thread may look at.
class EnableLine final : public hal::SafetyLines {
 public:
  model::Fault read(std::int64_t) RT_SAFE override { return model::Fault::kNone; }
  model::Fault write(const hal::LinesTick&) RT_SAFE override { return model::Fault::kNone; }
  bool enabled() const RT_SAFE override { return drops.load() == 0; }
  void scope(bool) RT_SAFE override {}
  void drop() RT_SAFE override { ++drops; }
  void stop() override {}
  std::atomic<int> drops{0};
};

class MonitoredLoop : public testing::Test {
 protected:
  ~MonitoredLoop() override {
    device.asleep.store(false);
    device.busy.store(false);
    requests.stop.store(true);
    if (thread.joinable()) thread.join();
  }
  void start(
      const std::function<void()>& before = [] {}, const std::function<void()>& after = [] {}) {
    requests.arm_at_start.store(true);
    thread = std::thread([this, before, after] {
      before();
      loop->run();
      after();
    });
    ASSERT_TRUE(soon([this] { return loop->progress().ticks() > 20; }));
  }
  void finish() {
    requests.stop.store(true);
    thread.join();
  }
  static bool soon(const std::function<bool()>& what) {
    for (int i = 0; i < 20'000 && !what(); ++i) usleep(1000);
    return what();
  }
  // The lowest real-time priority: it must not stand in the way of other tests' loops.
  static void become_real_time(std::atomic<bool>& allowed) {
    const sched_param lowest{.sched_priority = 1};
    allowed = pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest) == 0;
  }

  model::scene::Scene scene = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue = std::move(*model::scene::make_tissue(scene));
  loop::MonotonicClock clock;
  HangingDevice device;
  EnableLine lines;
  loop::Controller controller{tissue->contact_scene(), gate::Gate(scene.limits, 0.001, 1.0), false};
  loop::Requests requests;
  std::unique_ptr<loop::TickRing> ring = std::make_unique<loop::TickRing>();
  std::optional<loop::RtLoop> loop{std::in_place, loop::LoopSettings{.period_ns = kMs},
                                   device,        lines,
                                   controller,    clock,
                                   requests,      *ring};
  watch::LoopMonitor watch{watch::StallDetector(kMs, false), loop->progress(), requests, lines};
  std::thread thread;
};

}  // namespace tact::firmware
