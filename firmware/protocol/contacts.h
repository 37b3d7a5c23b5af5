// SPDX-License-Identifier: Apache-2.0
// contacts.h - contacts of the tool's spheres in a record: their states, and the table of fields for
// the spheres that the tool has.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/protocol/record_fields.h"

namespace tact::firmware::protocol {

inline constexpr std::size_t kMaxContacts = 16;  // probe spheres on the tool

// kInside: the sphere is inside the organ and gives no force until it has once been outside.
enum class ContactState : std::uint8_t { kFree = 0, kTouching = 1, kHeld = 2, kInside = 3 };

inline const char* contact_state_name(std::uint64_t number) {
  static constexpr std::array kNames{"free", "contact", "held", "inside"};
  return number < kNames.size() ? kNames[number] : "unknown";
}

/// `table` with so many elements in its field "contact".
template <const auto& table>
FieldTable with_contacts(std::size_t spheres) {
  static const auto of_count = [] {
    std::vector out(kMaxContacts, table);
    for (std::size_t i = 0; i < kMaxContacts; ++i)
      std::ranges::find(out[i], std::string_view("contact"), &Field::name)->shape[0] = i + 1;
    return out;
  }();
  return of_count[std::clamp<std::size_t>(spheres, 1, kMaxContacts) - 1];
}

}  // namespace tact::firmware::protocol
