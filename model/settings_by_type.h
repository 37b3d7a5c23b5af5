// SPDX-License-Identifier: Apache-2.0
// settings_by_type.h - keeps settings by their type, so that a scene includes no law and no device.
// Set-up code only.
#pragma once

#include <any>
#include <map>
#include <typeindex>

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
    static const T defaults{};
    const auto own = own_.find(typeid(T));
    return own == own_.end() ? defaults : *std::any_cast<T>(&own->second);
  }

 private:
  std::map<std::type_index, std::any> own_;
};

}  // namespace tact::model
