// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/sha256.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tact::hal::falcon_usb::sha256_test {

std::string text_of_digest(const std::string& message) {
  const std::vector<std::uint8_t> bytes(message.begin(), message.end());
  std::string out;
  const Sha256 digest = sha256(bytes).value();
  for (const std::uint8_t byte : digest) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 0xF];
  }
  return out;
}

TEST(Sha256, GivesThePublishedDigests) {  // NIST, examples of FIPS 180
  EXPECT_EQ(text_of_digest(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(text_of_digest("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(text_of_digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(text_of_digest(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace tact::hal::falcon_usb::sha256_test
