// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "hal/monotonic.h"
#include "hal/threads/thread.h"
#include "hal/vendor_sdk/rotation.h"
#include "model/time_ns.h"

namespace tact::hal::force_dimension {
namespace {

using model::Fault;
using model::Quat;
using model::Vec3;
using vendor_sdk::LibraryForce;
using vendor_sdk::LibraryPose;

// 4 kHz, the rate that the vendor claims: the pose is young, and the watchdog fed, at any
// rate of the loop.
constexpr std::int64_t kLongestCycle_ns = 250'000;
constexpr std::int64_t kMinPause_ns = 50'000;  // a slow library must not starve the PC
constexpr int kTimeGuard = 1;                  // pose: nothing new
constexpr unsigned kSdkUserButton = 1;         // of dhdGetButtonMask: the first button
constexpr auto kStatusPeriod = std::chrono::milliseconds(50);

void sleep_until_ns(std::int64_t deadline_ns) {
  const timespec t{.tv_sec = deadline_ns / model::kSecond_ns,
                   .tv_nsec = deadline_ns % model::kSecond_ns};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace

std::string text_of_sdk_cause(const FaultCause& t) {
  constexpr std::array kDoesNot{"",
                                "report its pose",
                                "report its gripper",
                                "take a force",
                                "switch its forces",
                                "report its status"};
  static_assert(kDoesNot.size() == static_cast<std::size_t>(SdkCause::kWatch) + 1);
  const auto source = static_cast<SdkCause>(t.kind);
  const int code = static_cast<int>(t.code);
  if (source == SdkCause::kNone) return {};
  if (source == SdkCause::kForceOff)
    return fmt::format("the device switched its forces off: {}", force_off_text(code));
  if (source != SdkCause::kStatus)
    return fmt::format("the device does not {}: {}", kDoesNot.at(t.kind), text_of_sdk_error(code));
  if (t.fault == Fault::kHomingLost)
    return "the device has lost its calibration; calibrate it, then start tactd again";
  if (t.fault == Fault::kDeviceUnplugged)
    return "the device is no longer connected; plug it in, then start tactd again";
  return code == kSdkPower
             ? "the device has no power; switch its supply on, then start tactd again"
             : "the device reports an error of its own; switch it off and on, then start tactd "
               "again";
}

std::int64_t sdk_cycle_ns(double rate_Hz) {
  return std::min(kLongestCycle_ns, model::period_ns(rate_Hz));
}

model::Result<std::shared_ptr<SdkWorker>> SdkWorker::start(const SdkSession& session,
                                                           double rate_Hz) {
  std::shared_ptr<SdkWorker> worker(new SdkWorker(session, rate_Hz));
  worker->expect_threads(2);
  struct Part {
    const char* name;
    void (SdkWorker::*body)();
  };
  int missing = 2;
  for (const Part part :
       {Part{"tact-fd", &SdkWorker::run}, Part{"tact-fd-status", &SdkWorker::watch}}) {
    // Each thread keeps the worker alive: one that hangs in the library outlives its device.
    auto thread = threads::start_thread(part.name, [worker, part] {
      (worker.get()->*part.body)();
      worker->thread_ends();
    });
    if (!thread) {
      for (; missing > 0; --missing) worker->thread_ends();
      static_cast<void>(worker->stop());
      return thread.error();
    }
    thread->detach();
    --missing;
  }
  return worker;
}

// On CLOCK_MONOTONIC, 0.9 of a cycle after its multiples: deadlines at 1, 2 and 4 kHz lie 50, 150
// and 75 us into a cycle (firmware/loop/release_schedule.h), 75 us and more from this timer, those
// of a faster loop 0.3 of a cycle, while the library is fast enough for it.
void SdkWorker::run() {
  enter_fifo("tact-fd");
  std::int64_t due_ns = monotonic_ns() / cycle_ns() * cycle_ns() + cycle_ns() * 9 / 10;
  while (!quits() && cycle()) {
    due_ns = std::max(due_ns + cycle_ns(), monotonic_ns() + kMinPause_ns);
    sleep_until_ns(due_ns);
  }
  send({});
  session_.sdk.enable_force(0, session_.id);
  cycles_ended();
}

/// One pose, one force. False after a fault.
bool SdkWorker::cycle() {
  if (first_cause().fault != Fault::kNone) return false;
  if (!read_pose(monotonic_ns())) return false;
  // The time once more: the library may have waited for the pose, and the command has aged.
  const auto force = next_force(monotonic_ns());
  if (!force) return false;
  if (!send(*force)) return fail(SdkCause::kForce);
  cycle_ended(monotonic_ns());
  return true;
}

bool SdkWorker::read_pose(std::int64_t now_ns) {
  LibraryPose pose{.position_m = {}, .orientation = {}, .stamp_ns = now_ns};
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3& p_m = pose.position_m;
  const int answer = session_.sdk.pose(&p_m.x, &p_m.y, &p_m.z, rotation, session_.id);
  if (answer < 0) return fail(SdkCause::kPose);
  // No sample: the loop counts the gap by the stamp of the last one.
  if (answer == kTimeGuard) return true;
  pose.orientation = session_.type.wrist ? vendor_sdk::quat_from_rotation(rotation) : Quat{};
  if (!read_grip(pose)) return false;
  publish(pose);
  return true;
}

/// The angle's sign is that of the hand for which the gripper is built.
bool SdkWorker::read_grip(LibraryPose& pose) {
  if (grip_ == GripKind::kNone) return true;
  if (grip_ == GripKind::kButton) {
    pose.grip_ratio = (session_.sdk.button_mask(session_.id) & kSdkUserButton) != 0 ? 1.0 : 0.0;
    return true;
  }
  double angle_rad = 0.0;
  if (session_.sdk.gripper_angle(&angle_rad, session_.id) < 0) return fail(SdkCause::kGrip);
  // Not std::clamp: an angle that is no number stays one, and the loop reports it.
  const double open = std::abs(angle_rad) / session_.gripper_open_rad;
  pose.grip_ratio = open < 1.0 ? 1.0 - open : 0.0 * open;
  if (grip_ == GripKind::kForce && session_.sdk.gripper_gap(&pose.grip_gap_m, session_.id) < 0)
    return fail(SdkCause::kGrip);
  return true;
}

bool SdkWorker::switch_forces(bool on) {
  // Zero first: what the device would hold when it next switches on.
  if (!send({})) return fail(SdkCause::kForce);
  return session_.sdk.enable_force(on ? 1 : 0, session_.id) >= 0 || fail(SdkCause::kEnable);
}

bool SdkWorker::send(const LibraryForce& force) {
  const auto& [f, t] = force.wrench;
  const double grip_N = session_.type.left ? -force.grip_N : force.grip_N;
  return session_.sdk.set_force(f.x, f.y, f.z, t.x, t.y, t.z, grip_N, session_.id) >= 0;
}

void SdkWorker::watch() {
  while (!quits() && first_cause().fault == Fault::kNone) {
    check_status();
    std::this_thread::sleep_for(kStatusPeriod);
  }
}

void SdkWorker::check_status() {
  // Before and after the call: it may take long, and "off" is news only if they were on throughout.
  const bool on_before = powered_for_sure();
  SdkStatusText status{};
  if (session_.sdk.status(status.data(), session_.id) < 0) {
    fail(SdkCause::kWatch);
    return;
  }
  const bool on_after = powered_for_sure();
  // From cause to consequence: an unplugged device has no power either.
  if (status[kSdkConnected] == 0)
    keep_cause(Fault::kDeviceUnplugged, SdkCause::kStatus, kSdkConnected);
  else if (status[kSdkPower] == 0)
    keep_cause(Fault::kDeviceFailed, SdkCause::kStatus, kSdkPower);
  else if (status[kSdkError] != 0)
    keep_cause(Fault::kDeviceFailed, SdkCause::kStatus, kSdkError);
  else if (status[kSdkReset] != 0)
    keep_cause(Fault::kHomingLost, SdkCause::kStatus, kSdkReset);
  else if (on_before && on_after && status[kSdkForce] == 0)
    keep_cause(Fault::kForceOff, SdkCause::kForceOff, status[kSdkForceOffCause]);
}

/// Keeps what the library says of this thread's last error. False, for the caller to pass on.
bool SdkWorker::fail(SdkCause source) {
  const int code = session_.sdk.error_get_last();
  keep_cause(fault_of_sdk_error(code), source, code);
  return false;
}

void SdkWorker::keep_cause(Fault fault, SdkCause source, int code) {
  keep({.fault = fault,
        .kind = static_cast<std::uint8_t>(source),
        .code = static_cast<std::uint32_t>(code)});
}

}  // namespace tact::hal::force_dimension
