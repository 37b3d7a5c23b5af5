// SPDX-License-Identifier: Apache-2.0
// falcon_open.h - from the scene's settings to a Falcon that runs: find, wake, take. The firmware
// file is read, and falcon_boot's decisions are carried out over libusb. Set-up code only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon/falcon_device.h"
#include "hal/falcon_usb/falcon_usb.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::falcon_usb {

/// The file's bytes if they may be sent; an empty path gives none.
model::Result<std::vector<std::uint8_t>> load_falcon_image(const std::string& path,
                                                           std::string_view wanted_sha256);

/// Wakes it until it answers at full speed, and sets its USB chip up; at most 20 s. `usb` may be
/// opened again on the way.
model::Result<falcon::FalconBoot> boot_falcon(std::unique_ptr<FalconUsb>& usb,
                                              std::span<const std::uint8_t> image,
                                              bool event_character);

/// Finds, wakes and takes the Falcon that the scene means; up to 20 s.
model::Result<std::unique_ptr<Device>> open_falcon(const model::DeviceSettings& settings,
                                                   double rate_Hz);
/// The same, for a program that calibrates it.
model::Result<std::unique_ptr<falcon::FalconDevice>> open_falcon_device(
    const falcon::FalconSettings& settings);

}  // namespace tact::hal::falcon_usb
