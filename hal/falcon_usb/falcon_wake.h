// SPDX-License-Identifier: Apache-2.0
// falcon_wake.h - falcon_boot's decisions carried out over libusb, and the firmware file read.
// Set-up code only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon_usb/falcon_usb.h"
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

}  // namespace tact::hal::falcon_usb
