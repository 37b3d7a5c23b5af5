// SPDX-License-Identifier: Apache-2.0
// sha256.h - the SHA-256 digest of a file's bytes: is this image the one its owner meant?
//
// By OpenSSL's libcrypto. For start-up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tact::hal::falcon_usb {

using Sha256 = std::array<std::uint8_t, 32>;

/// Nothing if the library refuses.
std::optional<Sha256> sha256(std::span<const std::uint8_t> message) noexcept;

}  // namespace tact::hal::falcon_usb
