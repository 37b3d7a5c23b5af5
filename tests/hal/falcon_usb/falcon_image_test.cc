// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_image.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "model/io/seal.h"

namespace tact::hal::falcon_usb::falcon_image_test {

using Bytes = std::vector<std::uint8_t>;
using Verdict = FalconImageVerdict;

std::string digest_of(const Bytes& bytes) {
  std::string out =
      model::io::sha256_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  for (std::size_t i = 0; i < out.size(); i += 2)  // mixed case on purpose
    out[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(out[i])));
  return out;
}

TEST(FalconImage, ImageWithTheDigestOfTheSettingsMayBeSent) {
  const Bytes image(1000, 0xAA);
  EXPECT_EQ(check_falcon_image(image, digest_of(image)), Verdict::kAsNamed);
}

TEST(FalconImage, OneBitElseIsAnotherImage) {
  Bytes image(8492, 0xAA);
  const std::string digest = digest_of(image);
  image[8491] ^= 1;
  EXPECT_EQ(check_falcon_image(image, digest), Verdict::kOtherDigest);
  image.pop_back();
  EXPECT_EQ(check_falcon_image(image, digest), Verdict::kOtherDigest);
}

TEST(FalconImage, WithoutADigestOnlyKnownOnesAreTaken) {
  for (const FalconKnownImage& known : kFalconKnownImages) {
    EXPECT_EQ(check_falcon_image(Bytes(known.size_bytes, 1), ""), Verdict::kUnknown);
    EXPECT_EQ(check_falcon_image(Bytes(known.size_bytes - 1, 1), ""), Verdict::kWrongSize);
    EXPECT_EQ(check_falcon_image(Bytes(known.size_bytes + 1, 1), ""), Verdict::kWrongSize);
    // the digest of a known image vouches for that image, not for another of its size
    EXPECT_EQ(check_falcon_image(Bytes(known.size_bytes, 1), known.sha256), Verdict::kOtherDigest);
  }
}

TEST(FalconImage, EmptyOrTooLargeImageIsRefused) {
  EXPECT_EQ(check_falcon_image({}, ""), Verdict::kWrongSize);
  EXPECT_EQ(check_falcon_image({}, digest_of({})), Verdict::kWrongSize);
  const Bytes most(kFalconImageMax_bytes), more(kFalconImageMax_bytes + 1);
  EXPECT_EQ(check_falcon_image(most, digest_of(most)), Verdict::kAsNamed);
  EXPECT_EQ(check_falcon_image(more, digest_of(more)), Verdict::kWrongSize);
}

TEST(FalconImage, MalformedDigestIsRefused) {
  const Bytes image(1000, 0xAA);
  const std::string digest = digest_of(image);
  for (const std::string& bad :
       {digest.substr(1), digest + "0", std::string(64, 'g'), " " + digest, std::string("none")}) {
    EXPECT_EQ(check_falcon_image(image, bad), Verdict::kBadDigest) << bad;
  }
}

TEST(FalconImage, EveryRefusalHasItsOwnMessage) {
  std::set<std::string> messages;
  for (const Verdict verdict :
       {Verdict::kBadDigest, Verdict::kWrongSize, Verdict::kUnknown, Verdict::kOtherDigest}) {
    EXPECT_FALSE(may_be_sent(verdict));
    messages.insert(falcon_image_advice(verdict));
  }
  EXPECT_EQ(messages.size(), 4u);
  EXPECT_EQ(messages.count(""), 0u);
  for (const Verdict verdict : {Verdict::kKnown, Verdict::kAsNamed}) {
    EXPECT_TRUE(may_be_sent(verdict));
    EXPECT_STREQ(falcon_image_advice(verdict), "");
  }
}

}  // namespace tact::hal::falcon_usb::falcon_image_test
