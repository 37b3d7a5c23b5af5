// SPDX-License-Identifier: Apache-2.0
// state.h - who may feel force just now: the states of supervisor.h, told to viewers as they are.
// Their names and words are these everywhere: tactd --faults --json hands them to the page.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact::firmware::loop {

enum class State : std::uint8_t { kOff = 0, kReady = 1, kArmed = 2, kStopped = 3 };

struct StateEntry {
  const char* name;   // short, for a status line or a table
  const char* words;  // what it means for the hand
};

/// By number of the state.
inline constexpr std::array<StateEntry, 4> kStateTable{
    {{"off", "no force"},
     {"ready", "no tissue force until armed"},
     {"armed", "force is on"},
     {"stopped", "force is off until a person acts"}}};

/// A number that came from elsewhere may be none of these: "unknown".
constexpr const char* name_of(State state) {
  const auto number = static_cast<std::size_t>(state);
  return number < kStateTable.size() ? kStateTable[number].name : "unknown";
}

}  // namespace tact::firmware::loop
