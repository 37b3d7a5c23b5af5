// SPDX-License-Identifier: Apache-2.0
// falcon_image.h - may this firmware be sent to a Falcon? (FP-6)
//
// The images belong to Novint, are licensed for non-commercial use, and are not part of tact: the
// person who owns one names its file. Without a digest in the settings only images that are known
// to run are taken; with one, exactly the image that has it. Sizes and digests are of the files in
// github.com/libnifalcon/libnifalcon.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tact::hal::falcon_usb {

struct FalconKnownImage {
  const char* name;
  std::size_t size_bytes;
  const char* sha256;  // hexadecimal, lower case
};

inline constexpr std::array kFalconKnownImages{
    FalconKnownImage{"nvent", 8492,
                     "1119e39c39fab1f37678ea62dfc715b23dd86ee7f13d78f88f707d9f09b896a1"},
    FalconKnownImage{"test", 7324,
                     "b2700d5cd5ca217e48565fb4de5a502a636c53f6e01ebd0cad193e9f84856c6a"},
    FalconKnownImage{"T0", 7914,
                     "ae838730af34b5822c9c3949859b446614af0410730b832cc17a6ad627ea64a4"},
    FalconKnownImage{"T2", 7914,
                     "e0ae3598670fa1c8d9277bd6943c99b3152b97c400c46c1c42c60de77ff4e816"}};
inline constexpr std::size_t kFalconImageMax_bytes = 65536;  // the processor's memory is smaller

enum class FalconImageVerdict {
  kKnown,        // runs: one of kFalconKnownImages
  kAsNamed,      // has the digest of the settings
  kBadDigest,    // the digest of the settings is not 64 hexadecimal digits
  kWrongSize,    // empty, too large, or of no known size with no digest to vouch for it
  kUnknown,      // of a known size, and not a known image
  kOtherDigest,  // not the image that the settings mean
};
constexpr bool may_be_sent(FalconImageVerdict verdict) noexcept {
  return verdict == FalconImageVerdict::kKnown || verdict == FalconImageVerdict::kAsNamed;
}
/// What is wrong, and the remedy; "" for those that may be sent.
const char* falcon_image_advice(FalconImageVerdict verdict) noexcept;

/// The digest in hexadecimal, upper or lower case; empty: only known images.
FalconImageVerdict check_falcon_image(std::span<const std::uint8_t> image,
                                      std::string_view wanted_sha256);

}  // namespace tact::hal::falcon_usb
