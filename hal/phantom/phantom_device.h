// SPDX-License-Identifier: Apache-2.0
// phantom_device.h - a PHANTOM or 3D Systems Touch, driven through its vendor SDK.
//
// The loop's side is vendor_sdk/library_device.h, the library's side phantom_worker.h.
#pragma once

#include <memory>
#include <string>

#include "hal/device.h"
#include "hal/device_facts.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::phantom {

/// The rules are of the serial port or the HID node too, as the vendor SDK opens that. An older
/// Touch has vendor and product exchanged (HD-6).
inline constexpr UsbPart kPhantomParts[] = {
    {.kind = "phantom",
     .vendor = "2988",
     .name = "PHANTOM",
     .rule = R"(SUBSYSTEMS=="usb", ATTRS{idVendor}=="2988", GROUP="haptics", MODE="0660")",
     .absence = "no PHANTOM or Touch on USB (2988:*); switch its supply on and plug in its cable "
                "(lsusb shows it); one on Ethernet or FireWire is not looked for"},
    {.kind = "phantom",
     .vendor = "0301",
     .product = "2988",
     .name = "PHANTOM",
     .rule =
         R"(SUBSYSTEMS=="usb", ATTRS{idVendor}=="0301", ATTRS{idProduct}=="2988", GROUP="haptics", MODE="0660")"}};

struct PhantomSettings {
  static constexpr Section kSection{"phantom",
                                    "a PHANTOM or 3D Systems Touch, by its vendor's SDK"};

  std::string library = "libHD.so";  // name or path; the vendor's, never part of tact
  std::string name;                 // that the vendor's Touch_Setup gave; empty: the default device
  double damping_Ns_per_m = 1.0;    // what the device itself has, at the stylus
  double position_step_m = 5.5e-5;  // of its encoders, at the stylus

  void visit(model::ParameterVisitor& k) {
    constexpr auto kOptional = model::Need::kOptional;
    k.text("library", "the vendor's, by name or path", library, kOptional);
    k.text("name", "that the vendor's Touch_Setup gave it; empty: the default device", name,
           kOptional);
    k.number("damping_Ns_per_m", {0.0, 50.0}, "that the device has at the stylus", damping_Ns_per_m,
             kOptional);
    k.number("position_step_m", {1e-6, 1e-3}, "of its encoders, at the stylus", position_step_m,
             kOptional);
  }
};

/// Loads the library, opens and checks the device, starts the library's scheduler, and waits up to
/// a second until the device is calibrated. No force before the loop permits power.
model::Result<std::unique_ptr<Device>> open_phantom(const model::DeviceSettings& settings,
                                                    double rate_Hz);

}  // namespace tact::hal::phantom
