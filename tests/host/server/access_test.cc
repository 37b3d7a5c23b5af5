// SPDX-License-Identifier: Apache-2.0
#include "host/server/access.h"

#include <gtest/gtest.h>

#include <cctype>

namespace tact::host::server::access_test {

const Access kLoopback{.loopback = true, .bind_address = "127.0.0.1", .token = ""};
const Access kNetwork{
    .loopback = false, .bind_address = "192.168.1.7", .token = "0123456789abcdef0123456789abcdef"};

TEST(Access, LetsOnlyLoopbackNamesReachALoopbackServer) {
  for (const char* host : {"127.0.0.1:8321", "localhost:9000", "localhost", "[::1]:8321"})
    EXPECT_TRUE(kLoopback.host_allowed(host)) << host;
  // A foreign page may point its own name at 127.0.0.1 (DNS rebinding).
  for (const char* host : {"", "evil.example:8321", "localhost.evil.example",
                           "127.0.0.1.evil.example", "127.0.0.2", "[::1", "]:8321"}) {
    EXPECT_FALSE(kLoopback.host_allowed(host)) << host;
  }
}

// Other users of this PC reach its loopback address, too.
TEST(Access, NeedsTheWholeTokenForAnyAddress) {
  for (const bool loopback : {false, true}) {
    Access access = kNetwork;
    access.loopback = loopback;
    EXPECT_TRUE(access.token_allowed("Bearer " + access.token, ""));
    EXPECT_TRUE(access.token_allowed("", "tact, token." + access.token));
    EXPECT_FALSE(access.token_allowed("", ""));
    EXPECT_FALSE(access.token_allowed("Bearer ", ""));
    EXPECT_FALSE(access.token_allowed(access.token, ""));
    EXPECT_FALSE(access.token_allowed("Bearer " + access.token.substr(1), ""));
    EXPECT_FALSE(access.token_allowed("Bearer " + access.token + "0", ""));
    EXPECT_FALSE(access.token_allowed("Basic " + access.token, ""));
    EXPECT_FALSE(access.token_allowed("", "tact," + access.token));
  }
}

// Of the right length, so that only its characters differ.
TEST(Access, RefusesATokenWithOneBitWrongAnywhere) {
  for (std::size_t at = 0; at < kNetwork.token.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::string wrong = kNetwork.token;
      wrong[at] = static_cast<char>(static_cast<unsigned char>(wrong[at]) ^ (1u << bit));
      EXPECT_FALSE(kNetwork.token_allowed("Bearer " + wrong, "")) << wrong;
      EXPECT_FALSE(kNetwork.token_allowed("", "tact, token." + wrong)) << wrong;
    }
  }
}

TEST(Access, RefusesEverybodyWhenThereIsNoTokenToCompare) {
  Access broken = kNetwork;
  broken.token.clear();
  EXPECT_FALSE(broken.token_allowed("Bearer ", ""));
  EXPECT_FALSE(broken.token_allowed("", "token."));
  EXPECT_FALSE(broken.token_allowed("", ""));
}

TEST(Access, KnowsTheProxyBeforeItByItsNameAndItsTls) {
  Access behind = kLoopback;
  behind.public_url = "https://tact.lab:8443";
  EXPECT_TRUE(behind.host_allowed("tact.lab:8443"));
  EXPECT_TRUE(behind.host_allowed("localhost:8321"));
  EXPECT_FALSE(behind.host_allowed("evil.example:8443"));
  EXPECT_FALSE(behind.host_allowed(""));
  EXPECT_EQ(authority_of("https://tact.lab:8443/"), "tact.lab:8443");
  for (const char* url : {"", "tact.lab", "ftp://tact.lab", "https://", "https:///", "https://a/b",
                          "https://a/#b", "https://a?b", "https://user@a", "https://a b"})
    EXPECT_EQ(authority_of(url), "") << url;
}

TEST(Access, TakesAWebSocketOnlyFromItsOwnPage) {
  EXPECT_TRUE(origin_matches("http://127.0.0.1:8321", "127.0.0.1:8321"));
  EXPECT_TRUE(origin_matches("https://tact.lab", "tact.lab"));
  EXPECT_FALSE(origin_matches("http://evil.example", "127.0.0.1:8321"));
  EXPECT_FALSE(origin_matches("http://127.0.0.1:8321.evil.example", "127.0.0.1:8321"));
  EXPECT_FALSE(origin_matches("http://127.0.0.1:8322", "127.0.0.1:8321"));
  EXPECT_FALSE(origin_matches("null", "127.0.0.1:8321"));
  EXPECT_FALSE(origin_matches("", "127.0.0.1:8321"));
  EXPECT_FALSE(origin_matches("http://", ""));
}

TEST(Access, MakesLongTokensThatDiffer) {
  const auto one = make_token(), two = make_token();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->size(), 32u);
  EXPECT_NE(*one, *two);
  for (const char c : *one) EXPECT_TRUE(std::isxdigit(static_cast<unsigned char>(c)));
}

}  // namespace tact::host::server::access_test
