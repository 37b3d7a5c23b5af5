// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_worker.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iterator>
#include <limits>
#include <thread>

#include "hal/force_dimension/sdk_words.h"
#include "hal/monotonic.h"

namespace tact::hal::force_dimension {
namespace {

using model::Fault;
using model::Quat;
using model::Vec3;
using model::Wrench;

// 4 kHz, the rate that the maker claims: the pose is young, and the watchdog fed, whatever the
// loop's rate.
constexpr std::int64_t kLongestCycle_ns = 250'000;
constexpr std::int64_t kMinPause_ns = 50'000;  // a slow library must not starve the PC
// As for a Falcon (loop_silence.h).
constexpr std::int64_t kLoopGone_ns = 100'000'000;
constexpr int kPriority = 78;  // below the loop's 80: a black box must not delay it
constexpr std::int64_t kZeroFirst_ns = 2'000'000;         // of zero force after the forces went on
constexpr std::int64_t kPoweredForSure_ns = 100'000'000;  // before "forces off" is news
constexpr int kTimeGuard = 1;                             // pose: nothing new
constexpr auto kStatusPeriod = std::chrono::milliseconds(50);

void sleep_until_ns(std::int64_t deadline_ns) {
  const timespec t{.tv_sec = deadline_ns / 1'000'000'000, .tv_nsec = deadline_ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

/// R R^T = I within kNoRotation, det R = +1.
bool is_rotation(const double r[3][3]) {
  constexpr double kNoRotation = 1e-3;  // the maker's angles have rounding of their own
  const Vec3 x{r[0][0], r[0][1], r[0][2]}, y{r[1][0], r[1][1], r[1][2]},
      z{r[2][0], r[2][1], r[2][2]};
  const double off[] = {dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0,
                        dot(x, y),       dot(y, z),       dot(z, x)};
  // So written, a NaN is no rotation. The determinant is -1 for a mirror.
  return dot(cross(x, y), z) > 0.0 && std::all_of(std::begin(off), std::end(off), [](double one) {
           return std::abs(one) <= kNoRotation;
         });
}

}  // namespace

// By the largest of the four components (S. Shepperd, J. Guidance 1 (1978) 223).
Quat quat_from_rotation(const double r[3][3]) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!is_rotation(r)) return {kNone, kNone, kNone, kNone};
  const double trace = r[0][0] + r[1][1] + r[2][2];
  const double square[4] = {1.0 + trace, 1.0 + 2.0 * r[0][0] - trace, 1.0 + 2.0 * r[1][1] - trace,
                            1.0 + 2.0 * r[2][2] - trace};  // 4 w^2, 4 x^2, 4 y^2, 4 z^2
  const auto largest = std::max_element(square, square + 4) - square;
  const double twice = std::sqrt(square[largest]), half = 0.5 / twice;
  const double wx = half * (r[2][1] - r[1][2]), wy = half * (r[0][2] - r[2][0]);
  const double wz = half * (r[1][0] - r[0][1]), xy = half * (r[1][0] + r[0][1]);
  const double xz = half * (r[0][2] + r[2][0]), yz = half * (r[2][1] + r[1][2]);
  switch (largest) {
    case 0:
      return {0.5 * twice, wx, wy, wz};
    case 1:
      return {wx, 0.5 * twice, xy, xz};
    case 2:
      return {wy, xy, 0.5 * twice, yz};
    default:
      return {wz, xz, yz, 0.5 * twice};
  }
}

std::string words_of_sdk_trouble(const SdkTrouble& t) {
  switch (t.source) {
    case SdkTroubleSource::kNone:
      return {};
    case SdkTroubleSource::kPose:
      return fmt::format("the device does not tell its pose: {}", words_of_sdk_error(t.code));
    case SdkTroubleSource::kForce:
      return fmt::format("the device does not take a force: {}", words_of_sdk_error(t.code));
    case SdkTroubleSource::kEnable:
      return fmt::format("the device does not switch its forces: {}", words_of_sdk_error(t.code));
    case SdkTroubleSource::kWatch:
      return fmt::format("the device does not tell its status: {}", words_of_sdk_error(t.code));
    case SdkTroubleSource::kForceOff:
      return fmt::format("the device switched its forces off: {}", words_of_force_off(t.code));
    case SdkTroubleSource::kStatus:
      break;
  }
  if (t.fault == Fault::kHomingLost)
    return "the device has lost its calibration; calibrate it, then start tactd again";
  if (t.fault == Fault::kDeviceUnplugged)
    return "the device is no longer connected; plug it in, then start tactd again";
  return t.code == kSdkPower
             ? "the device has no power; switch its supply on, then start tactd again"
             : "the device reports an error of its own; switch it off and on, then start tactd "
               "again";
}

std::int64_t sdk_cycle_ns(double rate_Hz) {
  return std::min(kLongestCycle_ns, static_cast<std::int64_t>(std::llround(1e9 / rate_Hz)));
}

std::shared_ptr<SdkWorker> SdkWorker::start(const SdkSession& session, double rate_Hz,
                                            std::int64_t command_life_ns) {
  std::shared_ptr<SdkWorker> worker(new SdkWorker(session, sdk_cycle_ns(rate_Hz), command_life_ns));
  // Before the threads: stop() must not see zero while they begin.
  worker->running_ = 2;
  // Each thread keeps the worker alive: one that hangs in the library outlives its device.
  std::thread([worker] {
    pthread_setname_np(pthread_self(), "tact-fd");
    const sched_param priority{.sched_priority = kPriority};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);  // tactd names what it lacks
    worker->run();
    --worker->running_;
  }).detach();
  std::thread([worker] {
    pthread_setname_np(pthread_self(), "tact-fd-status");
    worker->watch();
    --worker->running_;
  }).detach();
  return worker;
}

