// SPDX-License-Identifier: Apache-2.0
// falcon_trouble.h - what keeps a Falcon from making force, packed small, and in words.
#pragma once

#include <cstdint>
#include <string>

#include "hal/falcon/falcon_pipe.h"

namespace tact::hal::falcon {

struct FalconTrouble {
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

  std::uint64_t packed() const RT_SAFE {
    return static_cast<std::uint64_t>(what) | std::uint64_t{homed} << 8 |
           std::uint64_t{line_errors} << 16 | std::uint64_t{error} << 24;
  }
  static FalconTrouble unpacked(std::uint64_t code) RT_SAFE {
    return {.what = static_cast<What>(code & 0xFFu),
            .homed = static_cast<std::uint8_t>(code >> 8),
            .line_errors = static_cast<std::uint8_t>(code >> 16),
            .error = static_cast<std::uint16_t>(code >> 24)};
  }
};

/// One sentence: which part, why, the cure; empty for kNone.
std::string in_words(const FalconTrouble& trouble);

}  // namespace tact::hal::falcon
