// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/device_types.h"

#include <fmt/format.h>

#include <array>

namespace tact::hal::force_dimension {
namespace {

using model::Error;

// Force, torque and radius: FD-1; the lengths and 1e-5 m are the data sheets'.
constexpr GripKind kButton = GripKind::kButton, kGripper = GripKind::kForce;
constexpr ForceDimensionType omega(int code, const char* name, bool wrist, GripKind grip,
                                   bool left = false) {
  return {code, name, 12.0, 0.0, 0.075, 0.055, 1e-5, wrist, grip, left};
}
constexpr ForceDimensionType sigma(int code, const char* name, double torque_Nm, bool wrist,
                                   GripKind grip, bool left = false) {
  return {code, name, 12.0, torque_Nm, 0.095, 0.065, 1e-5, wrist, grip, left};
}
constexpr ForceDimensionType lambda(int code, const char* name, double torque_Nm, bool wrist,
                                    GripKind grip, bool left = false) {
  return {code, name, 12.0, torque_Nm, 0.1125, 0.085, 1e-5, wrist, grip, left};
}

// As published: 360 x 300 mm, 20 N, 0.2 N m, a wrist of +-20 degrees. Older SDKs drove these;
// current ones list them as no longer supported (FD-1). The library decides.
constexpr ForceDimensionType old_delta_6(int code, const char* name) {
  return {code, name, 20.0, 0.2, 0.18, 0.15, 3e-5, true, kButton, false, true};
}

// Code, name, N, N m, radius m, half length m, resolution m, wrist, grip.
constexpr std::array kTypes{
    ForceDimensionType{63, "delta.3", 20.0, 0.0, 0.15, 0.13, 2e-5, false, kButton},
    old_delta_6(61, "6-DOF"),
    old_delta_6(62, "6-DOF 500"),
    old_delta_6(64, "delta.6"),
    ForceDimensionType{31, "3-DOF", 20.0, 0.0, 0.15, 0.13, 3e-5, false, kButton, false, true},
    ForceDimensionType{32, "OMEGA", 12.0, 0.0, 0.075, 0.055, 1e-5, false, kButton, false, true},
    omega(33, "omega.3", false, kButton),
    omega(34, "omega.6 right", true, kButton),
    omega(36, "omega.6 left", true, kButton),
    omega(35, "omega.7 right", true, kGripper),
    omega(37, "omega.7 left", true, kGripper, true),
    sigma(206, "sigma.3", 0.0, false, kButton),
    sigma(104, "sigma.7 right", 0.2, true, kGripper),
    sigma(105, "sigma.7 left", 0.2, true, kGripper, true),
    sigma(106, "sigma.6+ right", 0.2, true, kButton),
    sigma(107, "sigma.6+ left", 0.2, true, kButton),
    lambda(203, "lambda.3", 0.0, false, kButton),
    lambda(108, "lambda.7 right", 0.2, true, kGripper),
    lambda(109, "lambda.7 left", 0.2, true, kGripper, true),
};

struct Refused {
  int code;
  const char* name;
  const char* why;
};
constexpr const char* kController =
    "it is a bare controller, whose mechanism and limits tact cannot know; use a delta.3, omega, "
    "sigma or lambda";
constexpr const char* kNoLimits =
    "no limits of its force and torque are published that tact could hold it to; use a lambda.3 or "
    "lambda.7, or ask for it with the figures of its manual";
constexpr std::array kRefused{
    Refused{131, "lambda.6 right", kNoLimits},
    Refused{132, "lambda.6 left", kNoLimits},
    Refused{60, "Novint Falcon", "tact drives it by itself; set device.kind = \"falcon\""},
    Refused{81, "controller", kController},
    Refused{82, "controller HR", kController},
    Refused{91, "custom device", kController},
};

}  // namespace

model::Result<ForceDimensionType> force_dimension_type(int code) {
  for (const ForceDimensionType& type : kTypes)
    if (type.code == code) return type;
  // A name beside the number: the person sees that the device was recognized, and why not taken.
  for (const Refused& refused : kRefused)
    if (refused.code == code)
      return Error{
          fmt::format("the device is a {} (type {}): {}", refused.name, code, refused.why)};
  return Error{fmt::format(
      "Force Dimension's library calls the device type {}, which tact does not know: its limits "
      "are unknown; use a delta.3, omega, sigma or lambda",
      code)};
}

}  // namespace tact::hal::force_dimension
