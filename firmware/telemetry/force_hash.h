// SPDX-License-Identifier: Apache-2.0
// force_hash.h - all forces of a run as one number: equal runs have equal hashes.
//
// The hash is over bits, not values: -0 differs from 0, and equal NaN bits are equal.
#pragma once

#include <array>
#include <bit>

#include "model/fnv1a.h"
#include "model/types.h"

namespace tact::firmware::telemetry {

using WrenchBits = std::array<unsigned char, sizeof(model::Wrench)>;

inline WrenchBits bits_of(const model::Wrench& wrench) {
  static_assert(sizeof wrench == 6 * sizeof(double));
  return std::bit_cast<WrenchBits>(wrench);
}

/// One step over the bytes of a wrench; start with model::kFnvStart.
inline std::uint64_t hash_wrench(std::uint64_t hash, const model::Wrench& wrench) {
  return model::fnv1a(bits_of(wrench), hash);
}

}  // namespace tact::firmware::telemetry
