// SPDX-License-Identifier: Apache-2.0
// record_parts.h - what several records have: contacts of spheres, UTC, names of numbers.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "firmware/loop/state.h"
#include "firmware/protocol/record_fields.h"
#include "model/fault.h"

namespace tact::firmware::protocol {

inline constexpr std::size_t kMaxContacts = 16;  // probe spheres on the tool

// kInside: the sphere is inside the organ and gives no force until it has once been outside.
enum class ContactState : std::uint8_t { kFree = 0, kInContact = 1, kHeld = 2, kInside = 3 };

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

/// As the kernel has it: no time service keeps the clock.
inline constexpr std::uint32_t kMaxUtcError_us = 16'000'000;

/// UTC by CLOCK_MONOTONIC (telemetry/utc_clock.h reads it).
struct UtcOffset {
  std::int64_t offset_ns = 0;  // since 1970; UTC is CLOCK_MONOTONIC plus this
  // As chrony, ntpd or phc2sys set in the kernel (adjtimex), with the time that the reading took
  std::uint32_t max_error_us = kMaxUtcError_us, error_us = kMaxUtcError_us;
};

inline const char* contact_state_name(std::uint64_t number) {
  static constexpr std::array kNames{"free", "contact", "held", "inside"};
  return number < kNames.size() ? kNames[number] : "unknown";
}
inline const char* state_name(std::uint64_t number) {
  return number < loop::kStateTable.size() ? loop::name_of(static_cast<loop::State>(number))
                                           : "unknown";
}
inline const char* fault_name(std::uint64_t number) {
  return model::describe(static_cast<model::Fault>(number)).name;
}

}  // namespace tact::firmware::protocol
