// SPDX-License-Identifier: Apache-2.0
// record_parts.h - what several records have: contacts of spheres, UTC, names of numbers.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "firmware/loop/state.h"
#include "firmware/protocol/record_fields.h"
#include "model/contact_state.h"
#include "model/fault.h"

namespace tact::firmware::protocol {

inline constexpr std::size_t kMaxContacts = 16;  // probe spheres on the tool

using model::ContactState;

/// Meanings of the fields that frame and tick log share.
namespace meaning {
inline constexpr const char* kContactPoint = "contact point on the undeformed surface";
inline constexpr const char* kDepth = "press positive, pull negative";
inline constexpr const char* kContactState = "inside: no force until it has once been outside";
inline constexpr const char* kDue = "the deadline that woke it, CLOCK_MONOTONIC";
inline constexpr const char* kUtcOffset = "UTC since 1970 is due_ns plus this";
inline constexpr const char* kUtcMaxError = "at most; 16 s: no time service";
inline constexpr const char* kUtcError = "as the time service estimates";
inline constexpr const char* kOrientation = "unit quaternion, tool frame to W";
inline constexpr const char* kGrip = "0 open, 1 closed";
inline constexpr const char* kWritten = "written to the device";
inline constexpr const char* kWanted = "of the law, before the gate";
inline constexpr const char* kWrittenRms = "written, over limits.thermal_time_s";
inline constexpr const char* kWrittenGrip = "written to the fingers, opening positive";
inline constexpr const char* kFault = "latched; number of tactd --faults, 0 none";
inline constexpr const char* kNonRt = "the PC has no hard real time, the force is capped";
inline constexpr const char* kContactLosses =
    "count since start: contact was lost as the tool moved too far between samples";
inline constexpr const char* kTemperature = "of the hottest drive; NaN: no drive reports one";
}  // namespace meaning

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
  return number > 0xFF ? "unknown" : name_of(static_cast<ContactState>(number));
}
inline const char* state_name(std::uint64_t number) {
  return number < loop::kStateTable.size() ? loop::name_of(static_cast<loop::State>(number))
                                           : "unknown";
}
inline const char* fault_name(std::uint64_t number) {
  return model::describe(static_cast<model::Fault>(number)).name;
}

}  // namespace tact::firmware::protocol
