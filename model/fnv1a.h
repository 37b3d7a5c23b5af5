// SPDX-License-Identifier: Apache-2.0
// fnv1a.h - the 64-bit FNV-1a hash: h = (h xor byte) * prime, byte by byte. For equality, not
// against malice.
//
// Source: Fowler, Noll, Vo; RFC 9923.
#pragma once

#include <cstdint>

namespace tact::model {

inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325u;

/// `bytes` is anything that gives chars or unsigned chars, one after the other.
template <typename Bytes>
constexpr std::uint64_t fnv1a(const Bytes& bytes, std::uint64_t hash = kFnvStart) {
  for (const auto byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

}  // namespace tact::model
