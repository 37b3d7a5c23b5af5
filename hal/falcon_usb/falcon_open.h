// SPDX-License-Identifier: Apache-2.0
// falcon_open.h - from the scene's settings to a Falcon that runs: find, wake, take.
#pragma once

#include <memory>

#include "hal/falcon/falcon_device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::falcon_usb {

/// Finds, wakes and takes the Falcon that the scene means; up to 20 s.
model::Result<std::unique_ptr<Device>> open_falcon(const model::DeviceSettings& settings,
                                                   double rate_Hz);
/// The same, for a program that calibrates it.
model::Result<std::unique_ptr<falcon::FalconDevice>> open_falcon_device(
    const model::FalconSettings& settings);

}  // namespace tact::hal::falcon_usb
