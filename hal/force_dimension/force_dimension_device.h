// SPDX-License-Identifier: Apache-2.0
// force_dimension_device.h - a delta.3, omega, sigma or lambda, driven through its vendor SDK.
//
// The loop's side is vendor_sdk/library_device.h, the library's side sdk_worker.h. The vendor's
// frame is W: x towards the operator, y to the right, z up. The library balances the device's
// weight.
#pragma once

#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/device_facts.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::force_dimension {

inline constexpr UsbPart kForceDimensionParts[] = {
    {.kind = "force-dimension",
     .vendor = "1451",
     .name = "Force Dimension device",
     .rule = R"(SUBSYSTEM=="usb", ATTR{idVendor}=="1451", GROUP="haptics", MODE="0660")",
     .absence =
         "no Force Dimension device (USB 1451:*); switch its supply on and plug in its cable "
         "(lsusb shows it)"}};

struct ForceDimensionSettings {
  static constexpr Section kSection{"force_dimension",
                                    "a Force Dimension device, by its vendor's SDK"};

  std::string library = "libdhd.so.3";  // name or path; the vendor's, never part of tact
  int id = -1;                          // -1: the only device
  double watchdog_s = 0.004;            // the device lets go by itself
  double effector_mass_kg = 0.0;        // 0: the vendor's value
  double damping_Ns_per_m = 1.0;        // what the device itself has, at the handle
  double gripper_open_rad = 0.0;        // its gripper, fully open; 0: the vendor's value

  void visit(model::ParameterVisitor& k) {
    constexpr auto kOptional = model::Need::kOptional;
    k.text("library", "the vendor's, by name or path", library, kOptional);
    k.whole("id", {-1.0, 15.0}, "of the device, -1: the only one", id);
    // FD-3: the device counts 255 units of 125 us at most.
    k.number("watchdog_s", {0.001, 0.0318}, "without a force for so long the device lets go",
             watchdog_s, kOptional);
    k.number("effector_mass_kg", {0.0, 5.0}, "0: the vendor's value", effector_mass_kg, kOptional);
    k.number("damping_Ns_per_m", {0.0, 50.0}, "that the device has at the handle", damping_Ns_per_m,
             kOptional);
    k.number("gripper_open_rad", {0.0, 1.6}, "of its gripper, fully open; 0: the vendor's value",
             gripper_open_rad, kOptional);
  }
};

/// Loads the library, opens and checks the device, starts its threads; about half a second. No
/// force before the loop permits power.
model::Result<std::unique_ptr<Device>> open_force_dimension(const model::DeviceSettings& settings,
                                                            double rate_Hz);

}  // namespace tact::hal::force_dimension
