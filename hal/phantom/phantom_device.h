// SPDX-License-Identifier: Apache-2.0
// phantom_device.h - a PHANTOM or 3D Systems Touch, driven through its vendor SDK.
//
// The loop's side is vendor_sdk/library_device.h, the library's side phantom_worker.h.
#pragma once

#include <memory>

#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::phantom {

/// Loads the library, opens and checks the device, starts the library's scheduler, and waits up to
/// a second until the device is calibrated. No force before the loop permits power.
model::Result<std::unique_ptr<Device>> open_phantom(const model::DeviceSettings& settings,
                                                    double rate_Hz);

}  // namespace tact::hal::phantom
