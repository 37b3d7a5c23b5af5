// SPDX-License-Identifier: Apache-2.0
// device_settings.h - what a scene says about the device, whichever it is.
//
// What one device alone has stands in its folder, as a struct of plain numbers and names with its
// keys (hal/device_facts.h); it is kept here by its type. Set-up code only.
#pragma once

#include <any>
#include <map>
#include <string>
#include <typeindex>

#include "model/types.h"

namespace tact::model {

/// One value of each type that was asked for; of any other, its defaults.
class SettingsByType {
 public:
  template <typename T>
  T& of() {
    std::any& own = own_[typeid(T)];
    if (!own.has_value()) own = T{};
    return *std::any_cast<T>(&own);
  }
  template <typename T>
  const T& of() const {
    static const T kDefaults{};
    const auto own = own_.find(typeid(T));
    return own == own_.end() ? kDefaults : *std::any_cast<T>(&own->second);
  }

 private:
  std::map<std::type_index, std::any> own_;
};

struct DeviceSettings : SettingsByType {
  std::string kind;             // "sim-delta", or another that hal/registry knows
  Vec3 base_orientation_deg{};  // turn of its base, axis times angle; 0: as hal/ draws it
  Vec3 base_position_m{};       // of its base, W
  double motion_scale = 1.0;    // way of the tool for a way of the handle
  bool trust_library = false;  // the vendor's may be anybody's file; a person says so, no scene can
};

}  // namespace tact::model
