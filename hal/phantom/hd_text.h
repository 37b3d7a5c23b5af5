// SPDX-License-Identifier: Apache-2.0
// hd_text.h - what the error codes of the library mean, for a person. Source: HD-1.
#pragma once

#include <string>

#include "model/fault.h"

namespace tact::hal::phantom {

/// What happened and the remedy; never blank.
std::string text_of_hd_error(unsigned code);
/// kDeviceUnplugged when nobody answers, kForceOff when the forces were too much for the device,
/// else kDeviceFailed.
model::Fault fault_of_hd_error(unsigned code);

}  // namespace tact::hal::phantom
