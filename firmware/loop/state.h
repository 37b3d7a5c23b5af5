// SPDX-License-Identifier: Apache-2.0
// state.h - the states of supervisor.h. Viewers show the names and texts of this table: the page
// gets them from tactd --faults --json.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact::firmware::loop {

enum class State : std::uint8_t { kOff = 0, kReady = 1, kArmed = 2, kStopped = 3 };

struct StateEntry {
  const char* name;   // for a status line or a table
  const char* words;  // effect on the force
};

/// Indexed by State.
inline constexpr std::array<StateEntry, 4> kStateTable{
    {{"off", "no force"},
     {"ready", "no tissue force until armed"},
     {"armed", "force is on"},
     {"stopped", "force is off until a person acts"}}};

/// "unknown" for a number from outside that is not a State.
constexpr const char* name_of(State state) {
  const auto number = static_cast<std::size_t>(state);
  return number < kStateTable.size() ? kStateTable[number].name : "unknown";
}

}  // namespace tact::firmware::loop
