#include "hal/falcon/sha256.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tact::hal {
namespace {

std::string digest(const std::string& message) {
  const std::vector<std::uint8_t> bytes(message.begin(), message.end());
  std::string out;
  for (const std::uint8_t byte : sha256(bytes)) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 0xF];
  }
  return out;
}

TEST(Sha256, GivesThePublishedDigests) {  // NIST, examples of FIPS 180
  EXPECT_EQ(digest(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(digest(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, EveryLengthAroundABlockIsPaddedRight) {
  // sha256sum of 55, 56, 63, 64, 65 and 8492 times the letter x
  for (const auto& [size, wanted] : std::vector<std::pair<std::size_t, std::string>>{
           {55, "d5e285683cd4efc02d021a5c62014694958901005d6f71e89e0989fac77e4072"},
           {56, "04c26261370ee7541549d16dee320c723e3fd14671e66a099afe0a377c16888e"},
           {63, "75220b47218278e656f2013bb8f0c455a25eaf01e86c64924e9d48d89776d6f2"},
           {64, "7ce100971f64e7001e8fe5a51973ecdfe1ced42befe7ee8d5fd6219506b5393c"},
           {65, "9537c5fdf120482f7d58d25e9ed583f52c02b4e304ea814db1633ad565aed7e9"},
           {8492, "1f891b6a09d289d177aea01839475bd75831099f628d756d2bdb70d2783dfee2"}}) {
    EXPECT_EQ(digest(std::string(size, 'x')), wanted) << size;
  }
}

}  // namespace
}  // namespace tact::hal
