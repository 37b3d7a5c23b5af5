// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_image.h"

#include <optional>

#include "hal/falcon_usb/sha256.h"

namespace tact::hal::falcon_usb {
namespace {

std::optional<unsigned> hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10u;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10u;
  return std::nullopt;
}

std::optional<Sha256> digest_of(std::string_view text) noexcept {
  Sha256 out{};
  if (text.size() != 2 * out.size()) return std::nullopt;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto high = hex_digit(text[2 * i]), low = hex_digit(text[2 * i + 1]);
    if (!high || !low) return std::nullopt;
    out[i] = static_cast<std::uint8_t>(*high << 4 | *low);
  }
  return out;
}

}  // namespace

FalconImageVerdict check_falcon_image(std::span<const std::uint8_t> image,
                                      std::string_view wanted_sha256) noexcept {
  const auto wanted = digest_of(wanted_sha256);
  if (!wanted_sha256.empty() && !wanted) return FalconImageVerdict::kBadDigest;
  if (image.empty() || image.size() > kFalconImageMax_bytes) return FalconImageVerdict::kWrongSize;
  const auto digest = sha256(image);
  if (wanted)
    return digest == *wanted ? FalconImageVerdict::kAsNamed : FalconImageVerdict::kOtherDigest;
  FalconImageVerdict verdict = FalconImageVerdict::kWrongSize;
  for (const FalconKnownImage& known : kFalconKnownImages) {
    if (image.size() != known.size_bytes) continue;
    if (digest == digest_of(known.sha256)) return FalconImageVerdict::kKnown;
    verdict = FalconImageVerdict::kUnknown;
  }
  return verdict;
}

const char* falcon_image_advice(FalconImageVerdict verdict) noexcept {
  switch (verdict) {
    case FalconImageVerdict::kKnown:
    case FalconImageVerdict::kAsNamed:
      return "";
    case FalconImageVerdict::kBadDigest:
      return "the digest of the firmware is no SHA-256: give the 64 hexadecimal digits that "
             "sha256sum prints for your file";
    case FalconImageVerdict::kWrongSize:
      return "the firmware file has a size that no known Falcon firmware has (8492, 7324 or 7914 "
             "bytes): is it the right file, and whole?";
    case FalconImageVerdict::kUnknown:
      return "the firmware file is damaged or unknown: take a fresh copy, or, if you are sure of "
             "it, name its SHA-256 in the scene";
    case FalconImageVerdict::kOtherDigest:
      return "the firmware file is not the one whose SHA-256 the scene names: take the right file, "
             "or correct the digest";
  }
  return "";
}

}  // namespace tact::hal::falcon_usb
