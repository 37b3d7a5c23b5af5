// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_image.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "model/io/seal.h"

namespace tact::hal::falcon_usb {
namespace {

constexpr std::size_t kDigits = 64;

bool is_hex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

}  // namespace

FalconImageVerdict check_falcon_image(std::span<const std::uint8_t> image,
                                      std::string_view wanted_sha256) {
  const bool is_named = !wanted_sha256.empty();
  if (is_named && (wanted_sha256.size() != kDigits || !std::ranges::all_of(wanted_sha256, is_hex)))
    return FalconImageVerdict::kBadDigest;
  if (image.empty() || image.size() > kFalconImageMax_bytes) return FalconImageVerdict::kWrongSize;
  const std::string digest =
      model::io::sha256_of({reinterpret_cast<const char*>(image.data()), image.size()});
  // A digest that the person names vouches for any size.
  if (is_named)
    return digest == in_lower_case(wanted_sha256) ? FalconImageVerdict::kAsNamed
                                                  : FalconImageVerdict::kOtherDigest;
  // Two known images share a size: all are looked at before "unknown" is said.
  FalconImageVerdict verdict = FalconImageVerdict::kWrongSize;
  for (const FalconKnownImage& known : kFalconKnownImages) {
    if (image.size() != known.size_bytes) continue;
    if (digest == known.sha256) return FalconImageVerdict::kKnown;
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
