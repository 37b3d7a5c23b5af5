// sha256.h - the SHA-256 digest of a file's bytes: is this image the one its owner meant?
//
// Source: FIPS 180-4, sections 4.1.2, 5 and 6.2. For start-up, not for secrets.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tact::hal {

using Sha256 = std::array<std::uint8_t, 32>;

Sha256 sha256(std::span<const std::uint8_t> message) noexcept;

}  // namespace tact::hal
