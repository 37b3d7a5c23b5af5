// SPDX-License-Identifier: Apache-2.0
// loop_gone.h - after how long a silent loop counts as gone, for a thread beside it that holds its
// last force: a Falcon's USB thread, and the one that calls a vendor SDK.
//
// Chosen. The watch above the loop acts sooner with hard real time above 250 Hz, else later.
#pragma once

#include <cstdint>

namespace tact::hal {

inline constexpr std::int64_t kLoopGone_ns = 100'000'000;

}  // namespace tact::hal
