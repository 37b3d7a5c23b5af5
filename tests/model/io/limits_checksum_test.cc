// SPDX-License-Identifier: Apache-2.0
#include "model/io/limits_checksum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "model/io/seal.h"

namespace tact::model::io::limits_checksum_test {

Limits some() {
  return {.force_N = 8.0,
          .torque_Nm = 0.2,
          .slew_N_per_s = 900.0,
          .ramp_s = 1.0,
          .workspace_radius_m = 0.1,
          .workspace_half_length_m = 0.08};
}

TEST(LimitsChecksum, ChangesWithTheLastBitOfEachLimit) {
  const std::string whole = limits_checksum(some());
  constexpr std::size_t kCount = sizeof(Limits) / sizeof(double);
  for (std::size_t i = 0; i < kCount; ++i) {
    Limits other = some();
    double values[kCount];
    std::memcpy(values, &other, sizeof other);
    values[i] = std::nextafter(values[i], 1e9);
    std::memcpy(&other, values, sizeof other);
    EXPECT_NE(limits_checksum(other), whole) << "limit " << i;
  }
}

TEST(LimitsChecksum, IsTheBeginningOfTheDigestOfTheirText) {
  const std::string text = limits_text(some());
  EXPECT_EQ(text.find("force_N = 8\ntorque_Nm = 0.2\n"), 0u) << text;
  EXPECT_NE(text.find("\npower_W = 20\n"), std::string::npos) << text;
  const std::string checksum = limits_checksum(some());
  EXPECT_EQ(checksum.size(), kChecksumDigits);
  EXPECT_EQ(checksum.find_first_not_of("0123456789abcdef"), std::string::npos) << checksum;
  EXPECT_EQ(sha256_of(text).find(checksum), 0u);
}

TEST(LimitsChecksum, AQuarterOfTheForceHasAnother) {
  EXPECT_EQ(limits_checksum(limits_in_use(some(), 1.0)), limits_checksum(some()));
  EXPECT_NE(limits_checksum(limits_in_use(some(), 0.25)), limits_checksum(some()));
}

}  // namespace tact::model::io::limits_checksum_test
