// SPDX-License-Identifier: Apache-2.0
// limits_checksum.h - are the limits in use those of a report? Eight digits that the terminal of
// tactd, the page and the report of tact-limits all show.
#pragma once

#include <cstddef>
#include <string>

#include "model/limits.h"

namespace tact::model::io {

inline constexpr std::size_t kChecksumDigits = 8;

/// Every limit in a line "name = value", by its name in a scene. Two texts are the same if and only
/// if the limits are, to the last bit.
std::string limits_text(const Limits& limits);
/// The first digits of the SHA-256 of that text, in lower case. `limits`: in use (limits_in_use).
std::string limits_checksum(const Limits& limits);

}  // namespace tact::model::io
