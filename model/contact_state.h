// SPDX-License-Identifier: Apache-2.0
// contact_state.h - states of one sphere of the tool; transitions: contact/detect.h.
#pragma once

#include <array>
#include <cstdint>

namespace tact::model {

/// kInside: found inside the organ, without contact and force until it has once been outside.
enum class ContactState : std::uint8_t { kFree = 0, kInContact = 1, kHeld = 2, kInside = 3 };

/// As telemetry, logs and page print it.
inline const char* name_of(ContactState state) {
  static constexpr std::array kNames{"free", "contact", "held", "inside"};
  const auto number = static_cast<std::size_t>(state);
  return number < kNames.size() ? kNames[number] : "unknown";
}

}  // namespace tact::model
