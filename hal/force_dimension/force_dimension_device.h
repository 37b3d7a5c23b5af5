// SPDX-License-Identifier: Apache-2.0
// force_dimension_device.h - a delta.3, omega, sigma or lambda, driven through its vendor SDK.
//
// The loop's side is vendor_sdk/library_device.h, the library's side sdk_worker.h. The vendor's
// frame is W: x towards the operator, y to the right, z up. The library balances the device's
// weight.
#pragma once

#include <memory>

#include "hal/device.h"
#include "model/device_settings.h"
#include "model/result.h"

namespace tact::hal::force_dimension {

/// Loads the library, opens and checks the device, starts its threads; about half a second. No
/// force before the loop permits power.
model::Result<std::unique_ptr<Device>> open_force_dimension(const model::DeviceSettings& settings,
                                                            double rate_Hz);

}  // namespace tact::hal::force_dimension
