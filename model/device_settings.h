// SPDX-License-Identifier: Apache-2.0
// device_settings.h - what a scene says about a device of any kind.
//
// What one device alone has is in its folder, as a struct of plain numbers and names with its
// keys (hal/device_facts.h); it is kept here by its type. Set-up code only.
#pragma once

#include <string>

#include "model/settings_by_type.h"
#include "model/types.h"

namespace tact::model {

struct DeviceSettings : SettingsByType {
  std::string kind;             // "sim-delta", or another that hal/registry knows
  Vec3 base_orientation_deg{};  // turn of its base, axis times angle; 0: as hal/ draws it
  Vec3 base_position_m{};       // of its base, W
  double motion_scale = 1.0;    // way of the tool for a way of the handle
  bool trust_library = false;  // the vendor's may be anybody's file; a person says so, no scene can
};

}  // namespace tact::model
