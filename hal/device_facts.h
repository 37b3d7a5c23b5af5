// SPDX-License-Identifier: Apache-2.0
// device_facts.h - what a device states in its own folder: its section of a scene, its numbers on
// USB and its udev rule. hal/registry has a row for it.
//
// Settings are a struct of plain numbers and names with a constant kSection and a template
//     template <class Keys> void visit(Keys& k)
// that states every key once: name with its unit, range, meaning, variable. The scene's reader
// (model/reader), its reference page and RangeCheck visit it. What only the owner of a device can
// know has no default: a scene must name it. Other defaults are those of the vendors' manuals.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace tact::hal {

/// [device.KEY]
struct Section {
  const char* key;
  const char* meaning;
  bool required = false;  // of a scene that chooses this device
};

/// By what it is known when it is plugged in, and who may open it.
struct UsbPart {
  const char* kind;               // device.kind of a scene
  const char* vendor;             // idVendor
  const char* product = nullptr;  // null: any
  const char* name;
  const char* path_key = nullptr;  // names it by its port; null: its vendor's SDK finds it
  const char* rule;                // of tools/deploy/60-tact.rules, word for word; man 7 udev
  const char* absence = nullptr;   // where it was looked for and how it shows up; once a kind
};

/// Visits settings that may come from no file: are their numbers in range?
class RangeCheck {
 public:
  struct Range {
    double low, high;
  };
  void number(std::string_view key, Range range, std::string_view, double value) {
    if (!(value >= range.low && value <= range.high) && refusal_.empty())
      refusal_ = fmt::format("{} is {}; allowed: {} .. {}", key, value, range.low, range.high);
  }
  /// Of the first that is not; empty when all are.
  const std::string& refusal() const { return refusal_; }

 private:
  std::string refusal_;
};

}  // namespace tact::hal
