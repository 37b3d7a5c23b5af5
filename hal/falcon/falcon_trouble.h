// SPDX-License-Identifier: Apache-2.0
// falcon_trouble.h - what keeps a Falcon from making force, in one word, and in words.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "hal/falcon/falcon_pipe.h"

namespace tact::hal::falcon {

/// One atomic word: the loop stores it, any thread reads it.
struct alignas(8) FalconTrouble {
  enum class What : std::uint8_t {
    kNone,
    kNotHomed,
    kUnplugged,
    kStalled,
    kBroken,
    kSilent,
    kGarbled,
    kHomingLost,
    kStoodIn,
  };
  What what = What::kNone;
  std::uint8_t homed = 0;        // three bits, axis 1 first
  std::uint8_t line_errors = 0;  // ftdi_requests.h
  std::uint16_t error = 0;       // errno
};
static_assert(std::atomic<FalconTrouble>::is_always_lock_free);

/// One message: which part, why, the remedy; empty for kNone.
std::string text_of(const FalconTrouble& trouble);

}  // namespace tact::hal::falcon
