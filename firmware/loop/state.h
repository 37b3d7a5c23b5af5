// SPDX-License-Identifier: Apache-2.0
// state.h - who may feel force just now: the states of supervisor.h, told to viewers as they are.
#pragma once

#include <cstdint>

namespace tact::firmware::loop {

enum class State : std::uint8_t { kOff = 0, kReady = 1, kArmed = 2, kStopped = 3 };

}  // namespace tact::firmware::loop