// On CLOCK_MONOTONIC, 0.9 of a cycle after its multiples: deadlines at 1, 2 and 4 kHz lie 50, 150
// and 75 us into a cycle (firmware/loop/grid.h), 75 us and more from this timer, those of a faster
// loop 0.3 of a cycle, while the library is fast enough for it.
void SdkWorker::run() {
  std::int64_t due_ns = monotonic_ns() / cycle_ns_ * cycle_ns_ + cycle_ns_ * 9 / 10;
  while (!quit_.load(std::memory_order_relaxed) && cycle()) {
    due_ns = std::max(due_ns + cycle_ns_, monotonic_ns() + kMinPause_ns);
    sleep_until_ns(due_ns);
  }
  send({});
  session_.sdk.enable_force(0, session_.id);
}

/// One pose, one force. False after a trouble.
bool SdkWorker::cycle() {
  if (trouble_.load(std::memory_order_acquire) != 0) return false;
  const std::int64_t now_ns = monotonic_ns();
  if (!read_pose(now_ns)) return false;
  // Nothing new keeps the last one; its age then tells that the loop is late.
  commands_.read(command_);
  const std::int64_t age_ns = now_ns - command_.stamp_ns;
  if (!follow_power(command_.powered && age_ns <= kLoopGone_ns)) return false;
  const bool follow = power_ == Power::kOn && age_ns <= command_life_ns_;
  return send(follow ? command_.wrench : Wrench{}) || fail(SdkTroubleSource::kForce);
}

bool SdkWorker::read_pose(std::int64_t now_ns) {
  SdkPose pose{.position_m = {}, .orientation = {}, .stamp_ns = now_ns};
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3& p_m = pose.position_m;
  const int answer = session_.sdk.pose(&p_m.x, &p_m.y, &p_m.z, rotation, session_.id);
  if (answer < 0) return fail(SdkTroubleSource::kPose);
  // No sample: the loop counts the gap by the stamp of the last one.
  if (answer == kTimeGuard) return true;
  pose.orientation = session_.type.wrist ? quat_from_rotation(rotation) : Quat{};
  pose.sequence = ++sequence_;
  pose.follows_commands = power_ == Power::kOn;
  poses_.write(pose);
  return true;
}

