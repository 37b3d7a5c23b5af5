// SPDX-License-Identifier: Apache-2.0
// stub_hd.cc - a library with the symbols of OpenHaptics' libHD.so, for PCs without it: a stand-in
// for tests and for the bench (device.phantom.library = ".../libtact-stub-hd.so").
//
// Behind it a Touch, led by a hand (led_handle.h). As in the vendor's, the device is driven by a
// thread of the library, 1000 times a second, with one frame in each of its cycles; a force counts
// when its frame ends. With TACT_STUB_HD_HANGS_AT=N that thread stops for ever in its N-th cycle.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>

#include "tests/support/stub_hd/stub_hd_state.h"

namespace tact::tests::stub_hd {

std::mutex mutex;
State state;
std::atomic<bool> silent{false};

}  // namespace tact::tests::stub_hd

namespace {

using namespace tact::tests::stub_hd;

constexpr unsigned kInvalidHandle = 0xFFFF'FFFF, kDevice = 7;
constexpr unsigned kBadHandle = 0x0104, kIllegalBegin = 0x0400, kIllegalEnd = 0x0401,
                   kFrameError = 0x0402;
constexpr unsigned kButtons = 0x2000, kTransform = 0x2052, kUsableWorkspace = 0x2551,
                   kForce = 0x2700;
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kCalibrated = 0x5000, kNeedsUpdate = 0x5001;

std::atomic<bool> running{false};
std::atomic<long> cycle{0};
unsigned (*callback)(void*) = nullptr;  // under the mutex, as the next
void* callback_of = nullptr;
struct Scheduler {
  std::thread thread;
  void stop() {
    running = false;
    if (thread.joinable()) thread.join();
  }
  ~Scheduler() { stop(); }
};
Scheduler scheduler;

void enter(const char* function) {
  ++state.calls[function];
  const auto found = state.failing.find(function);
  if (found == state.failing.end() || found->second == 0) return;
  state.errors.push_back(found->second);
  state.bad_frame = true;
}

double number_of(unsigned what) {
  const auto set = state.numbers.find(what);
  return set == state.numbers.end() ? number_of_touch(what) : set->second;
}

/// Of the force output: what is then in the motors acts, or is held until the next "on".
void count_switch(unsigned what) {
  if (what == kForceOutput && state.force_N != std::array<double, 3>{}) ++state.unsafe_calls;
}

void catch_up() {
  state.handle.catch_up([](double) {
    const auto& f = state.force_N;
    return state.output ? std::array{f[2], f[0], f[1]} : std::array<double, 3>{};
  });
}

void call_once_a_millisecond() {
  const char* at = std::getenv("TACT_STUB_HD_HANGS_AT");
  const long hangs_at = at == nullptr ? 0 : std::atol(at);
  timespec due{};
  clock_gettime(CLOCK_MONOTONIC, &due);
  while (running) {
    due.tv_nsec += 1'000'000;
    if (due.tv_nsec >= 1'000'000'000) due.tv_nsec -= 1'000'000'000, ++due.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    ++cycle;
    unsigned (*now)(void*) = nullptr;
    void* of = nullptr;
    {
      const Locked locked;
      now = callback, of = callback_of;
    }
    if (hangs_at > 0 && cycle >= hangs_at)
      for (;;) pause();
    if (silent || now == nullptr || now(of) != 0) continue;
    const Locked locked;
    callback = nullptr;
  }
}

}  // namespace

extern "C" {

// NOLINTBEGIN(readability-identifier-naming): the vendor's names
struct HDErrorInfo {
  unsigned code;
  int internal_code;
  unsigned device;
};

unsigned hdInitDevice(const char* name) {
  const Locked locked;
  enter("hdInitDevice");
  if (!state.errors.empty() && !state.opens_anyway) return kInvalidHandle;
  state.open = true;
  state.name = name == nullptr ? "(default)" : name;
  return kDevice;
}

void hdDisableDevice(unsigned) {
  const Locked locked;
  enter("hdDisableDevice");
  state.open = state.output = false;
}

void hdMakeCurrentDevice(unsigned device) {
  const Locked locked;
  enter("hdMakeCurrentDevice");
  if (device != kDevice || !state.open) state.errors.push_back(kBadHandle);
}

void hdBeginFrame(unsigned) {
  int delay_us = 0;
  {
    const Locked locked;
    delay_us = state.delay_us;
  }
  if (delay_us > 0) usleep(static_cast<useconds_t>(delay_us));
  const Locked locked;
  state.bad_frame = false;
  enter("hdBeginFrame");
  if (state.in_frame || state.frame_of_cycle == cycle) state.errors.push_back(kIllegalBegin);
  state.in_frame = true;
  state.frame_of_cycle = cycle;
  catch_up();
}

void hdEndFrame(unsigned) {
  const Locked locked;
  enter("hdEndFrame");
  if (!state.in_frame) state.errors.push_back(kIllegalEnd);
  state.in_frame = false;
  catch_up();
  state.force_N = state.set_N;
  const auto& f = state.force_N;
  if (state.output) state.strongest_N = std::max(state.strongest_N, std::hypot(f[0], f[1], f[2]));
}

HDErrorInfo hdGetError() {
  const Locked locked;
  if (state.errors.empty()) return {0, 0, 0};
  const unsigned newest = state.errors.back();
  state.errors.pop_back();
  return {newest, 0, kDevice};
}

void hdEnable(unsigned what) {
  const Locked locked;
  enter("hdEnable");
  count_switch(what);
  if (what == kForceOutput && !state.output_lost) state.output = true;
}

void hdDisable(unsigned what) {
  const Locked locked;
  enter("hdDisable");
  count_switch(what);
  catch_up();
  if (what == kForceOutput) state.output = false;
}

unsigned char hdIsEnabled(unsigned what) {
  const Locked locked;
  enter("hdIsEnabled");
  return what == kForceOutput && state.output ? 1 : 0;
}

void hdGetDoublev(unsigned what, double* values) {
  const Locked locked;
  enter("hdGetDoublev");
  if (what == kUsableWorkspace) {
    for (unsigned i = 0; i < 6; ++i) {
      const auto set = state.numbers.find(what + 0x10000 * (i + 1));
      values[i] = set == state.numbers.end() ? kBox_mm[i] : set->second;
    }
  } else if (what == kTransform) {
    if (!state.in_frame) state.errors.push_back(kFrameError);
    const double angle_rad = state.spin_radps * (tact::tests::monotonic_s() - state.handle.begin_s);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double up = std::cos(state.lean_rad), out = std::sin(state.lean_rad);
    const std::array<double, 3> at_mm = to_device_mm(state.handle.position_m);
    if (!std::isfinite(at_mm[0])) state.bad_frame = true;
    // Upright, its handle up; leant towards the operator about x, then turned about y.
    const double columns[16] = {c,       0.0, -s,      0.0, -s * up,  out,      -c * up,  0.0,
                                s * out, up,  c * out, 0.0, at_mm[0], at_mm[1], at_mm[2], 1.0};
    std::copy(columns, columns + 16, values);
    if (state.turned) std::copy(state.turn.begin(), state.turn.end(), values);
  } else {
    *values = number_of(what);
  }
}

void hdGetIntegerv(unsigned what, int* values) {
  const Locked locked;
  enter("hdGetIntegerv");
  *values = static_cast<int>(what == kButtons && state.handle.grips() ? 1.0 : number_of(what));
}

const char* hdGetString(unsigned what) {
  const Locked locked;
  enter("hdGetString");
  return what == 0x2501 ? "Touch" : what == 0x2504 ? state.serial.c_str() : nullptr;
}

void hdSetDoublev(unsigned what, const double* values) {
  const Locked locked;
  const bool was_bad = state.bad_frame;  // by what came before
  enter("hdSetDoublev");
  if (what != kForce) return;
  if (!state.in_frame) state.errors.push_back(kFrameError);
  std::copy(values, values + 3, state.set_N.begin());
  if (was_bad && state.set_N != std::array<double, 3>{}) ++state.unsafe_calls;
}

unsigned hdCheckCalibration() {
  const Locked locked;
  enter("hdCheckCalibration");
  if (state.calibration != kCalibrated && state.calibration != kNeedsUpdate) state.bad_frame = true;
  return state.calibration;
}

void hdUpdateCalibration(unsigned) {
  const Locked locked;
  enter("hdUpdateCalibration");
  if (state.calibration == kNeedsUpdate) state.calibration = kCalibrated;
}

void hdSetSchedulerRate(unsigned long) {
  const Locked locked;
  enter("hdSetSchedulerRate");
}

unsigned long hdScheduleAsynchronous(unsigned (*scheduled)(void*), void* of, unsigned short) {
  const Locked locked;
  enter("hdScheduleAsynchronous");
  callback = scheduled, callback_of = of;
  return 1;
}

void hdUnschedule(unsigned long) {
  const Locked locked;
  enter("hdUnschedule");
  callback = nullptr;
}

void hdStartScheduler() {
  {
    const Locked locked;
    enter("hdStartScheduler");
    if (!state.errors.empty() || running) return;
  }
  running = true;
  scheduler.thread = std::thread(call_once_a_millisecond);
}

void hdStopScheduler() { scheduler.stop(); }
// NOLINTEND(readability-identifier-naming)
}
