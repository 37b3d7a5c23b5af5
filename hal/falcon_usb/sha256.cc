// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/sha256.h"

#include <openssl/evp.h>

namespace tact::hal::falcon_usb {

std::optional<Sha256> sha256(std::span<const std::uint8_t> message) noexcept {
  Sha256 out{};
  const bool good =
      EVP_Digest(message.data(), message.size(), out.data(), nullptr, EVP_sha256(), nullptr) == 1;
  return good ? std::optional(out) : std::nullopt;
}

}  // namespace tact::hal::falcon_usb