bool SdkWorker::follow_power(bool wanted) {
  // Zero force is shown for a while after the forces went on: no step into the hand.
  if (wanted == (power_ != Power::kOff)) {
    if (power_ == Power::kZeroFirst && ++zero_cycles_ * cycle_ns_ >= kZeroFirst_ns)
      power_ = Power::kOn;
    if (power_ == Power::kOn && !powered_for_sure())
      powered_cycles_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
  powered_cycles_.store(0, std::memory_order_relaxed);
  zero_cycles_ = 0;
  power_ = wanted ? Power::kZeroFirst : Power::kOff;
  return session_.sdk.enable_force(wanted ? 1 : 0, session_.id) >= 0 ||
         fail(SdkTroubleSource::kEnable);
}

bool SdkWorker::powered_for_sure() const {
  return powered_cycles_.load(std::memory_order_relaxed) * cycle_ns_ >= kPoweredForSure_ns;
}

bool SdkWorker::send(const Wrench& w) {
  const auto& [f, t] = w;
  return session_.sdk.set_force(f.x, f.y, f.z, t.x, t.y, t.z, 0.0, session_.id) >= 0;
}

void SdkWorker::watch() {
  while (!quit_.load(std::memory_order_relaxed) && trouble_.load(std::memory_order_relaxed) == 0) {
    check_status();
    std::this_thread::sleep_for(kStatusPeriod);
  }
}

void SdkWorker::check_status() {
  // Before and after the call: it may take long, and "off" is news only if they were on throughout.
  const bool on_before = powered_for_sure();
  SdkStatusWords status{};
  if (session_.sdk.status(status.data(), session_.id) < 0) {
    fail(SdkTroubleSource::kWatch);
    return;
  }
  const bool on_after = powered_for_sure();
  const auto found = [&](Fault fault, SdkTroubleSource source, int code) {
    keep({fault, source, static_cast<std::uint8_t>(std::clamp(code, 0, 255))});
  };
  // From cause to consequence: an unplugged device has no power either.
  if (status[kSdkConnected] == 0)
    found(Fault::kDeviceUnplugged, SdkTroubleSource::kStatus, kSdkConnected);
  else if (status[kSdkPower] == 0)
    found(Fault::kDeviceFailed, SdkTroubleSource::kStatus, kSdkPower);
  else if (status[kSdkError] != 0)
    found(Fault::kDeviceFailed, SdkTroubleSource::kStatus, kSdkError);
  else if (status[kSdkReset] != 0)
    found(Fault::kHomingLost, SdkTroubleSource::kStatus, kSdkReset);
  else if (on_before && on_after && status[kSdkForce] == 0)
    found(Fault::kForceOff, SdkTroubleSource::kForceOff, status[kSdkForceOffCause]);
}

/// Keeps what the library says of this thread's last error. False, for the caller to pass on.
bool SdkWorker::fail(SdkTroubleSource source) {
  const int code = session_.sdk.error_get_last();
  keep({fault_of_sdk_error(code), source, static_cast<std::uint8_t>(std::clamp(code, 0, 255))});
  return false;
}

void SdkWorker::keep(const SdkTrouble& t) {
  std::uint32_t none = 0;  // the first one is the cause
  // One word, so that the first trouble is kept whole by one exchange.
  const auto packed = static_cast<std::uint32_t>(t.fault) << 16 |
                      static_cast<std::uint32_t>(t.source) << 8 | std::uint32_t{t.code};
  trouble_.compare_exchange_strong(none, packed, std::memory_order_acq_rel);
}

SdkTrouble SdkWorker::trouble() const RT_SAFE {
  const std::uint32_t packed = trouble_.load(std::memory_order_acquire);
  return {static_cast<Fault>(packed >> 16), static_cast<SdkTroubleSource>(packed >> 8 & 0xFF),
          static_cast<std::uint8_t>(packed & 0xFF)};
}

bool SdkWorker::stop() {
  quit_ = true;
  // 2 s, no join: a library that hangs must not keep tactd from ending.
  for (int i = 0; i < 2000 && running_ > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (running_ > 0) return false;
  close_sdk_session(session_);
  return true;
}

}  // namespace tact::hal::force_dimension
