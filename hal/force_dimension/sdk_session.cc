// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hal/device_lock.h"

namespace tact::hal::force_dimension {
namespace {

using model::Error;
using model::Result;

// Some hundred, so that the library uses all memory that a cycle needs; 0.1 s at its 4 kHz.
constexpr int kWarmUpCycles = 400;
constexpr double kWatchdogUnit_s = 125e-6;

Error failed(const SdkFunctions& sdk, const char* what) {
  return Error{fmt::format("the Force Dimension device refuses to {}: {}", what,
                           text_of_sdk_error(sdk.error_get_last()))};
}

Result<char> open_device(const SdkFunctions& sdk, int wanted,
                         const std::optional<Refusal>& refusal) {
  const int count = sdk.device_count();
  // Missing rights look to the library like no device.
  if (refusal && (count <= 0 || wanted >= count)) return refusal->error();
  if (count <= 0)
    return Error{
        "no Force Dimension device is found: switch its supply on, plug in its USB cable and end "
        "other programs that use it"};
  if (wanted < 0 && count > 1)
    return Error{fmt::format(
        "{} Force Dimension devices are here; say which one by device.force_dimension.id, 0 to {}",
        count, count - 1)};
  if (wanted >= count)
    return Error{fmt::format(
        "device.force_dimension.id is {}, but here {}; set it to -1", wanted,
        count == 1 ? "is only one device" : fmt::format("are only devices 0 to {}", count - 1))};
  const int id = sdk.open_id(static_cast<char>(std::max(wanted, 0)));
  if (id < 0) return failed(sdk, "open");
  return static_cast<char>(id);
}

/// What the device itself lacks, with the remedy.
std::optional<Error> find_shortfall(const SdkSession& s) {
  SdkStatusText status{};
  if (s.sdk.status(status.data(), s.id) < 0) return failed(s.sdk, "report its status");
  if (status[kSdkPower] == 0)
    return Error{fmt::format("the {} has no power; switch its supply on", s.type.name)};
  if (status[kSdkError] != 0)
    return Error{
        fmt::format("the {} reports an error of its own; switch it off and on, then calibrate it",
                    s.type.name)};
  // A wrist that is there and does not know its angles.
  const bool wrist_lost =
      s.type.wrist && status[kSdkWristDetected] != 0 && status[kSdkWristInit] == 0;
  if (status[kSdkReset] != 0 || wrist_lost) {
    // A delta is swept by hand; the others move by themselves, so the person starts that.
    const bool by_hand = s.type.code == 63 || s.type.old;
    return Error{fmt::format(
        "the {} is not calibrated; {}, then start tactd again", s.type.name,
        by_hand ? "sweep each axis by hand from stop to stop until its status light is steady"
                : "keep its workspace clear, run HapticInit of the vendor's SDK (the device moves "
                  "by itself)")};
  }
  return std::nullopt;
}

std::optional<Error> configure(const SdkSession& s, const ForceDimensionSettings& settings) {
  const auto watchdog = static_cast<unsigned char>(
      // In units of 125 us, one byte (FD-3); 0 would switch it off.
      std::clamp(std::round(settings.watchdog_s / kWatchdogUnit_s), 1.0, 255.0));
  // Forces off first: another program may have left them on.
  if (s.sdk.enable_force(0, s.id) < 0) return failed(s.sdk, "keep its forces off");
  if (s.sdk.enable_expert_mode() < 0) return failed(s.sdk, "enter expert mode");
  // Off: with it a call that comes too early waits, or gives no new pose.
  if (s.sdk.set_time_guard(0, s.id) < 0) return failed(s.sdk, "switch its time guard off");
  if (s.sdk.set_watchdog(watchdog, s.id) < 0) return failed(s.sdk, "start its watchdog");
  if (settings.effector_mass_kg > 0.0) {
    if (s.sdk.set_effector_mass == nullptr)
      return Error{
          "the library has no dhdSetEffectorMass; remove device.force_dimension.effector_mass_kg, "
          "or use a newer SDK"};
    if (s.sdk.set_effector_mass(settings.effector_mass_kg, s.id) < 0)
      return failed(s.sdk, "take device.force_dimension.effector_mass_kg");
  }
  // Along a wrong axis it would push the hand: better is a weight that is felt.
  if (s.sdk.set_gravity_compensation(s.balances_weight ? 1 : 0, s.id) < 0)
    return failed(s.sdk, "balance its own weight");
  return std::nullopt;
}

/// Read and zero force, as the loop will do, while the forces are off.
std::optional<Error> warm_up(const SdkSession& s) {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, rotation[3][3] = {};
  for (int i = 0; i < kWarmUpCycles; ++i) {
    if (s.sdk.pose(&x_m, &y_m, &z_m, rotation, s.id) < 0) return failed(s.sdk, "report its pose");
    if (s.sdk.set_force(0, 0, 0, 0, 0, 0, 0, s.id) < 0) return failed(s.sdk, "take a zero force");
  }
  return std::nullopt;
}

std::string name_of_lock(const SdkSession& s) {
  return s.serial_number != 0
             ? fmt::format("the Force Dimension device no. {}", s.serial_number)
             : fmt::format("the Force Dimension device {}", static_cast<int>(s.id));
}

}  // namespace

GripKind grip_of(const SdkSession& s) {
  if (s.type.grip == GripKind::kButton)
    return s.sdk.button_mask != nullptr ? GripKind::kButton : GripKind::kNone;
  if (s.sdk.gripper_angle == nullptr) return GripKind::kNone;
  // Without the gap the energy given to the fingers would be unknown.
  return s.sdk.gripper_gap != nullptr ? s.type.grip : GripKind::kAngle;
}

Result<SdkSession> open_sdk_session(const ForceDimensionSettings& settings, bool trust_library,
                                    const Mounting& mounting, const SystemRoots& roots) {
  const auto sdk = load_sdk(settings.library, trust_library);
  if (!sdk) return sdk.error();
  const auto refusal = refused_usb_device(kForceDimensionParts, roots);
  const auto id = open_device(*sdk, settings.id, refusal);
  if (!id) return id.error();
  SdkSession session{.sdk = *sdk, .id = *id, .type = {}};
  if (settings.gripper_open_rad > 0.0) session.gripper_open_rad = settings.gripper_open_rad;
  session.balances_weight =
      norm(mounting.gravity_in_base_mps2() - Mounting{}.gravity_in_base_mps2()) < 0.1;
  unsigned short number = 0;
  // By serial number where it is known: two programs may count devices differently.
  if (sdk->serial_number != nullptr && sdk->serial_number(&number, *id) >= 0)
    session.serial_number = number;
  if (auto error = lock_device(name_of_lock(session))) {
    sdk->close(*id);  // and nothing else: its forces are another program's
    return *error;
  }
  const auto type = force_dimension_type(sdk->system_type(*id));
  std::optional<Error> error;
  if (type) {
    session.type = *type;
    error = find_shortfall(session);
    if (!error) error = configure(session, settings);
    if (!error) error = warm_up(session);
  } else {
    error = type.error();
  }
  if (error) {
    close_sdk_session(session);
    return *error;
  }
  return session;
}

/// No answer is looked at: each step is tried, also if the one before failed.
void close_sdk_session(const SdkSession& s) {
  s.sdk.set_force(0, 0, 0, 0, 0, 0, 0, s.id);
  s.sdk.enable_force(0, s.id);
  s.sdk.stop(s.id);
  s.sdk.close(s.id);
}

}  // namespace tact::hal::force_dimension
