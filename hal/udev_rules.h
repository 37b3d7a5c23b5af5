// SPDX-License-Identifier: Apache-2.0
// udev_rules.h - the rules of tools/deploy/60-tact.rules, word for word, for the messages that say
// why something may not be opened. Source: man 7 udev.
#pragma once

namespace tact::hal {

inline constexpr const char* kFalconRule =
    R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0403", ATTR{idProduct}=="cb48", GROUP="haptics", MODE="0660")";
inline constexpr const char* kForceDimensionRule =
    R"(SUBSYSTEM=="usb", ATTR{idVendor}=="1451", GROUP="haptics", MODE="0660")";
/// An older Touch, vendor and product exchanged (HD-6).
inline constexpr const char* kOldPhantomRule =
    R"(SUBSYSTEMS=="usb", ATTRS{idVendor}=="0301", ATTRS{idProduct}=="2988", GROUP="haptics", MODE="0660")";
/// Of the serial port or the HID node too, as the vendor SDK opens that.
inline constexpr const char* kPhantomRule =
    R"(SUBSYSTEMS=="usb", ATTRS{idVendor}=="2988", GROUP="haptics", MODE="0660")";
inline constexpr const char* kGpioRule =
    R"(SUBSYSTEM=="gpio", KERNEL=="gpiochip[0-9]*", GROUP="haptics", MODE="0660")";

/// The remedy of every missing permission, to follow the rule that is missing.
inline constexpr const char* kRuleRemedy =
    "sudo apt install ./tact_*.deb installs it; then sudo adduser $USER haptics, and log in again";

}  // namespace tact::hal
